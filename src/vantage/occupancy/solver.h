// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/occupancy/occupancy_options.h"
#include "vantage/occupancy/views.h"

namespace vantage {

namespace internal {
struct CameraCells;
struct Foreground;
}  // namespace internal

/// How the solution of one frame went.
struct SolveReport {
  int iterations = 0;
  /// Largest change of a cell in the last iteration.
  double last_change = 0;
  /// False when max_iterations came before stable_iterations in a row were stable.
  bool converged = false;
  /// Cameras without a picture, which were left out of all sums.
  int cameras_left_out = 0;
  /// Cells that were iterated; the others keep at most their prior.
  std::int64_t cells_iterated = 0;
};

/// Probabilistic occupancy map: the probability of presence q_i at every cell given the masks of
/// all cameras at one instant (F. Fleuret et al., "Multicamera People Tracking with a Probabilistic
/// Occupancy Map", PAMI 2008; algorithms.md section 3). With n = 1 - q the absence, B_c the mask of
/// camera c and M_c(x), the product of n_i over the rectangles A_i that contain pixel x, the
/// probability that nobody covers x, it is a fixed point of
///
///     n_i = 1 / (1 + exp(logit(prior_i) + sum over c of w_ic r_ic))
///
/// w_ic is what the camera's word counts (CameraView::weights). Sums are over informative pixels.
///
/// Evidence "picture" is the original program's: r_ic compares how large a share of what the map
/// covers it explains wrongly, over the whole picture, with and without a person at i (formulas in
/// algorithms.md). One person is then worth the less the more people there are.
///
/// Evidence "person" counts pixels in persons. The energy of camera c given the occupancy X is
///
///     E_c = worth sum over x of [B (1 - A) + background_cost (1 - B) A] / (pixels of a person at
///     x)
///
/// with A(x) = 1 where somebody covers x. It is linear in A, so that its mean under the product law
/// needs no approximation (the article puts the mean of A into a ratio), and the fixed point is
///
///     r_ic = worth / |A_i| sum over A_i of (M_c / n_i) (B_c - background_cost (1 - B_c)):
///
/// the share of the person that only a person at i explains, less the share that nothing bears out.
/// It depends neither on resolution or distance, nor on how many people there are elsewhere.
///
/// Every frame by itself, unless begun at an earlier map. Immutable: frames may be solved in
/// parallel.
class OccupancySolver {
 public:
  /// `priors`: none, or for each cell in place of options.prior, strictly between 0 and 1. Fails
  /// when there is no view, the views or priors are not of the same number of cells (1 to
  /// 4 million), a rectangle leaves its picture, or an option breaks its rule. The solver itself
  /// uses neither `visibility` nor `reduction` (BuildView does) nor `warm_start` (see Solve).
  static Result<OccupancySolver> Create(const std::vector<CameraView>& views,
                                        const OccupancyOptions& options,
                                        std::vector<double> priors = {});

  OccupancySolver(OccupancySolver&&) noexcept;
  OccupancySolver& operator=(OccupancySolver&&) noexcept;
  ~OccupancySolver();

  /// Writes the probability of presence of every cell into `q` (cell_count() values). `masks` has
  /// one mask for each view, CV_8UC1 of the view's mask_size, 0 background to 255 foreground;
  /// values between are soft evidence. An empty cv::Mat: that camera has no picture now and is left
  /// out. `previous`: none, or a map to begin at (the iteration has several fixed points and finds
  /// one near its start). Fails when `previous` has a value outside [0, 1], or, naming the camera
  /// by its index, when a mask has another type or size. Thread-safe.
  Result<SolveReport> Solve(std::span<const cv::Mat> masks, std::span<float> q,
                            std::span<const float> previous = {}) const;

  std::size_t cell_count() const { return priors_.size(); }
  std::size_t camera_count() const;

 private:
  OccupancySolver();

  OccupancyOptions options_;
  std::vector<double> priors_;
  std::vector<internal::CameraCells> cameras_;
};

}  // namespace vantage
