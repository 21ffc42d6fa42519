// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/geometry/camera.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMinDepth_m = 1e-3;
constexpr double kMaxTranslation_m = 10'000;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// --- Pinhole with OpenCV's rational and tangential distortion -----------------------------------

/// Radial factor f(r^2) = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6) and its
/// derivative by r^2. Not positive or not finite beyond a pole.
struct RadialFactor {
  double value;
  double derivative;
};
RadialFactor RadialFactorAt(const PinholeModel& m, double r2) {
  const auto& k = m.distortion;
  const double above = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double below = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
  const double above_slope = k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]);
  const double below_slope = k[5] + r2 * (2 * k[6] + r2 * 3 * k[7]);
  return {above / below, (above_slope * below - above * below_slope) / (below * below)};
}

/// With q = (p2, p1): u f + r^2 q + 2 (q . u) u.
Vector2d Distort(const PinholeModel& m, const Vector2d& u) {
  const double r2 = u.squaredNorm();
  const Vector2d q(m.distortion[3], m.distortion[2]);
  return u * RadialFactorAt(m, r2).value + r2 * q + 2 * q.dot(u) * u;
}

/// df/du = f I + 2 f' u u^T + 2 (q u^T + u q^T + (q . u) I).
Eigen::Matrix2d DistortJacobian(const PinholeModel& m, const Vector2d& u) {
  const Vector2d q(m.distortion[3], m.distortion[2]);
  const RadialFactor radial = RadialFactorAt(m, u.squaredNorm());
  return (radial.value + 2 * q.dot(u)) * Eigen::Matrix2d::Identity() +
         2 * (radial.derivative * u + q) * u.transpose() + 2 * u * q.transpose();
}

/// True when the Jacobian is sure to have a positive definite symmetric part at radius r: its
/// radial part has the eigenvalues f and f + 2 r^2 f', its tangential part a norm of at most 6 |q|
/// r. A map with this property all over a disc is one-to-one there.
bool Grows(const PinholeModel& m, double r) {
  const RadialFactor radial = RadialFactorAt(m, r * r);
  const double tangential = 6 * std::hypot(m.distortion[2], m.distortion[3]) * r;
  return std::isfinite(radial.value) && radial.value > tangential &&
         radial.value + 2 * r * r * radial.derivative > tangential;
}

/// Largest r within which the model is one-to-one: beyond it the picture folds back.
double MaxRadius(const PinholeModel& m) {
  if (m.distortion == std::array<double, 8>{}) return kInfinity;
  constexpr double kSearch = 20;  // tan(87 degrees): wider than any pinhole picture
  constexpr int kSteps = 4000;
  double inside = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    double r = kSearch * share * share;  // finest in the middle, where long lenses look
    if (Grows(m, r)) {
      inside = r;
      continue;
    }
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = (inside + r) / 2;
      (Grows(m, middle) ? inside : r) = middle;
    }
    return inside;
  }
  return kSearch;
}

std::optional<Vector2d> Pixel(const PinholeModel& m, const Vector2d& u) {
  const Vector2d d = Distort(m, u);
  return Vector2d(m.fx_px * d.x() + m.cx_px, m.fy_px * d.y() + m.cy_px);
}

/// Inverse of Distort by Newton's method, damped to descend and to stay in the cone.
std::optional<Vector2d> Direction(const PinholeModel& m, const Vector2d& pixel, double max_radius) {
  constexpr double kTolerance = 1e-12;
  const Vector2d target((pixel.x() - m.cx_px) / m.fx_px, (pixel.y() - m.cy_px) / m.fy_px);
  if (!target.allFinite()) return std::nullopt;
  Vector2d u = target;
  if (u.norm() > max_radius) u *= 0.9 * max_radius / u.norm();
  Vector2d error = Distort(m, u) - target;
  for (int iteration = 0; iteration < 100; ++iteration) {
    if (error.norm() <= kTolerance * (1 + target.norm())) return u;
    // The cone is a convex disc with a regular Jacobian all over: the inverse exists.
    const Vector2d step = DistortJacobian(m, u).inverse() * error;
    double damping = 1;
    Vector2d next = u - step;
    Vector2d next_error = Distort(m, next) - target;
    while (!(next.norm() <= max_radius && next_error.norm() < error.norm())) {
      damping /= 2;
      if (damping < 1e-6) return std::nullopt;  // the pixel lies beyond the border of the cone
      next = u - damping * step;
      next_error = Distort(m, next) - target;
    }
    u = next;
    error = next_error;
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
  return Vector2d(m.sx * distorted_mm.x() / m.dpx_mm + m.cx_px,
                  distorted_mm.y() / m.dpy_mm + m.cy_px);
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
  return Fail("calibration: {} is {}{}; it must be finite and above 0", field, value, unit);
}

Status CheckFinite(const char* field, double value) {
  if (std::isfinite(value)) return {};
  return Fail("calibration: {} is {}; it must be a finite number", field, value);
}

Status CheckLens(const PinholeModel& m) {
  VANTAGE_RETURN_IF_ERROR(CheckPositive("focal length fx", m.fx_px, " px"));
  VANTAGE_RETURN_IF_ERROR(CheckPositive("focal length fy", m.fy_px, " px"));
  VANTAGE_RETURN_IF_ERROR(CheckFinite("principal point cx", m.cx_px));
  VANTAGE_RETURN_IF_ERROR(CheckFinite("principal point cy", m.cy_px));
  constexpr std::array kNames = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    VANTAGE_RETURN_IF_ERROR(CheckFinite(kNames[i], m.distortion[i]));
  }
  return {};
}

Status CheckLens(const TsaiModel& m) {
  VANTAGE_RETURN_IF_ERROR(CheckPositive("focal", m.focal_mm, " mm"));
  VANTAGE_RETURN_IF_ERROR(CheckPositive("dpx", m.dpx_mm, " mm"));
  VANTAGE_RETURN_IF_ERROR(CheckPositive("dpy", m.dpy_mm, " mm"));
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

Status CheckPose(const CameraPose& pose) {
  if (!pose.rotation.allFinite()) return Fail("calibration: the rotation is not finite");
  const Eigen::Matrix3d gram = pose.rotation * pose.rotation.transpose();
  if (!((gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= 1e-3) ||
      pose.rotation.determinant() < 0) {
    return Fail("calibration: the rotation is not a proper orthonormal matrix (to 1e-3)");
  }
  if (!(pose.translation_m.norm() <= kMaxTranslation_m)) {
    return Fail(
        "calibration: the translation is ({}, {}, {}) m; it must be within 10 km (is it in "
        "millimetres?)",
        pose.translation_m.x(), pose.translation_m.y(), pose.translation_m.z());
  }
  return {};
}

/// Pixel coordinates under scaling of the whole picture; (0, 0) is a pixel's centre.
Vector2d Rescale(const Vector2d& pixel, const Vector2d& scale) {
  return (pixel.array() + 0.5) * scale.array() - 0.5;
}

}  // namespace

Result<Camera> Camera::Create(ImageSize size, const LensModel& lens, const CameraPose& pose) {
  VANTAGE_RETURN_IF_ERROR(CheckSize(size));
  VANTAGE_RETURN_IF_ERROR(std::visit([](const auto& m) { return CheckLens(m); }, lens));
  VANTAGE_RETURN_IF_ERROR(CheckPose(pose));
  Camera camera;
  camera.size_ = size;
  camera.lens_ = lens;
  // Back-projection takes the transpose for the inverse, so the matrix must be exactly a rotation,
  // whatever the digits it was written with.
  camera.pose_.rotation = Eigen::Affine3d(pose.rotation).rotation();  // polar decomposition
  camera.pose_.translation_m = pose.translation_m;
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

LensModel Camera::ScaledLens() const {
  LensModel scaled = lens_;
  std::visit(
      [&](auto& model) {
        const Vector2d center = Rescale({model.cx_px, model.cy_px}, scale_);
        model.cx_px = center.x();
        model.cy_px = center.y();
      },
      scaled);
  if (auto* pinhole = std::get_if<PinholeModel>(&scaled)) {
    pinhole->fx_px *= scale_.x();
    pinhole->fy_px *= scale_.y();
  } else if (auto* tsai = std::get_if<TsaiModel>(&scaled)) {
    tsai->dpx_mm /= scale_.x();
    tsai->dpy_mm /= scale_.y();
  }
  return scaled;
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

std::optional<Vector3d> Camera::RayAtUnitDepth(const Vector2d& image_px) const {
  const Vector2d pixel = Rescale(image_px, scale_.cwiseInverse());
  const auto u = std::visit([&](const auto& m) { return Direction(m, pixel, max_radius_); }, lens_);
  if (!u) return std::nullopt;
  return pose_.rotation.transpose() * Vector3d(u->x(), u->y(), 1);
}

std::optional<Vector3d> Camera::RayFromImage(const Vector2d& image_px) const {
  const auto ray = RayAtUnitDepth(image_px);
  if (!ray) return std::nullopt;
  return ray->normalized();
}

std::optional<Vector3d> Camera::WorldFromImage(const Vector2d& image_px, double z_m) const {
  const auto unit_depth_ray = RayAtUnitDepth(image_px);
  if (!unit_depth_ray) return std::nullopt;
  const Vector3d& ray = *unit_depth_ray;
  const Vector3d center = center_m();
  if (std::abs(ray.z()) < 1e-12) return std::nullopt;
  const double depth = (z_m - center.z()) / ray.z();
  if (!(depth >= kMinDepth_m) || !std::isfinite(depth)) return std::nullopt;
  Vector3d world = center + depth * ray;
  world.z() = z_m;
  return world;
}

}  // namespace vantage
