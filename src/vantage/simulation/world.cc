// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/world.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vantage/simulation/hash.h"
#include "vantage/simulation/texture.h"

namespace vantage::simulation::internal {
namespace {

using Eigen::Vector3f;

/// How far from a surface others dim the ambient light: far ones bound the hall that it fills.
constexpr float kAmbientReach_m = 2.5F;

/// Two directions that span the plane perpendicular to `axis`.
std::pair<Vector3f, Vector3f> Perpendicular(const Vector3f& axis) {
  const Vector3f other = std::abs(axis.z()) < 0.9F ? Vector3f::UnitZ() : Vector3f::UnitX();
  const Vector3f u = axis.cross(other).normalized();
  return {u, axis.cross(u)};
}

/// Place in [0, 1) of sample 0 to 15 in a 4 x 4 stratified pattern shifted by `key`.
std::pair<float, float> Stratum(int sample, std::uint64_t key) {
  // Neighbouring samples take places far apart, so that every second one makes a fair pattern too.
  const int cell = (sample * 7) % 16;
  const float u = (static_cast<float>(cell % 4) + 0.5F) / 4 + UpperUnit(key);
  const float v = (static_cast<float>(cell / 4) + 0.5F) / 4 + LowerUnit(key);
  return {u - std::floor(u), v - std::floor(v)};
}

}  // namespace

Vector3f LampPoint(const Lamp& lamp, float u, float v) {
  return lamp.center_m + (2 * u - 1) * lamp.half_u_m + (2 * v - 1) * lamp.half_v_m;
}

Ray RayTowards(const Vector3f& point_m, const Vector3f& normal, const Vector3f& goal_m) {
  constexpr float kLift_m = 2e-3F;
  Ray ray;
  ray.origin_m = point_m + kLift_m * normal;
  const Vector3f way = goal_m - ray.origin_m;
  const float length = way.norm();
  ray.direction = length > 0 ? Vector3f(way / length) : normal;
  // Short of the goal: a fitting may be drawn where the lamp is.
  ray.far_m = std::max(0.0F, 0.995F * length - 0.05F);
  return ray;
}

Vector3f CosineDirection(const Vector3f& normal, float u, float v) {
  const auto [a, b] = Perpendicular(normal);
  const float radius = std::sqrt(u);
  const float angle = 2 * std::numbers::pi_v<float> * v;
  const float up = std::sqrt(std::max(0.0F, 1 - u));
  return radius * std::cos(angle) * a + radius * std::sin(angle) * b + up * normal;
}

Vector3f MirroredDirection(const Vector3f& direction, const Vector3f& normal, float roughness_rad,
                           float u, float v) {
  const Vector3f mirrored = direction - 2 * direction.dot(normal) * normal;
  if (roughness_rad <= 0) return mirrored;
  const auto [a, b] = Perpendicular(mirrored);
  const float radius = std::tan(roughness_rad) * std::sqrt(u);
  const float angle = 2 * std::numbers::pi_v<float> * v;
  Vector3f turned = mirrored + radius * (std::cos(angle) * a + std::sin(angle) * b);
  const float into = turned.dot(normal);
  if (into < 0.01F) turned += (0.01F - into) * normal;
  return turned.normalized();
}

float AmbientShare(const Vector3f& normal) {
  constexpr float kFromBelow = 0.3F;  // what the ground gives back
  return kFromBelow + (1 - kFromBelow) * (0.5F + 0.5F * normal.z());
}

std::optional<LampSeen> SeeLamp(const Lighting& lighting, const Ray& ray, float t_m) {
  constexpr float kBrightest = 6;  // what a sensor can still tell from white
  std::optional<LampSeen> seen;
  for (std::size_t i = 0; i < lighting.lamps.size(); ++i) {
    const Lamp& lamp = lighting.lamps[i];
    const Vector3f normal = lamp.half_u_m.cross(lamp.half_v_m);
    const float along = ray.direction.dot(normal);
    if (std::abs(along) < 1e-12F) continue;
    const float t = (lamp.center_m - ray.origin_m).dot(normal) / along;
    if (!(t > 0 && t < t_m)) continue;
    const Vector3f from_center = ray.origin_m + t * ray.direction - lamp.center_m;
    const float u = from_center.dot(lamp.half_u_m) / lamp.half_u_m.squaredNorm();
    const float v = from_center.dot(lamp.half_v_m) / lamp.half_v_m.squaredNorm();
    if (std::abs(u) > 1 || std::abs(v) > 1) continue;
    // The irradiance that Lamp promises on the ground below it, spread over its solid angle.
    const float area = 4 * normal.norm();
    const float height = lamp.center_m.z();
    seen = {static_cast<int>(i), std::min(kBrightest, height * height / area)};
    t_m = t;
  }
  return seen;
}

Result<FixedWorld> FixedWorld::Create(RTCDevice device, const Stage& stage) {
  FixedWorld world;
  world.stage_ = &stage;
  VANTAGE_ASSIGN_OR_RETURN(world.solid_, Solid::Build(device, stage.limbs, stage.blocks));
  return world;
}

const Vector3f& FixedWorld::GroupColor(int group) const {
  return group == 0 ? lighting().ambient
                    : lighting().lamps[static_cast<std::size_t>(group - 1)].color;
}

SurfacePoint FixedWorld::SurfaceAt(const Hit& hit, const Vector3f& point_m) const {
  const std::size_t index = hit.part - 1;
  const bool limb = index < stage_->limbs.size();
  const MaterialIndex chosen =
      limb ? stage_->limbs[index].material : stage_->blocks[index - stage_->limbs.size()].material;
  const Eigen::Vector2f place =
      limb ? PlaceOnLimb(stage_->limbs[index], point_m) : PlaceOnPlane(point_m, hit.normal);
  return {chosen, TextureColor(material(chosen), place)};
}

GroupShares FixedWorld::LightAt(const Vector3f& point_m, const Vector3f& normal, std::uint64_t key,
                                int sample) const {
  GroupShares shares = {};
  const auto [u, v] = Stratum(sample, key);
  Ray open{point_m + 2e-3F * normal, CosineDirection(normal, u, v), kAmbientReach_m};
  if (!solid_.Blocks(open)) shares[0] = AmbientShare(normal);
  for (std::size_t i = 0; i < lighting().lamps.size(); ++i) {
    const Ray ray = RayTowards(point_m, normal, LampPoint(lighting().lamps[i], u, v));
    const float cosine = ray.direction.dot(normal);
    if (cosine > 0 && !solid_.Blocks(ray)) shares[1 + i] = cosine;
  }
  return shares;
}

}  // namespace vantage::simulation::internal
