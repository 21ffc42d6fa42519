// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/geometry/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vantage {
namespace {

using Eigen::Vector2d;

constexpr double kMaxCoordinate_m = 10'000;
constexpr double kMinArea_m2 = 1e-4;
constexpr double kEdge_m = 1e-9;
constexpr std::size_t kMaxCorners = 1000;

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double DistanceToSegment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - (a + t * ab)).norm();
}

bool ProperlyCross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const auto side = [](const Vector2d& p, const Vector2d& q, const Vector2d& r) {
    return Cross(q - p, r - p);
  };
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

/// True when edges i < j have a point in common that simple polygons' edges do not have.
bool Touch(const std::vector<Vector2d>& corners, std::size_t i, std::size_t j) {
  const std::size_t n = corners.size();
  const Vector2d& a = corners[i];
  const Vector2d& b = corners[i + 1];
  const Vector2d& c = corners[j];
  const Vector2d& d = corners[(j + 1) % n];
  const auto on = [](const Vector2d& p, const Vector2d& from, const Vector2d& to) {
    return DistanceToSegment(p, from, to) <= kEdge_m;
  };
  if (j == i + 1) return on(a, c, d) || on(d, a, b);            // they share b = c
  if (i == 0 && j == n - 1) return on(b, c, d) || on(c, a, b);  // they share a = d
  return ProperlyCross(a, b, c, d) || on(a, c, d) || on(b, c, d) || on(c, a, b) || on(d, a, b);
}

}  // namespace

Result<Polygon> Polygon::Create(std::vector<Vector2d> corners_m) {
  const std::size_t n = corners_m.size();
  if (n < 3) return Fail("area: {} corners; a polygon has at least 3", n);
  if (n > kMaxCorners) return Fail("area: {} corners; a polygon has at most {}", n, kMaxCorners);
  for (std::size_t i = 0; i < n; ++i) {
    if (!corners_m[i].allFinite() || corners_m[i].cwiseAbs().maxCoeff() > kMaxCoordinate_m) {
      return Fail("area: corner {} is ({}, {}) m; corners are finite and within 10 km", i + 1,
                  corners_m[i].x(), corners_m[i].y());
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if ((corners_m[i] - corners_m[(i + 1) % n]).norm() <= kEdge_m) {
      return Fail("area: corners {} and {} are the same; list each corner once", i + 1,
                  (i + 1) % n + 1);
    }
  }
  for (std::size_t i = 0; i + 1 < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      if (Touch(corners_m, i, j)) {
        return Fail(
            "area: the edges after corners {} and {} cross or touch; list the corners in "
            "order around the area",
            i + 1, j + 1);
      }
    }
  }
  Polygon polygon;
  polygon.corners_m_ = std::move(corners_m);
  if (polygon.area_m2() < kMinArea_m2) return Fail("area: the polygon encloses no ground");
  return polygon;
}

Result<Polygon> Polygon::Rectangle(const Vector2d& min_m, const Vector2d& max_m) {
  return Create({min_m, {max_m.x(), min_m.y()}, max_m, {min_m.x(), max_m.y()}});
}

bool Polygon::Contains(const Vector2d& point_m) const {
  bool inside = false;
  const std::size_t n = corners_m_.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d& a = corners_m_[i];
    const Vector2d& b = corners_m_[(i + 1) % n];
    if (DistanceToSegment(point_m, a, b) <= kEdge_m) return true;
    if ((a.y() > point_m.y()) == (b.y() > point_m.y())) continue;
    const double x = a.x() + (point_m.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point_m.x() < x) inside = !inside;
  }
  return inside;
}

double Polygon::Distance(const Vector2d& point_m) const {
  if (Contains(point_m)) return 0;
  double distance = std::numeric_limits<double>::infinity();
  const std::size_t n = corners_m_.size();
  for (std::size_t i = 0; i < n; ++i) {
    distance =
        std::min(distance, DistanceToSegment(point_m, corners_m_[i], corners_m_[(i + 1) % n]));
  }
  return distance;
}

Vector2d Polygon::min_m() const {
  Vector2d result = corners_m_.front();
  for (const Vector2d& corner : corners_m_) result = result.cwiseMin(corner);
  return result;
}

Vector2d Polygon::max_m() const {
  Vector2d result = corners_m_.front();
  for (const Vector2d& corner : corners_m_) result = result.cwiseMax(corner);
  return result;
}

double Polygon::area_m2() const {
  double twice = 0;
  const std::size_t n = corners_m_.size();
  for (std::size_t i = 0; i < n; ++i) twice += Cross(corners_m_[i], corners_m_[(i + 1) % n]);
  return std::abs(twice) / 2;
}

}  // namespace vantage
