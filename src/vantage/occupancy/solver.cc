// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/solver.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/core/hal/hal.hpp>
#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

/// Absence never falls below this: its logarithm and its inverse stay within what double sums of a
/// picture resolve.
constexpr double kMinAbsence = 1e-10;

/// A surface below this share of the picture is rounding (or what `ignored` leaves out of M).
constexpr double kMinSurface = 1e-6;

constexpr std::size_t kMaxCells = 4'000'000;

Status CheckView(const CameraView& view, std::size_t index, std::size_t cells) {
  if (view.rectangles.size() != cells) {
    return Fail(
        "the view of camera {} has {} cells and that of camera 0 has {}; all views must be "
        "of the same grid",
        index, view.rectangles.size(), cells);
  }
  constexpr int kMaxSide = 32768;
  for (const ImageSize size : {view.mask_size, view.size}) {
    if (size.width < 1 || size.height < 1 || size.width > kMaxSide || size.height > kMaxSide) {
      return Fail("the view of camera {} is {} x {} px; each side must be 1 to {}", index,
                  size.width, size.height, kMaxSide);
    }
  }
  const cv::Rect picture(0, 0, view.size.width, view.size.height);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const cv::Rect& r = view.rectangles[cell];
    if (!r.empty() && (r & picture) != r) {
      return Fail("the rectangle of cell {} leaves the {} x {} px picture of camera {}", cell,
                  picture.width, picture.height, index);
    }
  }
  return {};
}

}  // namespace

void VisitOptions(OccupancyOptions& o, OptionVisitor& v) {
  v.Number({"prior", "", "probability that a cell is occupied before anything is seen"}, o.prior,
           Range::Inside(0, 1));
  v.Number({"variance", "", "variance of the share of pixels that a map explains wrongly"},
           o.variance, Range::Between(1e-7, 10));
  v.Number({"smoothing", "", "share of its old value that a cell keeps in each iteration"},
           o.smoothing, {.low = 0, .high = 1, .high_open = true});
  v.Number({"noise", "", "share of the picture that counts as covered in any case"}, o.noise,
           Range::Between(1e-6, 1));
  v.Number({"max_iterations", "", "iterations at most"}, o.max_iterations,
           Range::Between(1, 100000));
  v.Number({"tolerance", "", "an iteration that changes no cell by this much is stable"},
           o.tolerance, Range::Between(0, 1));
  v.Number({"stable_iterations", "", "stable iterations in a row before the end"},
           o.stable_iterations, Range::Between(1, 1000));
  v.Number({"ignored", "", "cells with a greater probability of absence are left out"}, o.ignored,
           Range::Between(0.9, 1));
  v.Choice({"visibility", "", "which cells a camera speaks for: ground, complete or centre"},
           o.visibility,
           {{"ground", Visibility::kGround},
            {"complete", Visibility::kComplete},
            {"centre", Visibility::kCentre}});
  v.Number({"reduction", "", "the sides of a mask are divided by this before use"}, o.reduction,
           Range::Between(1, 64));
}

/// Scratch memory of one Solve.
struct OccupancySolver::Workspace {
  /// Sums over the pixels left of and above a corner: of M and of M B.
  struct Sums {
    double m;
    double mb;
  };
  std::vector<double> absence;      // n
  std::vector<double> log_absence;  // log n; 0 for the cells that are left out of M
  std::vector<double> absent;       // l = 1 - 1 / n
  std::vector<double> score;        // sum over the cameras of r
  std::vector<double> difference;   // second difference of log M
  std::vector<double> columns;      // log M, first difference along the row
  std::vector<double> row;          // M of one row
  std::vector<Sums> sums;
};

Result<OccupancySolver> OccupancySolver::Create(const std::vector<CameraView>& views,
                                                const OccupancyOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "occupancy"));
  if (views.empty()) return Fail("there is no camera; occupancy needs at least one");
  OccupancySolver solver;
  solver.options_ = options;
  solver.cell_count_ = views.front().rectangles.size();
  if (solver.cell_count_ < 1 || solver.cell_count_ > kMaxCells) {
    return Fail("the grid has {} cells; it must have 1 to {}", solver.cell_count_, kMaxCells);
  }
  for (const CameraView& view : views) {
    VANTAGE_RETURN_IF_ERROR(CheckView(view, solver.cameras_.size(), solver.cell_count_));
    CameraCells& camera = solver.cameras_.emplace_back();
    camera.mask_size = view.mask_size;
    camera.size = view.size;
    const int stride = view.size.width + 1;
    for (std::size_t cell = 0; cell < view.rectangles.size(); ++cell) {
      const cv::Rect& r = view.rectangles[cell];
      if (r.empty()) continue;
      const int top = r.y * stride, bottom = (r.y + r.height) * stride;
      const int left = r.x, right = r.x + r.width;
      camera.cells.push_back(
          {static_cast<CellIndex>(cell), top + left, top + right, bottom + left, bottom + right});
    }
  }
  return solver;
}

Result<std::vector<OccupancySolver::Evidence>> OccupancySolver::Prepare(
    std::span<const cv::Mat> masks) const {
  if (masks.size() != cameras_.size()) {
    return Fail("{} masks are given for {} cameras", masks.size(), cameras_.size());
  }
  std::vector<Evidence> prepared(masks.size());
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const cv::Mat& mask = masks[i];
    if (mask.empty()) continue;
    const auto [width, height] = cameras_[i].mask_size;
    if (mask.type() != CV_8UC1 || mask.cols != width || mask.rows != height) {
      return Fail(
          "the mask of camera {} is {} x {} px with {} channels of {} bytes; it must be "
          "{} x {} with one of 1 byte",
          i, mask.cols, mask.rows, mask.channels(), mask.elemSize1(), width, height);
    }
    cv::Mat& b = prepared[i].b;
    mask.convertTo(b, CV_32F, 1.0 / 255);
    const cv::Size size(cameras_[i].size.width, cameras_[i].size.height);
    if (size != b.size()) {
      cv::Mat reduced;
      cv::resize(b, reduced, size, 0, 0, cv::INTER_AREA);
      b = reduced;
    }
    prepared[i].sum = cv::sum(b)[0];
  }
  return prepared;
}

/// M, the probability that a pixel is not covered, is a product over rectangles; so log M is a sum
/// of boxes: four corners a cell, then prefix sums along columns and rows. The prefix sums of M and
/// M B that box sums come from are built on the way.
void OccupancySolver::BuildSums(const CameraCells& camera, const cv::Mat& b_image,
                                Workspace& work) {
  const auto width = static_cast<std::size_t>(camera.size.width);
  const std::size_t stride = width + 1;
  const std::size_t corners = stride * (static_cast<std::size_t>(camera.size.height) + 1);
  work.difference.assign(corners, 0.0);
  double* const difference = work.difference.data();
  for (const VisibleCell& c : camera.cells) {
    const double log_n = work.log_absence[static_cast<std::size_t>(c.cell)];
    difference[c.top_left] += log_n;
    difference[c.top_right] -= log_n;
    difference[c.bottom_left] -= log_n;
    difference[c.bottom_right] += log_n;
  }
  work.columns.assign(width, 0.0);
  work.row.resize(width);
  work.sums.resize(corners);
  std::fill_n(work.sums.begin(), stride, Workspace::Sums{0, 0});
  for (int y = 0; y < camera.size.height; ++y) {
    const double* const change = difference + static_cast<std::size_t>(y) * stride;
    for (std::size_t x = 0; x < width; ++x) work.columns[x] += change[x];
    double log_m = 0;
    for (std::size_t x = 0; x < width; ++x) {
      log_m += work.columns[x];
      work.row[x] = log_m;
    }
    cv::hal::exp64f(work.row.data(), work.row.data(), camera.size.width);
    const float* const b = b_image.ptr<float>(y);
    const Workspace::Sums* const above = work.sums.data() + static_cast<std::size_t>(y) * stride;
    Workspace::Sums* const below = work.sums.data() + static_cast<std::size_t>(y + 1) * stride;
    Workspace::Sums row_sums{0, 0};
    below[0] = row_sums;
    for (std::size_t x = 0; x < width; ++x) {
      row_sums.m += work.row[x];
      row_sums.mb += work.row[x] * static_cast<double>(b[x]);
      below[x + 1] = {above[x + 1].m + row_sums.m, above[x + 1].mb + row_sums.mb};
    }
  }
}

/// Adds r_ic of every cell i that camera c speaks for to the scores.
void OccupancySolver::AddLogRatios(const CameraCells& camera, const Evidence& evidence,
                                   Workspace& work) const {
  BuildSums(camera, evidence.b, work);
  const Workspace::Sums* const sums = work.sums.data();
  const auto& [sum_m, sum_mb] = work.sums.back();
  const double pixels = static_cast<double>(camera.size.width) * camera.size.height;
  const double surface = pixels * (1 + options_.noise) - sum_m;   // S_c
  const double difference = surface + 2 * sum_mb - evidence.sum;  // D_c
  const double min_surface = kMinSurface * pixels;
  const double scale = 1 / (2 * options_.variance);
  for (const VisibleCell& c : camera.cells) {
    const auto cell = static_cast<std::size_t>(c.cell);
    const double m =
        sums[c.bottom_right].m - sums[c.bottom_left].m - sums[c.top_right].m + sums[c.top_left].m;
    const double mv = sums[c.bottom_right].mb - sums[c.bottom_left].mb - sums[c.top_right].mb +
                      sums[c.top_left].mb;
    const double l = work.absent[cell];
    const double present = (difference + m - 2 * mv) / (surface + m);
    const double absent = (difference + l * (m - 2 * mv)) / std::max(surface + l * m, min_surface);
    // L(present) - L(absent), L(x) = -x^2 / (2 v)
    work.score[cell] += scale * (absent * absent - present * present);
  }
}

Result<SolveReport> OccupancySolver::Solve(std::span<const cv::Mat> masks,
                                           std::span<float> q) const {
  if (q.size() != cell_count_) {
    return Fail("the map has room for {} cells; the grid has {}", q.size(), cell_count_);
  }
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<Evidence> evidence, Prepare(masks));
  const double logit_prior = std::log(options_.prior / (1 - options_.prior));
  Workspace work;
  work.absence.assign(cell_count_, 1 - options_.prior);
  work.log_absence.resize(cell_count_);
  work.absent.resize(cell_count_);
  SolveReport report;
  int stable = 0;
  while (!report.converged && report.iterations < options_.max_iterations) {
    for (std::size_t i = 0; i < cell_count_; ++i) {
      const double n = work.absence[i];
      work.log_absence[i] = n > options_.ignored ? 0 : std::log(n);
      work.absent[i] = 1 - 1 / n;
    }
    work.score.assign(cell_count_, 0.0);
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
      if (!evidence[c].b.empty()) AddLogRatios(cameras_[c], evidence[c], work);
    }
    report.last_change = 0;
    for (std::size_t i = 0; i < cell_count_; ++i) {
      const double old = work.absence[i];
      const double s = options_.smoothing;
      const double n = s * old + (1 - s) / (1 + std::exp(logit_prior + work.score[i]));
      work.absence[i] = std::max(n, kMinAbsence);
      report.last_change = std::max(report.last_change, std::abs(work.absence[i] - old));
    }
    ++report.iterations;
    stable = report.last_change < options_.tolerance ? stable + 1 : 0;
    report.converged = stable >= options_.stable_iterations;
  }
  for (std::size_t i = 0; i < cell_count_; ++i) q[i] = static_cast<float>(1 - work.absence[i]);
  return report;
}

}  // namespace vantage
