// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "vantage/base/result.h"
#include "vantage/simulation/solid.h"
#include "vantage/simulation/stage.h"

/// Internal to the simulation module: what never moves, and the light on it.

namespace vantage::simulation::internal {

/// The ambient light and at most four lamps.
inline constexpr int kMaxGroups = 5;
/// A number for each light group; those that a stage lacks stay 0.
using GroupShares = std::array<float, kMaxGroups>;

/// A place on a surface.
struct SurfacePoint {
  MaterialIndex material = 0;
  Eigen::Vector3f color;  ///< of the texture there
};

/// A point of a lamp: u, v in [0, 1).
Eigen::Vector3f LampPoint(const Lamp& lamp, float u, float v);

/// The ray from a surface to a point, lifted off the surface to not meet it again.
Ray RayTowards(const Eigen::Vector3f& point_m, const Eigen::Vector3f& normal,
               const Eigen::Vector3f& goal_m);

/// Direction about `normal`, distributed as the cosine to it.
Eigen::Vector3f CosineDirection(const Eigen::Vector3f& normal, float u, float v);

/// Mirrors a ray's direction at a surface and turns it by up to `roughness_rad`, never into it.
Eigen::Vector3f MirroredDirection(const Eigen::Vector3f& direction, const Eigen::Vector3f& normal,
                                  float roughness_rad, float u, float v);

/// Share of the ambient light that reaches an open surface with this normal: less from below.
float AmbientShare(const Eigen::Vector3f& normal);

/// The lamp whose emitting rectangle this ray meets before `t_m`, and its radiance as a multiple
/// of its colour.
struct LampSeen {
  int lamp = 0;
  float radiance = 0;
};
std::optional<LampSeen> SeeLamp(const Lighting& lighting, const Ray& ray, float t_m);

class FixedWorld {
 public:
  /// The stage must outlive the world.
  static Result<FixedWorld> Create(RTCDevice device, const Stage& stage);

  const Stage& stage() const { return *stage_; }
  const Solid& solid() const { return solid_; }
  const Lighting& lighting() const { return stage_->lighting; }
  int groups() const { return 1 + static_cast<int>(stage_->lighting.lamps.size()); }
  /// Colour of a group: ambient or lamp.
  const Eigen::Vector3f& GroupColor(int group) const;
  const Material& material(MaterialIndex index) const {
    return stage_->materials[static_cast<std::size_t>(index)];
  }

  SurfacePoint SurfaceAt(const Hit& hit, const Eigen::Vector3f& point_m) const;

  /// Light at a surface point by group: the cosine times the share of the lamp that is seen, by one
  /// shadow ray each. `sample` of 16 takes its stratum of the lamp; `key` shifts the pattern.
  GroupShares LightAt(const Eigen::Vector3f& point_m, const Eigen::Vector3f& normal,
                      std::uint64_t key, int sample) const;

 private:
  const Stage* stage_ = nullptr;
  Solid solid_;
};

}  // namespace vantage::simulation::internal
