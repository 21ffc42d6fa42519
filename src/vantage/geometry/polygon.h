// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "vantage/base/result.h"

namespace vantage {

/// A simple polygon on the ground in metres, in either orientation, not repeated at the end.
class Polygon {
 public:
  /// Fails for fewer than 3 or more than 1000 corners, corners that are not finite or beyond 10 km
  /// or repeated, edges that cross or touch, or an area under 1 cm^2.
  static Result<Polygon> Create(std::vector<Eigen::Vector2d> corners_m);
  /// The rectangle [min, max]; same failures.
  static Result<Polygon> Rectangle(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m);

  /// True inside and on the edge (to 1e-9 m).
  bool Contains(const Eigen::Vector2d& point_m) const;
  /// Distance to the polygon; 0 inside.
  double Distance(const Eigen::Vector2d& point_m) const;

  const std::vector<Eigen::Vector2d>& corners_m() const { return corners_m_; }
  Eigen::Vector2d min_m() const;
  Eigen::Vector2d max_m() const;
  double area_m2() const;

 private:
  std::vector<Eigen::Vector2d> corners_m_;
};

}  // namespace vantage
