// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <random>

#include "vantage/geometry/camera.h"

/// Cameras for tests only; not installed.

namespace vantage::testing {

/// The pose of a camera at `center_m` that looks at `target_m`, its picture upright.
inline CameraPose LookAt(const Eigen::Vector3d& center_m, const Eigen::Vector3d& target_m) {
  CameraPose pose;
  const Eigen::Vector3d forward = (target_m - center_m).normalized();
  Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ());
  right = right.norm() > 1e-9 ? right.normalized() : Eigen::Vector3d::UnitX();
  pose.rotation.row(0) = right;
  pose.rotation.row(1) = forward.cross(right);
  pose.rotation.row(2) = forward;
  pose.translation_m = -pose.rotation * center_m;
  return pose;
}

/// Uniform random numbers from a fixed seed.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double Between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Eigen::Vector2d Point(double low, double high) {
    const double x = Between(low, high);
    return {x, Between(low, high)};
  }

 private:
  std::mt19937_64 engine_;
};

/// 2 to 15 m above the ground, looking at a point of it within 20 m.
inline CameraPose RandomPose(Random& random) {
  const Eigen::Vector2d foot = random.Point(-20, 20);
  const Eigen::Vector2d target = foot + random.Point(1, 20);
  return LookAt({foot.x(), foot.y(), random.Between(2, 15)}, {target.x(), target.y(), 0});
}

/// All eight distortion coefficients, as large as ordinary lenses have them.
inline PinholeModel RandomPinhole(Random& random) {
  PinholeModel lens{.fx_px = random.Between(500, 1500),
                    .fy_px = random.Between(500, 1500),
                    .cx_px = random.Between(300, 500),
                    .cy_px = random.Between(250, 330)};
  const double limits[] = {0.3, 0.1, 0.002, 0.002, 0.02, 0.1, 0.05, 0.02};
  for (std::size_t i = 0; i < 8; ++i) {
    lens.distortion[i] = random.Between(-limits[i], limits[i]);
  }
  return lens;
}

/// A lens like those of the PETS 2009 cameras, with distortion of either sign.
inline TsaiModel RandomTsai(Random& random) {
  return {.focal_mm = random.Between(3, 8),
          .kappa1_per_mm2 = random.Between(-0.02, 0.02),
          .dpx_mm = 5.1273271277e-03,
          .dpy_mm = 4.65e-03,
          .sx = random.Between(0.95, 1.1),
          .cx_px = random.Between(320, 440),
          .cy_px = random.Between(260, 320)};
}

}  // namespace vantage::testing
