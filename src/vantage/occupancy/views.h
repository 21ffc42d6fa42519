// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"
#include "vantage/geometry/grid.h"
#include "vantage/geometry/person.h"

namespace vantage {

/// Which cells a camera speaks for (algorithms.md section 3; thesis 4.4.2).
enum class Visibility {
  kGround,    ///< the foot point is in the picture
  kComplete,  ///< the whole rectangle of a person at the cell is
  kCentre,    ///< the rectangle's centre of gravity is (the thesis's proposal)
  /// any of the rectangle is; the camera's word counts as much as the share of the rectangle that
  /// is in the picture (the thesis's ideal, which it did not build)
  kContinuous,
};

/// What one camera would see of a person at each cell of a grid.
struct CameraView {
  /// Size of the masks that the camera delivers.
  ImageSize mask_size;
  /// Size that masks are reduced to before use; the rectangles are in pixels of this picture.
  ImageSize size;
  /// A person at cell i covers the pixels [x, x + width) x [y, y + height) of rectangles[i], inside
  /// the picture. Empty: the camera does not speak for the cell.
  std::vector<cv::Rect> rectangles;
  /// CV_8UC1 of mask_size: 255 where a pixel says something of people on the ground, 0 where it
  /// says nothing (a post that hides them). Empty: all pixels speak.
  cv::Mat informative = {};
  /// What the camera's word counts for each cell, 0 to 1. Empty: 1 for every cell.
  std::vector<float> weights = {};
};

/// Size of a picture whose sides are divided by `reduction` (>= 1) and rounded, at least 1 px.
ImageSize ReducedSize(ImageSize size, double reduction);

/// The largest number up to 16 that divides both sides of the masks and leaves a person at least 5
/// pixels wide in three quarters of the cells that `camera` sees; 1 when there is none.
int AutomaticReduction(const Camera& camera, const GroundGrid& grid, const PersonOptions& person);

/// The view of `camera` (of the size that its masks have) over `grid`, in masks reduced by
/// `reduction`. A pixel belongs to a person when its centre does; a rectangle without any pixel is
/// not visible, nor is one without any informative pixel (`informative` as in CameraView). Fails
/// when reduction < 1 or not finite, the grid is empty or `informative` has another type or size.
Result<CameraView> BuildView(const Camera& camera, const GroundGrid& grid,
                             const PersonOptions& person, Visibility rule, double reduction,
                             const cv::Mat& informative = {});

/// 1 for each cell that at least one camera speaks for. All views are of the same grid.
std::vector<std::uint8_t> VisibleCells(std::span<const CameraView> views);

}  // namespace vantage
