// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/occupancy/views.h"

namespace vantage::internal {

/// A view as the solvers take it: only the cells that the camera speaks for and of whose rectangles
/// it sees anything.
struct CameraCells {
  struct Cell {
    CellIndex cell;
    cv::Rect rectangle;  // not empty, inside the picture
    float weight;        // what the camera's word counts for the cell, 0 to 1
    double area;         // informative pixels of the rectangle
  };
  ImageSize mask_size;
  ImageSize size;
  std::vector<Cell> cells;
  /// Of mask_size, 255 or 0; empty: every pixel is informative.
  cv::Mat informative;
  /// CV_32FC1 of `size`: share of each pixel that is informative; empty: 1 everywhere.
  cv::Mat informative_share;
  /// Sum of the shares.
  double pixels = 0;
};

/// Fails, naming the camera by its index, when the view does not have `cells` cells, a rectangle
/// leaves the picture, a weight is not between 0 and 1, or `informative` is not of the masks' size.
Result<CameraCells> MakeCameraCells(const CameraView& view, std::size_t index, std::size_t cells);

/// What one camera says of a frame: the average of mask / 255 over the informative part of each
/// pixel of the view, times the share of that part. None: the camera has no picture now.
struct Foreground {
  cv::Mat image;  // CV_32FC1
  bool given() const { return !image.empty(); }
};

/// `mask`: CV_8UC1 of mask_size; fails when it has another type or size. Exact area averages.
Result<Foreground> MakeForeground(const CameraCells& camera, std::size_t index,
                                  const cv::Mat& mask);

}  // namespace vantage::internal
