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

constexpr double kMinForeground = 0.25;
constexpr double kMinCover = 1e-4;
/// A cell whose presence is below this share of its prior covers nothing, and is out if it does not
/// rise.
constexpr double kNothing = 0.1;

/// Rows of floats for a picture, with one row more below; all 0.
class Rows {
 public:
  Rows(ImageSize size, std::size_t stride)
      : values_(hwy::AllocateAligned<float>(stride * Count(size))) {
    std::fill_n(values_.get(), stride * Count(size), 0.0F);
  }
  float* data() { return values_.get(); }
  const float* data() const { return values_.get(); }

 private:
  static std::size_t Count(ImageSize size) { return static_cast<std::size_t>(size.height) + 1; }
  hwy::AlignedFreeUniquePtr<float[]> values_;
};

/// One camera's part of a frame.
class CameraFrame {
 public:
  CameraFrame(const Problem& problem, std::size_t camera)
      : options_(problem.options),
        camera_(problem.cameras[camera]),
        foreground_(problem.foreground[camera].image),
        stride_((static_cast<std::size_t>(camera_.size.width) + kColumns - 1) / kColumns *
                kColumns),
        difference_(camera_.size, stride_),
        covered_(camera_.size, stride_),
        sum_m_(camera_.size, stride_) {}

  /// Adds to each cell what the camera's word counts, and that times the share of the rectangle
  /// that is foreground.
  void AddForegroundShares(std::vector<double>& words, std::vector<double>& shares) const {
    cv::Mat_<double> sums;
    cv::integral(foreground_, sums, CV_64F);
    for (const CameraCells::Cell& c : camera_.cells) {
      const cv::Rect& r = c.rectangle;
      const double sum = sums(r.y + r.height, r.x + r.width) - sums(r.y + r.height, r.x) -
                         sums(r.y, r.x + r.width) + sums(r.y, r.x);
      const auto cell = static_cast<std::size_t>(c.cell);
      words[cell] += static_cast<double>(c.weight);
      shares[cell] += static_cast<double>(c.weight) * sum / r.area();
    }
  }

  /// `slots`: the place of each cell among those that are iterated, negative for the others.
  void Take(const std::vector<int>& slots) {
    for (const CameraCells::Cell& c : camera_.cells) {
      const int slot = slots[static_cast<std::size_t>(c.cell)];
      if (slot < 0) continue;
      const cv::Rect& r = c.rectangle;
      const std::size_t top =
          static_cast<std::size_t>(r.y) * stride_ + static_cast<std::size_t>(r.x);
      const std::size_t bottom = top + static_cast<std::size_t>(r.height) * stride_;
      cells_.push_back({slot, r.width, top, bottom, static_cast<double>(r.area()),
                        static_cast<double>(c.weight)});
    }
    FindRuns(slots);
    FillImages();
  }

  /// Drops the cells whose slot is no longer iterated.
  void Keep(const std::vector<std::uint8_t>& iterated) {
    std::erase_if(cells_,
                  [&](const Cell& c) { return iterated[static_cast<std::size_t>(c.slot)] == 0; });
  }

  /// `log_cover`: of each slot, the logarithm of its absence as M sees it; `cover`: that absence.
  /// Adds w r to the scores.
  void AddScores(const std::vector<float>& log_cover, const std::vector<double>& cover,
                 std::vector<double>& scores) {
    for (const Cell& c : cells_) {
      const float log_n = log_cover[static_cast<std::size_t>(c.slot)];
      if (log_n == 0) continue;
      float* const top = difference_.data() + c.top;
      float* const bottom = difference_.data() + c.bottom;
      for (int x = 0; x < c.width; ++x) top[x] += log_n;
      for (int x = 0; x < c.width; ++x) bottom[x] -= log_n;
    }
    const bool picture = options_.evidence == Evidence::kPicture;
    const CoverImages images{
        stride_,         difference_.data(),
        covered_.data(), second_.empty() ? nullptr : second_.front().data(),
        sum_m_.data(),   sum_second_.empty() ? nullptr : sum_second_.front().data()};
    for (const ColumnRun& run : runs_) SumCovered(run, images);
    if (picture) {
      AddPictureScores(cover, scores);
    } else {
      for (const Cell& c : cells_) {
        const auto slot = static_cast<std::size_t>(c.slot);
        scores[slot] += c.weight * options_.worth * BoxSum(sum_m_, c) / (cover[slot] * c.area);
      }
    }
  }

 private:
  struct Cell {
    int slot;
    int width;
    std::size_t top, bottom;  // where the row of the rectangle and the row below it begin
    double area;
    double weight;
  };

  double BoxSum(const Rows& sums, const Cell& c) const {
    const float* const top = sums.data() + c.top;
    const float* const bottom = sums.data() + c.bottom;
    float sum = 0;
    for (int x = 0; x < c.width; ++x) sum += bottom[x] - top[x];
    return static_cast<double>(sum);
  }

  /// The runs of columns that the rectangles of the iterated cells touch.
  void FindRuns(const std::vector<int>& slots) {
    const auto rows = static_cast<std::size_t>(camera_.size.height) + 1;
    std::vector<int> begun(stride_ / kColumns * rows, 0);  // rectangles that begin less end
    for (const CameraCells::Cell& c : camera_.cells) {
      if (slots[static_cast<std::size_t>(c.cell)] < 0) continue;
      const cv::Rect& r = c.rectangle;
      for (int block = r.x / kColumns; block <= (r.x + r.width - 1) / kColumns; ++block) {
        int* const column = begun.data() + static_cast<std::size_t>(block) * rows;
        ++column[r.y];
        --column[r.y + r.height];
      }
    }
    for (std::size_t block = 0; block < stride_ / kColumns; ++block) {
      int open = 0;
      for (std::size_t y = 0; y < rows; ++y) {
        const int before = open;
        open += begun[block * rows + y];
        if (before == 0 && open > 0) {
          runs_.push_back({static_cast<int>(block) * kColumns, static_cast<int>(y), 0});
        } else if (before > 0 && open == 0) {
          runs_.back().bottom = static_cast<int>(y);
        }
      }
    }
  }

  /// What M is multiplied by where it is summed. Evidence "person" needs one sum only: that of
  /// M (B - background_cost (w - B)).
  void FillImages() {
    const bool picture = options_.evidence == Evidence::kPicture;
    if (picture) {
      second_.emplace_back(camera_.size, stride_);
      sum_second_.emplace_back(camera_.size, stride_);
    }
    const auto cost = static_cast<float>(options_.background_cost);
    for (const ColumnRun& run : runs_) {
      const int end = std::min(run.x + kColumns, camera_.size.width);
      for (int y = run.top; y < run.bottom; ++y) {
        const float* const b = foreground_.ptr<float>(y);
        const float* const w =
            camera_.informative_share.empty() ? nullptr : camera_.informative_share.ptr<float>(y);
        float* const first = covered_.data() + static_cast<std::size_t>(y) * stride_;
        for (int x = run.x; x < end; ++x) {
          const float share = w == nullptr ? 1.0F : w[x];
          first[x] = picture ? share : b[x] - cost * (share - b[x]);
          outside_m_ -= static_cast<double>(share);
          outside_b_ -= static_cast<double>(b[x]);
        }
        if (picture) {
          std::copy(b + run.x, b + end,
                    second_.front().data() + static_cast<std::size_t>(y) * stride_ + run.x);
        }
      }
    }
    sum_b_ = cv::sum(foreground_)[0];
    outside_m_ += camera_.pixels;
    outside_b_ += sum_b_;
  }

  /// Sum over all runs of what is left at their bottom.
  double SumOverRuns(const Rows& sums) const {
    double total = 0;
    for (const ColumnRun& run : runs_) {
      const float* const last =
          sums.data() + static_cast<std::size_t>(run.bottom) * stride_ + run.x;
      for (int x = 0; x < kColumns; ++x) total += static_cast<double>(last[x]);
    }
    return total;
  }

  void AddPictureScores(const std::vector<double>& cover, std::vector<double>& scores) const {
    const Rows& sum_mb = sum_second_.front();
    // Outside the runs nobody covers anything: M = 1.
    const PictureEvidence evidence(options_, camera_.pixels, sum_b_,
                                   outside_m_ + SumOverRuns(sum_m_),
                                   outside_b_ + SumOverRuns(sum_mb));
    for (const Cell& c : cells_) {
      const auto slot = static_cast<std::size_t>(c.slot);
      scores[slot] += c.weight * evidence.Ratio(BoxSum(sum_m_, c), BoxSum(sum_mb, c), cover[slot]);
    }
  }

  const OccupancyOptions& options_;
  const CameraCells& camera_;
  const cv::Mat& foreground_;
  std::size_t stride_;
  Rows difference_;
  Rows covered_;  // what M is multiplied by
  Rows sum_m_;
  std::vector<Rows> second_;  // evidence "picture": the foreground
  std::vector<Rows> sum_second_;
  std::vector<Cell> cells_;
  std::vector<ColumnRun> runs_;
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
    iterated_.assign(chosen_.size(), 1);
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
    std::vector<int> slots(words.size(), -1);
    for (std::size_t cell = 0; cell < words.size(); ++cell) {
      if (words[cell] == 0 || shares[cell] < kMinForeground * words[cell]) continue;
      slots[cell] = static_cast<int>(chosen_.size());
      chosen_.push_back(cell);
    }
    for (CameraFrame& camera : cameras_) camera.Take(slots);
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
    bool gave_way = false;
    for (std::size_t slot = 0; slot < chosen_.size(); ++slot) {
      if (iterated_[slot] == 0) continue;
      const double before = states.absence(slot);
      change = std::max(change, states.Step(slot, scores_[slot]));
      if (1 - before < Nothing(slot) && states.absence(slot) >= before) {
        iterated_[slot] = 0;
        gave_way = true;
      }
    }
    if (gave_way) {
      for (CameraFrame& camera : cameras_) camera.Keep(iterated_);
    }
    return change;
  }

  double Nothing(std::size_t slot) const { return kNothing * problem_.priors[chosen_[slot]]; }

  const Problem& problem_;
  std::vector<CameraFrame> cameras_;
  std::vector<std::size_t> chosen_;  // cell of each slot
  std::vector<std::uint8_t> iterated_;
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
