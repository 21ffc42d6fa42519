// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/fast_solver.h"

#include <hwy/aligned_allocator.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "vantage/occupancy/cell_states.h"
#include "vantage/occupancy/evidence.h"
#include "vantage/occupancy/fast_kernel.h"

namespace vantage::internal {
namespace {

constexpr double kMinForegroundPerson = 0.25;
constexpr double kMinForegroundPicture = 0.02;
constexpr double kMinCover = 1e-4;
/// A cell whose presence is below this share of its prior covers nothing, and is out if it does not
/// rise.
constexpr double kNothing = 0.1;
constexpr double kWorthTakingAgain = 0.7;

/// One camera's part of a frame.
class CameraFrame {
 public:
  CameraFrame(const Problem& problem, std::size_t camera)
      : options_(problem.options),
        camera_(problem.cameras[camera]),
        foreground_(problem.foreground[camera].image) {}

  /// Adds to each cell what the camera's word counts, and that times the share of the rectangle's
  /// informative pixels that is foreground (to half a percent: it only decides which cells are
  /// looked at).
  void AddForegroundShares(std::vector<double>& words, std::vector<double>& shares) const {
    cv::Mat percent;
    foreground_.convertTo(percent, CV_8U, 100);
    cv::Mat_<int> sums;
    cv::integral(percent, sums, CV_32S);
    for (const CameraCells::Cell& c : camera_.cells) {
      const cv::Rect& r = c.rectangle;
      const int* const top = sums[r.y] + r.x;
      const int* const bottom = sums[r.y + r.height] + r.x;
      const auto at = [](int value) { return static_cast<std::uint32_t>(value); };
      // Modulo 2^32: the sums of a huge picture may wrap around, that of a rectangle does not.
      const std::uint32_t sum = at(bottom[r.width]) - at(bottom[0]) - at(top[r.width]) + at(top[0]);
      const auto cell = static_cast<std::size_t>(c.cell);
      words[cell] += static_cast<double>(c.weight);
      shares[cell] += static_cast<double>(c.weight) * sum / (100 * c.area);
    }
  }

  /// `slots`: the place of each cell among those that are iterated, negative for the others. May be
  /// called again when there are fewer.
  void Take(const std::vector<int>& slots) {
    cells_.clear();
    pieces_.clear();
    runs_.clear();
    floats_ = 0;
    std::vector<const CameraCells::Cell*> taken;
    for (const CameraCells::Cell& c : camera_.cells) {
      if (slots[static_cast<std::size_t>(c.cell)] >= 0) taken.push_back(&c);
    }
    const std::vector<std::size_t> run_of = FindRuns(taken);
    for (const CameraCells::Cell* c : taken) {
      const cv::Rect& r = c->rectangle;
      const std::size_t pieces_before = pieces_.size();
      for (int block = r.x / kColumns; block <= (r.x + r.width - 1) / kColumns; ++block) {
        const int left = std::max(r.x - block * kColumns, 0);
        const int right = std::min(r.x + r.width - block * kColumns, kColumns);
        const Run& run = runs_[run_of[BlockRow(block, r.y)]];
        const std::size_t top = run.begin + Floats(r.y - run.top);
        pieces_.push_back({static_cast<std::uint32_t>(top),
                           static_cast<std::uint32_t>(top + Floats(r.height)),
                           static_cast<std::uint8_t>(left), static_cast<std::uint8_t>(right)});
      }
      cells_.push_back({static_cast<std::size_t>(slots[static_cast<std::size_t>(c->cell)]),
                        pieces_.size() - pieces_before, static_cast<double>(c->weight), c->area});
    }
    values_.resize(pieces_.size());
    FillImages();
  }

  /// `cover`: of each slot, its absence as M and r see it; `log_cover`: its logarithm, 0 for a cell
  /// that is left out of M. Adds w r to the scores.
  void AddScores(const std::vector<float>& log_cover, const std::vector<double>& cover,
                 std::vector<double>& scores) {
    float* value = values_.data();
    for (const Cell& c : cells_) value = std::fill_n(value, c.pieces, log_cover[c.slot]);
    AddPieces(pieces_, values_.data(), difference_.get());
    for (const Run& run : runs_) {
      SumCovered({.rows = run.bottom - run.top,
                  .difference = difference_.get() + run.begin,
                  .first = first_.get() + run.begin,
                  .second = second_ ? second_.get() + run.begin : nullptr,
                  .sum_first = sum_first_.get() + run.begin,
                  .sum_second = second_ ? sum_second_.get() + run.begin : nullptr});
    }
    if (second_) {
      AddPictureScores(cover, scores);
    } else {
      AddPersonScores(cover, scores);
    }
  }

 private:
  /// Rows [top, bottom) of kColumns columns of the picture; `begin`: where its floats begin.
  struct Run {
    int block;
    int top, bottom;
    std::size_t begin;
  };
  struct Cell {
    std::size_t slot;
    std::size_t pieces;  // consecutive ones, after those of the cells before
    double weight;
    double area;
  };
  using FloatArray = hwy::AlignedFreeUniquePtr<float[]>;

  static std::size_t Floats(int rows) { return static_cast<std::size_t>(rows) * kColumns; }

  std::size_t BlockRow(int block, int y) const {
    return static_cast<std::size_t>(block) * (static_cast<std::size_t>(camera_.size.height) + 1) +
           static_cast<std::size_t>(y);
  }

  /// The runs of columns that the rectangles touch. Returns the run of each BlockRow that is in
  /// one.
  std::vector<std::size_t> FindRuns(const std::vector<const CameraCells::Cell*>& cells) {
    const int blocks = (camera_.size.width + kColumns - 1) / kColumns;
    std::vector<int> begun(BlockRow(blocks, 0), 0);  // rectangles that begin less those that end
    for (const CameraCells::Cell* c : cells) {
      const cv::Rect& r = c->rectangle;
      for (int block = r.x / kColumns; block <= (r.x + r.width - 1) / kColumns; ++block) {
        ++begun[BlockRow(block, r.y)];
        --begun[BlockRow(block, r.y + r.height)];
      }
    }
    std::vector<std::size_t> run_of(begun.size(), 0);
    for (int block = 0; block < blocks; ++block) {
      int open = 0;
      for (int y = 0; y <= camera_.size.height; ++y) {
        const int before = open;
        open += begun[BlockRow(block, y)];
        if (before == 0 && open > 0) {
          runs_.push_back({block, y, y, floats_});
        } else if (before > 0 && open == 0) {
          runs_.back().bottom = y;
          floats_ += Floats(y + 1 - runs_.back().top);
        }
        if (open > 0) run_of[BlockRow(block, y)] = runs_.size() - 1;
      }
    }
    return run_of;
  }

  FloatArray Zeros() const {
    FloatArray floats = hwy::AllocateAligned<float>(std::max<std::size_t>(floats_, kColumns));
    std::fill_n(floats.get(), floats_, 0.0F);
    return floats;
  }

  /// What M is multiplied by where it is summed: for evidence "picture" the informative share w and
  /// the foreground B, for evidence "person" only B - background_cost (w - B).
  void FillImages() {
    const bool picture = options_.evidence == Evidence::kPicture;
    difference_ = Zeros();
    first_ = Zeros();
    sum_first_ = Zeros();
    if (picture) {
      second_ = Zeros();
      sum_second_ = Zeros();
      sum_b_ = cv::sum(foreground_)[0];
    }
    outside_m_ = camera_.pixels;
    outside_b_ = sum_b_;
    const auto cost = static_cast<float>(options_.background_cost);
    for (const Run& run : runs_) {
      const int left = run.block * kColumns;
      const int width = std::min(kColumns, camera_.size.width - left);
      for (int y = run.top; y < run.bottom; ++y) {
        const std::size_t at = run.begin + Floats(y - run.top);
        const float* const b = foreground_.ptr<float>(y) + left;
        const float* const w = camera_.informative_share.empty()
                                   ? nullptr
                                   : camera_.informative_share.ptr<float>(y) + left;
        for (int x = 0; x < width; ++x) {
          const float share = w == nullptr ? 1.0F : w[x];
          first_[at + static_cast<std::size_t>(x)] = picture ? share : b[x] - cost * (share - b[x]);
          if (!picture) continue;
          second_[at + static_cast<std::size_t>(x)] = b[x];
          outside_m_ -= static_cast<double>(share);
          outside_b_ -= static_cast<double>(b[x]);
        }
      }
    }
  }

  /// Sum over all runs of what is left below their last row.
  double SumOverRuns(const FloatArray& sums) const {
    double total = 0;
    for (const Run& run : runs_) {
      const float* const last = sums.get() + run.begin + Floats(run.bottom - run.top);
      for (int x = 0; x < kColumns; ++x) total += static_cast<double>(last[x]);
    }
    return total;
  }

  void AddPersonScores(const std::vector<double>& cover, std::vector<double>& scores) {
    SumPieces(pieces_, sum_first_.get(), values_.data());
    const float* value = values_.data();
    for (const Cell& c : cells_) {
      float sum = 0;
      for (std::size_t i = 0; i < c.pieces; ++i) sum += *value++;
      scores[c.slot] +=
          c.weight * options_.worth * static_cast<double>(sum) / (cover[c.slot] * c.area);
    }
  }

  void AddPictureScores(const std::vector<double>& cover, std::vector<double>& scores) {
    // Outside the runs nobody covers anything: M = 1.
    const PictureEvidence evidence(options_, camera_.pixels, sum_b_,
                                   outside_m_ + SumOverRuns(sum_first_),
                                   outside_b_ + SumOverRuns(sum_second_));
    second_values_.resize(values_.size());
    SumPieces(pieces_, sum_first_.get(), values_.data());
    SumPieces(pieces_, sum_second_.get(), second_values_.data());
    std::size_t piece = 0;
    for (const Cell& c : cells_) {
      double m = 0, mb = 0;
      for (const std::size_t end = piece + c.pieces; piece < end; ++piece) {
        m += static_cast<double>(values_[piece]);
        mb += static_cast<double>(second_values_[piece]);
      }
      scores[c.slot] += c.weight * evidence.Ratio(m, mb, cover[c.slot]);
    }
  }

  const OccupancyOptions& options_;
  const CameraCells& camera_;
  const cv::Mat& foreground_;
  std::vector<Cell> cells_;
  std::vector<CoverPiece> pieces_;
  std::vector<float> values_;  // one a piece
  std::vector<float> second_values_;
  std::vector<Run> runs_;
  std::size_t floats_ = 0;  // of all runs
  FloatArray difference_, first_, sum_first_;
  FloatArray second_, sum_second_;  // evidence "picture" only
  double sum_b_ = 0;
  double outside_m_ = 0;  // sums over the pixels outside the runs
  double outside_b_ = 0;
};

class FastSolver {
 public:
  explicit FastSolver(const Problem& problem) : problem_(problem) {
    for (std::size_t c = 0; c < problem.cameras.size(); ++c) {
      if (problem.foreground[c].given()) cameras_.emplace_back(problem, c);
    }
    ChooseCells();
  }

  SolveReport Solve(std::span<float> q) {
    const OccupancyOptions& options = problem_.options;
    std::vector<double> priors;
    for (const std::size_t cell : chosen_) priors.push_back(problem_.priors[cell]);
    CellStates states(options, priors);
    for (std::size_t slot = 0; slot < chosen_.size() && !problem_.previous.empty(); ++slot) {
      states.StartAt(slot, static_cast<double>(problem_.previous[chosen_[slot]]));
    }
    cover_.resize(chosen_.size());
    log_cover_.resize(chosen_.size());
    SolveReport report;
    report.cells_iterated = static_cast<std::int64_t>(chosen_.size());
    Convergence convergence(options);
    while (!report.converged && report.iterations < options.max_iterations) {
      report.last_change = Iterate(states);
      ++report.iterations;
      convergence.Add(report.last_change);
      report.converged = convergence.reached();
    }
    for (std::size_t slot = 0; slot < chosen_.size(); ++slot) {
      q[chosen_[slot]] = static_cast<float>(1 - states.absence(slot));
    }
    return report;
  }

 private:
  void ChooseCells() {
    std::vector<double> words(problem_.priors.size(), 0.0), shares(words);
    for (const CameraFrame& camera : cameras_) camera.AddForegroundShares(words, shares);
    const double cost = problem_.options.background_cost;
    const double least = problem_.options.evidence == Evidence::kPerson
                             ? std::min(kMinForegroundPerson, cost / (1 + cost))
                             : kMinForegroundPicture;
    slots_.assign(words.size(), -1);
    for (std::size_t cell = 0; cell < words.size(); ++cell) {
      if (words[cell] == 0 || shares[cell] < least * words[cell]) continue;
      slots_[cell] = static_cast<int>(chosen_.size());
      chosen_.push_back(cell);
    }
    left_ = taken_ = chosen_.size();
    for (CameraFrame& camera : cameras_) camera.Take(slots_);
  }

  /// Returns the largest change of a cell.
  double Iterate(CellStates& states) {
    for (std::size_t slot = 0; slot < chosen_.size(); ++slot) {
      const double n = states.absence(slot);
      const double ignored = std::min(problem_.options.ignored, 1 - Nothing(slot));
      cover_[slot] = std::max(n, kMinCover);
      log_cover_[slot] = n > ignored ? 0.0F : static_cast<float>(std::log(cover_[slot]));
    }
    scores_.assign(chosen_.size(), 0.0);
    for (CameraFrame& camera : cameras_) camera.AddScores(log_cover_, cover_, scores_);
    double change = 0;
    for (std::size_t slot = 0; slot < chosen_.size(); ++slot) {
      int& place = slots_[chosen_[slot]];
      if (place < 0) continue;
      const double before = states.absence(slot);
      change = std::max(change, states.Step(slot, scores_[slot]));
      if (1 - before < Nothing(slot) && states.absence(slot) >= before) {
        place = -1;
        --left_;
      }
    }
    // What is out covers nothing and is skipped; now and then it is worth looking where the rest
    // is.
    if (static_cast<double>(left_) < kWorthTakingAgain * static_cast<double>(taken_)) {
      for (CameraFrame& camera : cameras_) camera.Take(slots_);
      taken_ = left_;
    }
    return change;
  }

  double Nothing(std::size_t slot) const { return kNothing * problem_.priors[chosen_[slot]]; }

  const Problem& problem_;
  std::vector<CameraFrame> cameras_;
  std::vector<std::size_t> chosen_;  // cell of each slot
  std::vector<int> slots_;           // of each cell, negative: not iterated
  std::size_t left_ = 0;             // cells that are still iterated
  std::size_t taken_ = 0;            // cells that the cameras look at
  std::vector<double> cover_;
  std::vector<float> log_cover_;
  std::vector<double> scores_;
};

}  // namespace

SolveReport SolveFast(const Problem& problem, std::span<float> q) {
  // A cell that is not iterated is below any prior; one that no camera speaks for keeps its own.
  std::vector<std::uint8_t> spoken_for(q.size(), 0);
  for (std::size_t c = 0; c < problem.cameras.size(); ++c) {
    if (!problem.foreground[c].given()) continue;
    for (const CameraCells::Cell& cell : problem.cameras[c].cells) {
      spoken_for[static_cast<std::size_t>(cell.cell)] = 1;
    }
  }
  for (std::size_t cell = 0; cell < q.size(); ++cell) {
    q[cell] = spoken_for[cell] != 0 ? 0.0F : static_cast<float>(problem.priors[cell]);
  }
  return FastSolver(problem).Solve(q);
}

}  // namespace vantage::internal
