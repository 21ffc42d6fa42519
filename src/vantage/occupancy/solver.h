// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/occupancy/views.h"

namespace vantage {

/// Options of the occupancy maps (table [occupancy]); the defaults are those of the original POM
/// program.
struct OccupancyOptions {
  /// Probability that a cell is occupied before anything is seen, 0 < prior < 1.
  double prior = 0.01;
  /// Variance of the ratio between the pixels that a map explains wrongly and those that it covers,
  /// 1e-7 <= variance <= 10. Smaller: smaller people count, and noise too.
  double variance = 0.01;
  /// Share of the old value that a cell keeps in each iteration, 0 <= smoothing < 1.
  double smoothing = 0.8;
  /// Share of the picture that counts as covered whatever the map says, 1e-6 <= noise <= 1.
  double noise = 0.01;
  /// Iterations at most, 1 <= max_iterations <= 100000.
  int max_iterations = 100;
  /// An iteration that changes no cell by this much is stable, 0 <= tolerance <= 1.
  double tolerance = 1e-4;
  /// Iterations in a row that must be stable before the end, 1 <= stable_iterations <= 1000.
  int stable_iterations = 5;
  /// Cells whose probability of absence is above this do not enter the expected picture,
  /// 0.9 <= ignored <= 1. 0.99 is what the original program uses for speed; 1 leaves out none.
  double ignored = 1.0;
  /// Which cells a camera speaks for.
  Visibility visibility = Visibility::kCentre;
  /// The sides of a mask are divided by this before use (exact area averages),
  /// 1 <= reduction <= 64.
  int reduction = 1;
};
void VisitOptions(OccupancyOptions& options, OptionVisitor& visitor);

/// How the solution of one frame went.
struct SolveReport {
  int iterations = 0;
  /// Largest change of a cell in the last iteration.
  double last_change = 0;
  /// False when max_iterations came before stable_iterations in a row were stable.
  bool converged = false;
};

/// Probabilistic occupancy map: the probability of presence at every cell given the masks of all
/// cameras at one instant. Fixed-point iteration for the product law closest to the posterior
/// (F. Fleuret et al., "Multicamera People Tracking with a Probabilistic Occupancy Map", PAMI 2008;
/// algorithms.md section 3), every frame by itself. Immutable: frames may be solved in parallel.
class OccupancySolver {
 public:
  /// Fails when there is no view, the views are not of the same number of cells (1 to 4 million), a
  /// rectangle leaves its picture, or an option breaks its rule. The solver itself uses neither
  /// `visibility` nor `reduction`: BuildView does.
  static Result<OccupancySolver> Create(const std::vector<CameraView>& views,
                                        const OccupancyOptions& options);

  /// Writes the probability of presence of every cell into `q` (cell_count() values). `masks` has
  /// one mask for each view, CV_8UC1 of the view's mask_size, 0 background to 255 foreground;
  /// values between are soft evidence. An empty cv::Mat: that camera has no picture now and is left
  /// out. Fails, naming the camera by its index, when a mask has another type or size. Thread-safe.
  Result<SolveReport> Solve(std::span<const cv::Mat> masks, std::span<float> q) const;

  std::size_t cell_count() const { return cell_count_; }
  std::size_t camera_count() const { return cameras_.size(); }

 private:
  struct Workspace;
  /// A visible cell and where the corners of its rectangle are in an array of
  /// (width + 1) x (height + 1) values, one for each corner of a pixel.
  struct VisibleCell {
    CellIndex cell;
    int top_left, top_right, bottom_left, bottom_right;
  };
  /// A mask as float in [0, 1] at the view's size, and its sum; empty where a camera has none.
  struct Evidence {
    cv::Mat b;
    double sum = 0;
  };
  struct CameraCells {
    ImageSize mask_size;
    ImageSize size;
    std::vector<VisibleCell> cells;
  };

  OccupancySolver() = default;
  Result<std::vector<Evidence>> Prepare(std::span<const cv::Mat> masks) const;
  static void BuildSums(const CameraCells& camera, const cv::Mat& b_image, Workspace& work);
  void AddLogRatios(const CameraCells& camera, const Evidence& evidence, Workspace& work) const;

  OccupancyOptions options_;
  std::size_t cell_count_ = 0;
  std::vector<CameraCells> cameras_;
};

}  // namespace vantage
