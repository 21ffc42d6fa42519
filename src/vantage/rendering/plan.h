// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "vantage/geometry/grid.h"
#include "vantage/rendering/people.h"
#include "vantage/scene/scene.h"

namespace vantage {

/// The corner of the grid with the lowest x and y, and the lengths of its sides, metres.
inline Eigen::Vector2d LowOf(const GroundGrid& grid) { return {grid.min_x_m, grid.min_y_m}; }
inline Eigen::Vector2d SideOf(const GroundGrid& grid) {
  return {grid.columns * grid.cell_m, grid.rows * grid.cell_m};
}

/// Bird's-eye plan of the scene's area: x to the right, y up, metres. Ground that cameras see is
/// lighter, the more of them the lighter; cameras beyond the plan's edge show as arrows on it.
class Plan {
 public:
  /// Draws what does not move. The area fills `size` up to a margin; `size` at least 64 x 64.
  Plan(const Scene& scene, cv::Size size);

  /// The rectangle [low, high] of the ground in metres, without cameras.
  Plan(const Scene& scene, const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m,
       cv::Size size);

  /// Draws a camera on a plan: a wedge where it stands, an arrow towards it when that is outside.
  void DrawCamera(cv::Mat& plan, const Camera& camera, const std::string& name,
                  const cv::Scalar& color) const;

  /// The plan with these people: dots with numbers and trails (CV_8UC3).
  cv::Mat Draw(const std::vector<Person>& people) const;

  cv::Point2d PixelFromGround(const Eigen::Vector2d& ground_m) const;
  Eigen::Vector2d GroundFromPixel(const cv::Point2d& pixel) const;

 private:
  void DrawCoverage(const Scene& scene);
  void DrawGrid();
  void DrawScaleBar();

  cv::Mat ground_;
  double unit_ = 1;  ///< sizes follow the plan's: 1 for 600 pixels
  double pixels_per_m_ = 1;
  Eigen::Vector2d center_m_ = {0, 0};
  cv::Point2d center_px_;
};

}  // namespace vantage
