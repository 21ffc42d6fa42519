// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace vantage {

/// A connected component C of a mask (eq. 7), neighbours on all 8 sides.
struct Component {
  cv::Rect box;     ///< bounding box in the picture, px
  int area_px = 0;  ///< |C|
  cv::Rect window;  ///< the box grown on each side, as far as the picture goes
  cv::Mat pixels;   ///< CV_8UC1 of the window's size, 255 in C
};

/// The components of at least `min_area_px` pixels, in the order of their first pixels, row by row.
/// `mask` is CV_8UC1; not 0 is foreground. Their windows are the boxes grown by `margin_px`.
std::vector<Component> FindComponents(const cv::Mat& mask, int min_area_px, int margin_px);

/// The regions around a component's border in which its edges are sought (thesis, figure 2);
/// CV_8UC1 of the window's size, 255 inside. Where the picture's edge cuts a component there is no
/// border.
struct BorderRegions {
  cv::Mat true_border;  ///< C_tb: the pixels of C with a neighbour, of 8, outside C
  cv::Mat expanded;     ///< C': C_tb grown by the half width
  cv::Mat expansion;    ///< C_eb = C' without C_tb
};

/// `half_width_px` >= 1: C' is 2 * half_width_px + 1 pixels wide. The component's window must be at
/// least that much larger than its box.
BorderRegions BorderOf(const Component& component, int half_width_px);

}  // namespace vantage
