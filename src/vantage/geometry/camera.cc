// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/geometry/camera.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace vantage {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMinDepth_m = 1e-3;
constexpr double kInfinity = std::numeric_limits<double>::infinity();


// --- Pinhole with OpenCV's rational and tangential distortion -----------------------------------

/// Radial factor (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6).
double RadialFactor(const PinholeModel& m, double r2) {
  const auto& k = m.distortion;
  return (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
}

/// Largest r at which r * RadialFactor(r) still grows: beyond it the model folds back.
double MaxRadius(const PinholeModel& m) {
  constexpr double kSearch = 20;  // tan(87 degrees): wider than any pinhole picture
  constexpr int kSteps = 4000;
  double previous = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double r = kSearch * i / kSteps;
    const double distorted = r * RadialFactor(m, r * r);
    if (!(distorted > previous)) return kSearch * (i - 1) / kSteps;
    previous = distorted;
  }
  return kInfinity;
}

Vector2d Distort(const PinholeModel& m, const Vector2d& u) {
  const double r2 = u.squaredNorm();
  const double radial = RadialFactor(m, r2);
  const double p1 = m.distortion[2];
  const double p2 = m.distortion[3];
  return {u.x() * radial + 2 * p1 * u.x() * u.y() + p2 * (r2 + 2 * u.x() * u.x()),
          u.y() * radial + p1 * (r2 + 2 * u.y() * u.y()) + 2 * p2 * u.x() * u.y()};
}

std::optional<Vector2d> Pixel(const PinholeModel& m, const Vector2d& u) {
  const Vector2d d = Distort(m, u);
  return Vector2d(m.fx_px * d.x() + m.cx_px, m.fy_px * d.y() + m.cy_px);
}

/// Inverse of Distort by Newton's method with a numerical Jacobian, damped to stay in the cone.
std::optional<Vector2d> Direction(const PinholeModel& m, const Vector2d& pixel, double max_radius) {
  const Vector2d target((pixel.x() - m.cx_px) / m.fx_px, (pixel.y() - m.cy_px) / m.fy_px);
  constexpr double kStep = 1e-6;
  constexpr double kTolerance = 1e-11;
  Vector2d u = target;
  if (u.norm() > max_radius) u *= max_radius / u.norm() * 0.9;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Vector2d error = Distort(m, u) - target;
    if (!error.allFinite()) return std::nullopt;
    if (error.norm() < kTolerance) {
      return u.norm() <= max_radius ? std::optional(u) : std::nullopt;
    }
    Eigen::Matrix2d jacobian;
    for (int axis = 0; axis < 2; ++axis) {
      const Vector2d h = kStep * Vector2d::Unit(axis);
      jacobian.col(axis) = (Distort(m, u + h) - Distort(m, u - h)) / (2 * kStep);
    }
    const double determinant = jacobian.determinant();
    if (std::abs(determinant) < 1e-12) return std::nullopt;
    Vector2d step;
    step.x() = (jacobian(1, 1) * error.x() - jacobian(0, 1) * error.y()) / determinant;
    step.y() = (jacobian(0, 0) * error.y() - jacobian(1, 0) * error.x()) / determinant;
    double damping = 1;
    while (damping > 1e-3 && ((u - damping * step).norm() > max_radius ||
                              (Distort(m, u - damping * step) - target).norm() > error.norm())) {
      damping /= 2;
    }
    u -= damping * step;
  }
  return std::nullopt;
}

// --- Tsai ----------------------------------------------------------------------------------------

/// Distorted radius r_d with r_d (1 + kappa1 r_d^2) = r_u: the root that continues the identity.
/// None when a negative kappa1 leaves no such root.
std::optional<double> DistortedRadius(double kappa1, double r_u) {
  if (kappa1 == 0 || r_u == 0) return r_u;
  if (kappa1 < 0 && r_u > 2.0 / 3 * std::sqrt(-1 / (3 * kappa1))) return std::nullopt;
  double r_d = r_u;
  if (kappa1 > 0) r_d = std::min(r_u, std::cbrt(r_u / kappa1));
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double step = (r_d * (1 + kappa1 * r_d * r_d) - r_u) / (1 + 3 * kappa1 * r_d * r_d);
    r_d -= step;
    if (std::abs(step) < 1e-14 * (1 + r_d)) break;
  }
  return r_d;
}

double MaxRadius(const TsaiModel& m) {
  if (m.kappa1_per_mm2 >= 0) return kInfinity;
  return 2.0 / 3 * std::sqrt(-1 / (3 * m.kappa1_per_mm2)) / m.focal_mm;
}

std::optional<Vector2d> Pixel(const TsaiModel& m, const Vector2d& u) {
  const Vector2d undistorted_mm = m.focal_mm * u;
  const double r_u = undistorted_mm.norm();
  const auto r_d = DistortedRadius(m.kappa1_per_mm2, r_u);
  if (!r_d) return std::nullopt;
  const Vector2d distorted_mm = r_u > 0 ? Vector2d(undistorted_mm * (*r_d / r_u)) : undistorted_mm;
  return Vector2d(m.sx * distorted_mm.x() / m.dpx_mm + m.cx_px, distorted_mm.y() / m.dpy_mm + m.cy_px);
}

std::optional<Vector2d> Direction(const TsaiModel& m, const Vector2d& pixel, double max_radius) {
  const Vector2d distorted_mm((pixel.x() - m.cx_px) * m.dpx_mm / m.sx,
                              (pixel.y() - m.cy_px) * m.dpy_mm);
  const double r2 = distorted_mm.squaredNorm();
  if (m.kappa1_per_mm2 < 0 && r2 > -1 / (3 * m.kappa1_per_mm2)) return std::nullopt;
  const Vector2d u = distorted_mm * (1 + m.kappa1_per_mm2 * r2) / m.focal_mm;
  return u.norm() <= max_radius ? std::optional(u) : std::nullopt;
}

// --- Checks --------------------------------------------------------------------------------------

Status CheckPositive(const char* field, double value, const char* unit) {
  if (std::isfinite(value) && value > 0) return {};
  return Fail("calibration: {} is {} {}; it must be finite and above 0", field, value, unit);
}

Status CheckFinite(const char* field, double value) {
  if (std::isfinite(value)) return {};
  return Fail("calibration: {} is {}; it must be a finite number", field, value);
}

Status CheckLens(const PinholeModel& m) {
  VANTAGE_RETURN_IF_ERROR(CheckPositive("focal length fx", m.fx_px, "px"));
  VANTAGE_RETURN_IF_ERROR(CheckPositive("focal length fy", m.fy_px, "px"));
  VANTAGE_RETURN_IF_ERROR(CheckFinite("principal point cx", m.cx_px));
  VANTAGE_RETURN_IF_ERROR(CheckFinite("principal point cy", m.cy_px));
  for (const double k : m.distortion) VANTAGE_RETURN_IF_ERROR(CheckFinite("distortion", k));
  return {};
}

Status CheckLens(const TsaiModel& m) {
  VANTAGE_RETURN_IF_ERROR(CheckPositive("focal", m.focal_mm, "mm"));
  VANTAGE_RETURN_IF_ERROR(CheckPositive("dpx", m.dpx_mm, "mm"));
  VANTAGE_RETURN_IF_ERROR(CheckPositive("dpy", m.dpy_mm, "mm"));
  VANTAGE_RETURN_IF_ERROR(CheckPositive("sx", m.sx, ""));
  VANTAGE_RETURN_IF_ERROR(CheckFinite("kappa1", m.kappa1_per_mm2));
  VANTAGE_RETURN_IF_ERROR(CheckFinite("cx", m.cx_px));
  VANTAGE_RETURN_IF_ERROR(CheckFinite("cy", m.cy_px));
  return {};
}

Status CheckSize(ImageSize size) {
  constexpr int kMaxSide = 32768;
  if (size.width >= 1 && size.height >= 1 && size.width <= kMaxSide && size.height <= kMaxSide) {
    return {};
  }
  return Fail("calibration: the picture is {} x {} px; each side must be 1 to {}", size.width,
              size.height, kMaxSide);
}

/// Pixel coordinates under scaling of the whole picture; (0, 0) is a pixel's centre.
Vector2d Rescale(const Vector2d& pixel, const Vector2d& scale) {
  return (pixel.array() + 0.5) * scale.array() - 0.5;
}

}  // namespace

Result<Camera> Camera::Create(ImageSize size, const LensModel& lens, const CameraPose& pose) {
  VANTAGE_RETURN_IF_ERROR(CheckSize(size));
  VANTAGE_RETURN_IF_ERROR(std::visit([](const auto& m) { return CheckLens(m); }, lens));
  if (!pose.rotation.allFinite() || !pose.translation_m.allFinite()) {
    return Fail("calibration: the camera's rotation or translation is not finite");
  }
  const Eigen::Matrix3d gram = pose.rotation * pose.rotation.transpose();
  if ((gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-3 ||
      pose.rotation.determinant() < 0) {
    return Fail("calibration: the rotation is not a proper orthonormal matrix (to 1e-3)");
  }
  Camera camera;
  camera.size_ = size;
  camera.lens_ = lens;
  camera.pose_ = pose;
  camera.max_radius_ = std::visit([](const auto& m) { return MaxRadius(m); }, lens);
  return camera;
}

Result<Camera> Camera::Scaled(ImageSize size) const {
  VANTAGE_RETURN_IF_ERROR(CheckSize(size));
  Camera camera = *this;
  camera.scale_.x() *= static_cast<double>(size.width) / size_.width;
  camera.scale_.y() *= static_cast<double>(size.height) / size_.height;
  camera.size_ = size;
  return camera;
}

Vector3d Camera::center_m() const { return -pose_.rotation.transpose() * pose_.translation_m; }

std::optional<Vector2d> Camera::ImageFromWorld(const Vector3d& world_m) const {
  const Vector3d camera_m = pose_.rotation * world_m + pose_.translation_m;
  if (!(camera_m.z() >= kMinDepth_m)) return std::nullopt;
  const Vector2d u = camera_m.head<2>() / camera_m.z();
  if (u.norm() > max_radius_) return std::nullopt;
  const auto pixel = std::visit([&](const auto& m) { return Pixel(m, u); }, lens_);
  if (!pixel || !pixel->allFinite()) return std::nullopt;
  return Rescale(*pixel, scale_);
}

std::optional<Vector3d> Camera::WorldFromImage(const Vector2d& image_px, double z_m) const {
  const Vector2d pixel = Rescale(image_px, scale_.cwiseInverse());
  const auto u = std::visit([&](const auto& m) { return Direction(m, pixel, max_radius_); }, lens_);
  if (!u) return std::nullopt;
  const Vector3d ray = pose_.rotation.transpose() * Vector3d(u->x(), u->y(), 1);
  const Vector3d center = center_m();
  if (std::abs(ray.z()) < 1e-12) return std::nullopt;
  const double depth = (z_m - center.z()) / ray.z();
  if (!(depth >= kMinDepth_m) || !std::isfinite(depth)) return std::nullopt;
  Vector3d world = center + depth * ray;
  world.z() = z_m;
  return world;
}

}  // namespace vantage
