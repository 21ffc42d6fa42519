// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/simulation/stage.h"

/// Internal to the simulation module: Embree's scenes with owners, and rays against them. World
/// frame, metres, single precision.

namespace vantage::simulation::internal {

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct GeometryRelease {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceRelease>;
using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneRelease>;
using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, GeometryRelease>;

/// A device whose users run on so many threads.
Result<Device> MakeDevice(int threads);

/// Fails with Embree's own words when its last call on this thread went wrong.
Status CheckDevice(RTCDevice device);

struct Ray {
  Eigen::Vector3f origin_m;
  Eigen::Vector3f direction;  ///< unit length
  float far_m = std::numeric_limits<float>::infinity();
};

/// What a ray meets first.
struct Hit {
  float t_m = std::numeric_limits<float>::infinity();  ///< infinite: nothing
  /// 1 + index of the limb, or 1 + limbs + index of the block; 0: nothing.
  std::uint32_t part = 0;
  Eigen::Vector3f normal = {0, 0, 0};  ///< unit length, towards the ray's origin

  bool Exists() const { return part != 0; }
};

/// Limbs and blocks, ready for rays.
class Solid {
 public:
  static Result<Solid> Build(RTCDevice device, std::span<const Limb> limbs,
                             std::span<const Block> blocks);

  Hit Trace(const Ray& ray) const;
  bool Blocks(const Ray& ray) const;

  /// Everything of this solid, for a scene that holds several.
  std::span<const Geometry> geometries() const { return geometries_; }

 private:
  Scene scene_;
  std::vector<Geometry> geometries_;
  std::vector<std::vector<std::uint32_t>> part_of_primitive_;  // by geometry
};

/// All the solids as one obstacle.
Result<Scene> JoinSolids(RTCDevice device, std::span<const Solid* const> solids);

/// Whether something stands between the ray's origin and its end.
bool IsBlocked(RTCScene scene, const Ray& ray);

/// Bit i tells whether ray i of at most 32 is blocked: several at a time, which is faster.
std::uint32_t BlockedRays(RTCScene scene, std::span<const Ray> rays);

/// The corners of a block: index bits 0, 1, 2 tell the sides along its own x, y, z.
std::array<Eigen::Vector3f, 8> BlockCorners(const Block& block);

/// Around all of it.
Eigen::AlignedBox3f BoundsOf(std::span<const Limb> limbs, std::span<const Block> blocks);

}  // namespace vantage::simulation::internal
