// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace vantage {

/// A connected component C of a mask (eq. 7).
struct Component {
  cv::Rect box;     ///< bounding box in the picture, px
  int area_px = 0;  ///< |C|
  cv::Rect window;  ///< the box grown on each side, as far as the picture goes
  cv::Mat pixels;   ///< CV_8UC1 of the window's size, 255 in C
};

/// What makes a component.
struct ComponentRule {
  /// Pixels are neighbours up to this many rows and columns apart, >= 1; 1: the 8 around each.
  int reach_px = 1;
  /// Components of fewer pixels are left out, px, >= 1.
  int min_area_px = 1;
  /// Growth of the windows, px, >= 0.
  int margin_px = 0;
};

/// The components of `mask` (CV_8UC1, not 0 is foreground) in the order of their first pixels, row
/// by row.
std::vector<Component> FindComponents(const cv::Mat& mask, const ComponentRule& rule);

/// `pixels` (CV_8UC1, 0 or 255) with the square of (2 * radius_px + 1)^2 pixels around each that is
/// set, as far as the picture goes.
cv::Mat Grown(const cv::Mat& pixels, int radius_px);

/// The regions around a component's border by which it is judged (thesis, figure 2); CV_8UC1 of the
/// window's size, 255 inside. Where the picture's edge cuts a component there is no border.
struct BorderRegions {
  cv::Mat true_border;  ///< C_tb: the pixels of C with a neighbour, of 8, outside C
  cv::Mat expanded;     ///< C': C_tb grown by the half width
  cv::Mat expansion;    ///< C_eb: C' without C_tb
  cv::Mat outer;        ///< C_ob: the ring just outside C and C', disjoint from both
  cv::Mat inside;       ///< C_ic: the ring just inside C_tb
  cv::Mat outside;      ///< C_oc: the ring just outside C_tb
  /// Share of C' that is left after what lies near other foreground was taken out, 0..1; 0 where
  /// there is no border.
  double free_share = 0;
};

/// `half_width_px` >= 1: C' is 2 * half_width_px + 1 pixels wide; `ring_px` >= 1 is the width of
/// C_ob, C_ic and C_oc. The window must be at least half_width_px + ring_px larger than the box on
/// each side. `others`, CV_8UC1 of the window's size or empty, is other foreground: what lies up to
/// half_width_px + 1 from it says nothing about this component and is taken out of all regions.
BorderRegions BorderOf(const Component& component, int half_width_px, int ring_px,
                       const cv::Mat& others = {});

}  // namespace vantage
