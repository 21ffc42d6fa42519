// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <variant>

#include "vantage/base/result.h"

/// Frames and units. World: right-handed, metres, z up, the ground is z = 0. Camera: metres, x
/// right, y down, z forward. Image: pixels, (0, 0) is the centre of the top-left pixel.

namespace vantage {

struct ImageSize {
  int width = 0;
  int height = 0;
  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

/// OpenCV's pinhole camera: focal lengths and principal point in pixels; distortion
/// k1 k2 p1 p2 k3 k4 k5 k6 as in cv::projectPoints (absent ones are 0).
struct PinholeModel {
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;
  double cy_px = 0;
  std::array<double, 8> distortion = {};
};

/// Tsai's camera (R. Tsai, 1987) as in the PETS 2009 files: undistorted sensor coordinates
/// X_u = X_d (1 + kappa1 r_d^2), image x = sx X_d / dpx + cx, y = Y_d / dpy + cy.
struct TsaiModel {
  double focal_mm = 0;
  double kappa1_per_mm2 = 0;
  double dpx_mm = 0;
  double dpy_mm = 0;
  double sx = 1;
  double cx_px = 0;
  double cy_px = 0;
};

using LensModel = std::variant<PinholeModel, TsaiModel>;

/// Where a camera stands: p_camera = rotation p_world + translation_m.
struct CameraPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
};

/// One calibrated camera. Immutable; safe to share between threads.
class Camera {
 public:
  /// Fails when a number is not finite, a focal length or pixel size is not positive, the size is
  /// not 1 to 32768 pixels a side, the rotation is not orthonormal to 1e-3 (it is then replaced by
  /// the exact rotation nearest to it), or the translation is longer than 10 km.
  static Result<Camera> Create(ImageSize size, const LensModel& lens, const CameraPose& pose);

  /// Pixel of a point of the world, inside the picture or not. None when the point is not at least
  /// 1 mm in front of the camera, or outside the cone where the lens model is one-to-one (a
  /// polynomial distortion folds points from far outside back into the picture).
  std::optional<Eigen::Vector2d> ImageFromWorld(const Eigen::Vector3d& world_m) const;

  /// Point at height z_m that this pixel shows. None when the ray does not meet that plane in front
  /// of the camera (at or above the horizon) or when the lens model has no inverse there.
  std::optional<Eigen::Vector3d> WorldFromImage(const Eigen::Vector2d& image_px,
                                                double z_m = 0) const;

  /// Unit direction, in the world frame, of the ray that this pixel shows: it starts at center_m().
  /// None when the lens model has no inverse there.
  std::optional<Eigen::Vector3d> RayFromImage(const Eigen::Vector2d& image_px) const;

  /// The same camera delivering pictures of another size (the whole picture scaled).
  Result<Camera> Scaled(ImageSize size) const;

  ImageSize size() const { return size_; }
  /// As given to Create, also when Scaled since.
  const LensModel& lens() const { return lens_; }
  /// In pixels of size(): Create with these, size() and pose() makes the same camera.
  LensModel ScaledLens() const;
  const CameraPose& pose() const { return pose_; }
  Eigen::Vector3d center_m() const;
  bool InPicture(const Eigen::Vector2d& image_px) const {
    return image_px.x() >= -0.5 && image_px.y() >= -0.5 && image_px.x() < size_.width - 0.5 &&
           image_px.y() < size_.height - 0.5;
  }

 private:
  Camera() = default;
  /// As RayFromImage, of length 1 along the optical axis.
  std::optional<Eigen::Vector3d> RayAtUnitDepth(const Eigen::Vector2d& image_px) const;

  ImageSize size_;
  LensModel lens_;
  CameraPose pose_;
  Eigen::Vector2d scale_ = {1, 1};  // pixels of size_ per pixel of the lens model
  double max_radius_ = 0;           // undistorted radius (at z = 1) within which it is one-to-one
};

}  // namespace vantage
