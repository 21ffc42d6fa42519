// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <opencv2/core/types.hpp>
#include <vector>

#include "vantage/simulation/fixed_view.h"
#include "vantage/simulation/lens.h"
#include "vantage/simulation/moving.h"

/// Internal to the simulation module: one moving thing in one camera, alone.

namespace vantage::simulation::internal {

/// What rays of pixels meet of one thing when nothing else is there.
struct Sight {
  cv::Rect area;          ///< pixels that were tried
  std::vector<Hit> hits;  ///< of `area`, by rows
  cv::Rect box;           ///< around the pixels that met it
  std::int64_t pixels = 0;

  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y - area.y) * static_cast<std::size_t>(area.width) +
           static_cast<std::size_t>(x - area.x);
  }
  const Hit& At(int x, int y) const { return hits[Index(x, y)]; }
};

/// By the rays through pixels' centres.
Sight SeeThing(const Camera& camera, const PixelRays& rays, const PreparedThing& thing);

/// By their reflections at glossy ground.
Sight SeeThingMirrored(const Camera& camera, const PixelRays& rays, const FixedWorld& world,
                       const FixedView& fixed, const PreparedThing& thing);

}  // namespace vantage::simulation::internal
