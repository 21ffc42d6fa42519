// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/types.hpp>
#include <span>
#include <vector>

#include "vantage/geometry/camera.h"
#include "vantage/simulation/solid.h"
#include "vantage/simulation/stage.h"

/// Internal to the simulation module: from pixels to rays, and from solids to the pixels that may
/// show them.

namespace vantage::simulation::internal {

/// The rays of a camera's pixels, worked out once.
class PixelRays {
 public:
  explicit PixelRays(const Camera& camera);

  int width() const { return width_; }
  int height() const { return height_; }
  const Eigen::Vector3f& center_m() const { return center_m_; }
  /// False where the lens model has no inverse: such pixels stay black.
  bool Exists(int x, int y) const { return At(x, y) != Eigen::Vector3f::Zero(); }
  Ray Through(int x, int y) const { return {center_m_, At(x, y)}; }
  /// At an offset within the pixel, each in [-0.5, 0.5] (linear between pixels' centres).
  Ray Through(int x, int y, float dx, float dy) const;

 private:
  const Eigen::Vector3f& At(int x, int y) const {
    return directions_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(x)];
  }
  int width_;
  int height_;
  Eigen::Vector3f center_m_;
  std::vector<Eigen::Vector3f> directions_;
};

/// Pixels by rectangles: all that may show something.
struct Footprint {
  cv::Rect box;                  ///< around all of them; empty: none
  std::vector<std::uint8_t> in;  ///< not 0 for pixels of the box that belong to it, by rows
};

/// Pixels whose rays may meet these limbs and blocks; `mirrored`: whose rays may meet them after a
/// reflection at the ground z = 0 that turns them by up to `roughness_rad`.
Footprint FootprintOf(const Camera& camera, std::span<const Limb> limbs,
                      std::span<const Block> blocks, bool mirrored = false,
                      float roughness_rad = 0);

}  // namespace vantage::simulation::internal
