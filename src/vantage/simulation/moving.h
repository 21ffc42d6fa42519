// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/simulation/solid.h"
#include "vantage/simulation/stage.h"
#include "vantage/simulation/world.h"

/// Internal to the simulation module: everything that moves, ready for the rays of one frame.

namespace vantage::simulation::internal {

/// Whether the thing's pixels are foreground in the true masks.
inline bool IsForeground(const Thing& thing) {
  return thing.kind == Thing::Kind::kPerson ||
         (thing.kind == Thing::Kind::kObject && thing.foreground);
}

/// One thing with what depends on it alone: kept while it keeps still.
struct PreparedThing {
  Thing thing;
  std::uint64_t key = 0;  ///< of its geometry; equal keys look alike wherever the light is alike
  Solid solid;
  Eigen::AlignedBox3f bounds;
  /// Share of each lamp that the fixed world lets through to each part (limbs, then blocks).
  std::vector<GroupShares> open;
};

class Moving {
 public:
  /// Prepares the things of a frame, in ascending order of id, taking over what is alike in
  /// `last`.
  static Result<Moving> Prepare(RTCDevice device, const FixedWorld& world,
                                std::vector<Thing> things, const Moving& last);

  std::size_t size() const { return things_.size(); }
  const PreparedThing& operator[](std::size_t i) const { return *things_[i]; }
  /// Of the thing's geometry and of all things near enough to dim it.
  std::uint64_t LitKey(std::size_t i) const { return lit_keys_[i]; }
  /// All things as one obstacle.
  RTCScene together() const { return together_.get(); }

  /// Share of each group's light that other things, and the thing itself, let through to a point
  /// of it, times the cosine; the pattern of rays is shifted by `key`.
  GroupShares LightAt(const FixedWorld& world, std::size_t i, const Hit& hit,
                      const Eigen::Vector3f& point_m, std::uint64_t key) const;
  /// The same without shadows of things.
  GroupShares OpenLightAt(const FixedWorld& world, std::size_t i, const Hit& hit) const;
  /// Radiance of a point of the thing towards the eye in this light.
  Eigen::Vector3f Radiance(const FixedWorld& world, std::size_t i, const Hit& hit,
                           const Eigen::Vector3f& point_m, const Eigen::Vector3f& direction,
                           const GroupShares& light, const GroupShares& gains) const;

 private:
  std::vector<std::shared_ptr<const PreparedThing>> things_;
  std::vector<std::uint64_t> lit_keys_;
  Scene together_;
};

}  // namespace vantage::simulation::internal
