// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "vantage/metrics/assignment.h"
#include "vantage/tracks/box_track.h"
#include "vantage/tracks/track.h"

/// Internal to the metrics module: what sets the ground and pictures apart.

namespace vantage::metrics {

template <class AnyTrack>
using PointOf = typename decltype(AnyTrack::points)::value_type;

/// Positions on the ground in metres.
struct GroundComparison {
  double threshold_m;

  double LargestDistance() const { return threshold_m; }
  /// Forbidden where the two do not match.
  double Distance(const TrackPoint& a, const TrackPoint& b) const {
    const double distance_m = (Position(a) - Position(b)).norm();
    return distance_m < threshold_m ? distance_m : CostMatrix::kForbidden;
  }
  /// 0 to 1; 0.5 at the threshold, as usual in pictures.
  double Similarity(const TrackPoint& a, const TrackPoint& b) const {
    return std::max(0.0, 1 - (Position(a) - Position(b)).norm() / (2 * threshold_m));
  }
  static Eigen::Vector2d Position(const TrackPoint& point) { return {point.x_m, point.y_m}; }
};

/// Boxes in a picture in pixels.
struct BoxComparison {
  double min_iou;

  double LargestDistance() const { return 1; }
  double Distance(const BoxPoint& a, const BoxPoint& b) const {
    const double iou = Similarity(a, b);
    return iou >= min_iou ? 1 - iou : CostMatrix::kForbidden;
  }
  /// Intersection over union.
  static double Similarity(const BoxPoint& a, const BoxPoint& b) {
    const double width =
        std::min(a.left_px + a.width_px, b.left_px + b.width_px) - std::max(a.left_px, b.left_px);
    const double height =
        std::min(a.top_px + a.height_px, b.top_px + b.height_px) - std::max(a.top_px, b.top_px);
    if (width <= 0 || height <= 0) return 0;
    const double shared = width * height;
    return shared / (a.width_px * a.height_px + b.width_px * b.height_px - shared);
  }
  static Eigen::Vector2d Position(const BoxPoint& point) {
    return {point.left_px + point.width_px / 2, point.top_px + point.height_px / 2};
  }
};

}  // namespace vantage::metrics
