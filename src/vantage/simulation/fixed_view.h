// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "vantage/simulation/lens.h"
#include "vantage/simulation/world.h"

/// Internal to the simulation module: a camera's picture of what never moves, by light group.

namespace vantage::simulation::internal {

/// What the ray through a pixel's centre meets in the fixed world.
struct FixedPoint {
  float t_m = 0;         ///< infinite: nothing; 0 where the pixel has no ray
  float mirror_t_m = 0;  ///< way of the mirrored ray to what it meets; 0 where nothing is mirrored
  float mirror_share = 0;  ///< of the light that comes by the mirror
  bool ground = false;     ///< upward, near z = 0
};

class FixedView {
 public:
  FixedView(const FixedWorld& world, const PixelRays& rays, int threads);

  const FixedPoint& At(std::size_t pixel) const { return points_[pixel]; }
  /// The centre sample's mirrored ray at a glossy place of the ground.
  Ray MirroredRay(const FixedWorld& world, const PixelRays& rays, int x, int y) const;
  /// Largest spread of the ground's reflection that this camera sees; negative: none is glossy.
  float ground_roughness_rad() const { return ground_roughness_rad_; }

  /// Radiance with each group's light weighed, and what of it comes by mirrors.
  Eigen::Vector3f Diffuse(std::size_t pixel, const GroupShares& weights) const {
    return Sum(diffuse_, pixel, weights);
  }
  Eigen::Vector3f Mirrored(std::size_t pixel, const GroupShares& weights) const {
    return mirrored_.empty() ? Eigen::Vector3f(0, 0, 0) : Sum(mirrored_, pixel, weights);
  }

 private:
  struct PixelSums;
  void TracePixel(const FixedWorld& world, const PixelRays& rays, int x, int y, PixelSums& sums);
  Eigen::Vector3f Sum(const std::vector<std::uint16_t>& layers, std::size_t pixel,
                      const GroupShares& weights) const;

  int groups_ = 0;
  float ground_roughness_rad_ = -1;
  std::vector<FixedPoint> points_;
  std::vector<MaterialIndex> ground_material_;
  // Radiances by pixel, group and channel, as square roots in 16 bits: 1e-4 of error in the dark
  // as in the light, at half of the memory.
  std::vector<std::uint16_t> diffuse_;
  std::vector<std::uint16_t> mirrored_;
};

}  // namespace vantage::simulation::internal
