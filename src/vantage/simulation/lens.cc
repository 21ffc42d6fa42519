// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/lens.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace vantage::simulation::internal {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Bounding box of points in the picture; `whole` once one of them has no pixel though others do.
class PointBox {
 public:
  PointBox(const Camera& camera, double mirror_z) : camera_(camera), mirror_z_(mirror_z) {}

  void Add(const Vector3d& world_m) {
    const auto pixel = camera_.ImageFromWorld({world_m.x(), world_m.y(), mirror_z_ * world_m.z()});
    if (!pixel) {
      missing_ = true;
      return;
    }
    min_ = min_.cwiseMin(*pixel);
    max_ = max_.cwiseMax(*pixel);
    some_ = true;
  }
  void AddWhole() { missing_ = some_ = true; }

  /// Clipped to the picture, with a margin for the lens between the points.
  cv::Rect Pixels() const {
    if (!some_) return {};
    const cv::Rect picture(0, 0, camera_.size().width, camera_.size().height);
    if (missing_) return picture;
    constexpr double kMargin_px = 1;
    const auto bound = [](double value, int high) {
      return static_cast<int>(std::clamp(value, -1.0, static_cast<double>(high) + 1));
    };
    const int left = bound(std::floor(min_.x() - kMargin_px), picture.width);
    const int top = bound(std::floor(min_.y() - kMargin_px), picture.height);
    const int right = bound(std::ceil(max_.x() + kMargin_px), picture.width);
    const int bottom = bound(std::ceil(max_.y() + kMargin_px), picture.height);
    return cv::Rect(left, top, right - left + 1, bottom - top + 1) & picture;
  }

 private:
  const Camera& camera_;
  double mirror_z_;
  Eigen::Vector2d min_ = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d max_ = Eigen::Vector2d::Constant(-1e9);
  bool some_ = false;
  bool missing_ = false;
};

/// Adds a square across the line of sight that hides the sphere.
void AddSphere(const Vector3d& eye_m, const Vector3d& center_m, double radius_m, PointBox& box) {
  const Vector3d way = center_m - eye_m;
  const double distance = way.norm();
  if (distance < 1.5 * radius_m) return box.AddWhole();
  const Vector3d ahead = way / distance;
  const Vector3d side = ahead.unitOrthogonal();
  const Vector3d up = ahead.cross(side);
  // The cone of tangents, where it crosses the plane through the centre.
  const double share = radius_m / distance;
  const double reach = radius_m / std::sqrt(1 - share * share);
  for (const double sign : {-1.0, 1.0}) {
    box.Add(center_m + reach * (side + sign * up));
    box.Add(center_m - reach * (side + sign * up));
  }
}

/// How far a mirrored ray may have strayed at a point of this height, seen along the mirror image.
double Stray(const Vector3d& eye_m, const Vector3d& point_m, double roughness_rad) {
  const Vector3d image(point_m.x(), point_m.y(), -point_m.z());
  const double height = std::max(0.0, point_m.z());
  const double share = height / std::max(1e-3, height + eye_m.z());
  return std::tan(roughness_rad) * share * (image - eye_m).norm();
}

}  // namespace

PixelRays::PixelRays(const Camera& camera)
    : width_(camera.size().width),
      height_(camera.size().height),
      center_m_(camera.center_m().cast<float>()) {
  directions_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto ray = camera.RayFromImage({x, y});
      directions_.push_back(ray ? Vector3f(ray->cast<float>()) : Vector3f::Zero());
    }
  }
}

Ray PixelRays::Through(int x, int y, float dx, float dy) const {
  const Vector3f& here = At(x, y);
  // The neighbour on the other side where there is none on this one.
  const auto step = [&](int nx, int ny, float offset) -> Vector3f {
    if (nx < 0 || ny < 0 || nx >= width_ || ny >= height_ || !Exists(nx, ny)) {
      return Vector3f::Zero();
    }
    return offset * (At(nx, ny) - here);
  };
  const int side_x = x + 1 < width_ ? 1 : -1;
  const int side_y = y + 1 < height_ ? 1 : -1;
  const Vector3f direction = here + step(x + side_x, y, dx * static_cast<float>(side_x)) +
                             step(x, y + side_y, dy * static_cast<float>(side_y));
  return {center_m_, direction.normalized()};
}

Footprint FootprintOf(const Camera& camera, std::span<const Limb> limbs,
                      std::span<const Block> blocks, bool mirrored, float roughness_rad) {
  // Mirrored things are seen where their images below the ground would be: the eye is mirrored
  // instead of them, and each point again when it is projected.
  Vector3d eye_m = camera.center_m();
  if (mirrored) eye_m.z() = -eye_m.z();
  const double mirror_z = mirrored ? -1 : 1;
  const auto stray = [&](const Vector3d& point_m) {
    return mirrored ? Stray(camera.center_m(), point_m, roughness_rad) : 0;
  };
  std::vector<cv::Rect> boxes;
  Footprint footprint;
  const auto add = [&](const PointBox& box) {
    const cv::Rect pixels = box.Pixels();
    if (pixels.empty()) return;
    footprint.box = footprint.box.empty() ? pixels : footprint.box | pixels;
    boxes.push_back(pixels);
  };
  for (const Limb& limb : limbs) {
    // Short pieces, so that the boxes of slanting limbs are not mostly empty.
    const Vector3d a = limb.a_m.cast<double>();
    const Vector3d b = limb.b_m.cast<double>();
    const double girth = std::max(limb.a_radius_m, limb.b_radius_m);
    const int pieces = std::clamp(static_cast<int>((b - a).norm() / (2 * girth + 1e-3)), 1, 4);
    for (int piece = 0; piece < pieces; ++piece) {
      PointBox box(camera, mirror_z);
      for (const int end : {piece, piece + 1}) {
        const double share = static_cast<double>(end) / pieces;
        const Vector3d center = a + share * (b - a);
        const double radius = limb.a_radius_m + share * (limb.b_radius_m - limb.a_radius_m);
        AddSphere(eye_m, center, radius + stray(center), box);
      }
      add(box);
    }
  }
  for (const Block& block : blocks) {
    PointBox box(camera, mirror_z);
    for (const Vector3f& corner : BlockCorners(block)) {
      const Vector3d point = corner.cast<double>();
      if (mirrored) {
        AddSphere(eye_m, point, stray(point) + 1e-3, box);
      } else {
        box.Add(point);
      }
    }
    add(box);
  }
  footprint.in.assign(static_cast<std::size_t>(footprint.box.area()), 0);
  for (const cv::Rect& box : boxes) {
    for (int y = box.y; y < box.y + box.height; ++y) {
      const auto row = footprint.in.begin() +
                       static_cast<std::ptrdiff_t>(y - footprint.box.y) * footprint.box.width +
                       (box.x - footprint.box.x);
      std::fill(row, row + box.width, std::uint8_t{1});
    }
  }
  return footprint;
}

}  // namespace vantage::simulation::internal
