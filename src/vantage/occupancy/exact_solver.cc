// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/exact_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/core/hal/hal.hpp>

#include "vantage/occupancy/cell_states.h"
#include "vantage/occupancy/evidence.h"

namespace vantage::internal {
namespace {

/// Sums over the pixels left of and above a corner: of w M and of M B, where w is the informative
/// share of a pixel and B the foreground in it.
struct Sums {
  double m;
  double mb;
};

Sums operator-(const Sums& a, const Sums& b) { return {a.m - b.m, a.mb - b.mb}; }

class ExactSolver {
 public:
  explicit ExactSolver(const Problem& problem)
      : problem_(problem), states_(problem.options, problem.priors) {
    for (std::size_t i = 0; i < problem.previous.size(); ++i) {
      states_.StartAt(i, static_cast<double>(problem.previous[i]));
    }
  }

  SolveReport Solve() {
    const OccupancyOptions& options = problem_.options;
    const std::size_t cells = states_.size();
    SolveReport report;
    report.cells_iterated = static_cast<std::int64_t>(cells);
    Convergence convergence(options);
    log_absence_.resize(cells);
    while (!report.converged && report.iterations < options.max_iterations) {
      for (std::size_t i = 0; i < cells; ++i) {
        const double n = states_.absence(i);
        log_absence_[i] = n > options.ignored ? 0 : std::log(n);
      }
      score_.assign(cells, 0.0);
      for (std::size_t c = 0; c < problem_.cameras.size(); ++c) {
        if (problem_.foreground[c].given()) AddScores(c);
      }
      report.last_change = 0;
      for (std::size_t i = 0; i < cells; ++i) {
        report.last_change = std::max(report.last_change, states_.Step(i, score_[i]));
      }
      ++report.iterations;
      convergence.Add(report.last_change);
      report.converged = convergence.reached();
    }
    return report;
  }

  double Presence(std::size_t cell) const { return 1 - states_.absence(cell); }

 private:
  /// M, the probability that a pixel is not covered, is a product over rectangles; so log M is a
  /// sum of boxes: four corners a cell, then prefix sums along columns and rows. The prefix sums of
  /// M and M B that box sums come from are built on the way.
  void BuildSums(const CameraCells& camera, const cv::Mat& foreground) {
    const auto width = static_cast<std::size_t>(camera.size.width);
    const std::size_t stride = width + 1;
    const std::size_t corners = stride * (static_cast<std::size_t>(camera.size.height) + 1);
    difference_.assign(corners, 0.0);
    for (const CameraCells::Cell& c : camera.cells) {
      const double log_n = log_absence_[static_cast<std::size_t>(c.cell)];
      const auto [top_left, top_right, bottom_left, bottom_right] = Corners(c.rectangle, stride);
      difference_[top_left] += log_n;
      difference_[top_right] -= log_n;
      difference_[bottom_left] -= log_n;
      difference_[bottom_right] += log_n;
    }
    columns_.assign(width, 0.0);
    row_.resize(width);
    sums_.resize(corners);
    std::fill_n(sums_.begin(), stride, Sums{0, 0});
    for (int y = 0; y < camera.size.height; ++y) {
      const double* const change = difference_.data() + static_cast<std::size_t>(y) * stride;
      for (std::size_t x = 0; x < width; ++x) columns_[x] += change[x];
      double log_m = 0;
      for (std::size_t x = 0; x < width; ++x) {
        log_m += columns_[x];
        row_[x] = log_m;
      }
      cv::hal::exp64f(row_.data(), row_.data(), camera.size.width);
      const float* const b = foreground.ptr<float>(y);
      const float* const share =
          camera.informative_share.empty() ? nullptr : camera.informative_share.ptr<float>(y);
      const Sums* const above = sums_.data() + static_cast<std::size_t>(y) * stride;
      Sums* const below = sums_.data() + static_cast<std::size_t>(y + 1) * stride;
      Sums row_sums{0, 0};
      below[0] = row_sums;
      for (std::size_t x = 0; x < width; ++x) {
        row_sums.m += share == nullptr ? row_[x] : row_[x] * static_cast<double>(share[x]);
        row_sums.mb += row_[x] * static_cast<double>(b[x]);
        below[x + 1] = {above[x + 1].m + row_sums.m, above[x + 1].mb + row_sums.mb};
      }
    }
  }

  void AddScores(std::size_t index) {
    const CameraCells& camera = problem_.cameras[index];
    const cv::Mat& foreground = problem_.foreground[index].image;
    BuildSums(camera, foreground);
    const auto stride = static_cast<std::size_t>(camera.size.width) + 1;
    const PersonEvidence person(problem_.options);
    const PictureEvidence picture(problem_.options, camera.pixels, cv::sum(foreground)[0],
                                  sums_.back().m, sums_.back().mb);
    for (const CameraCells::Cell& c : camera.cells) {
      const auto cell = static_cast<std::size_t>(c.cell);
      const auto [top_left, top_right, bottom_left, bottom_right] = Corners(c.rectangle, stride);
      const Sums sum =
          (sums_[bottom_right] - sums_[bottom_left]) - (sums_[top_right] - sums_[top_left]);
      const double n = states_.absence(cell);
      const double r = problem_.options.evidence == Evidence::kPerson
                           ? person.Ratio(sum.m, sum.mb, n, c.area)
                           : picture.Ratio(sum.m, sum.mb, n);
      score_[cell] += static_cast<double>(c.weight) * r;
    }
  }

  /// Where the corners of a rectangle are in an array with a value for each corner of a pixel.
  static std::array<std::size_t, 4> Corners(const cv::Rect& r, std::size_t stride) {
    const auto left = static_cast<std::size_t>(r.x),
               right = left + static_cast<std::size_t>(r.width);
    const std::size_t top = static_cast<std::size_t>(r.y) * stride;
    const std::size_t bottom = top + static_cast<std::size_t>(r.height) * stride;
    return {top + left, top + right, bottom + left, bottom + right};
  }

  const Problem& problem_;
  CellStates states_;
  std::vector<double> log_absence_;  // log n; 0 for the cells that are left out of M
  std::vector<double> score_;        // sum over the cameras of w r
  std::vector<double> difference_;   // second difference of log M
  std::vector<double> columns_;      // log M, first difference along the row
  std::vector<double> row_;          // M of one row
  std::vector<Sums> sums_;
};

}  // namespace

SolveReport SolveExactly(const Problem& problem, std::span<float> q) {
  ExactSolver solver(problem);
  const SolveReport report = solver.Solve();
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = static_cast<float>(solver.Presence(i));
  return report;
}

}  // namespace vantage::internal
