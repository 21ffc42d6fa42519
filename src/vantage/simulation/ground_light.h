// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "vantage/simulation/moving.h"
#include "vantage/simulation/world.h"

/// Internal to the simulation module: shadows of moving things on the ground. They are the same
/// for every camera, so they are traced on a map of the ground, only around the things.

namespace vantage::simulation::internal {

class GroundLight {
 public:
  /// `seen`: the part of the ground that the cameras see; at most 300 m a side of it have shadows.
  GroundLight(const FixedWorld& world, const Eigen::AlignedBox2f& seen);

  /// Traces the shadows of a frame; tiles of the map that the same things shade are kept.
  void Update(const FixedWorld& world, const Moving& moving, int threads);

  /// Tile of the map that tells the light at a point of the ground; none outside the map.
  std::optional<std::uint32_t> TileAt(const Eigen::Vector2f& ground_m) const;
  /// Equal keys: equal light. 0: no moving thing takes any.
  std::uint64_t Key(std::uint32_t tile) const { return tiles_[tile].key; }
  /// Share of each group's light that moving things let through.
  GroupShares At(const Eigen::Vector2f& ground_m) const;

 private:
  struct Patch;
  struct Tile {
    std::uint64_t key = 0;
    std::vector<float> shares;  // by group, row and column of kCorners; empty: 1
  };
  void Trace(const FixedWorld& world, const Moving& moving, std::uint32_t tile,
             const std::vector<Patch>& patches, const std::vector<std::uint32_t>& here);
  Eigen::Vector2f PointOf(int column, int row) const;

  Eigen::Vector2f min_m_ = {0, 0};
  int columns_ = 0;  // of tiles
  int rows_ = 0;
  int groups_ = 1;
  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> shaded_;  // tiles with a key
};

}  // namespace vantage::simulation::internal
