// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/sight.h"

namespace vantage::simulation::internal {
namespace {

/// `ray_of` gives the ray of a pixel, or one without a direction where there is none.
template <class RayOf>
Sight TraceFootprint(const Footprint& footprint, const Solid& solid, const RayOf& ray_of) {
  Sight sight;
  sight.area = footprint.box;
  sight.hits.resize(footprint.in.size());
  std::size_t at = 0;
  for (int y = sight.area.y; y < sight.area.y + sight.area.height; ++y) {
    for (int x = sight.area.x; x < sight.area.x + sight.area.width; ++x, ++at) {
      if (footprint.in[at] == 0) continue;
      const Ray ray = ray_of(x, y);
      if (ray.direction == Eigen::Vector3f::Zero()) continue;
      const Hit hit = solid.Trace(ray);
      if (!hit.Exists()) continue;
      sight.hits[at] = hit;
      ++sight.pixels;
      const cv::Rect pixel(x, y, 1, 1);
      sight.box = sight.box.empty() ? pixel : sight.box | pixel;
    }
  }
  return sight;
}

}  // namespace

Sight SeeThing(const Camera& camera, const PixelRays& rays, const PreparedThing& thing) {
  return TraceFootprint(FootprintOf(camera, thing.thing.limbs, thing.thing.blocks), thing.solid,
                        [&](int x, int y) { return rays.Through(x, y); });
}

Sight SeeThingMirrored(const Camera& camera, const PixelRays& rays, const FixedWorld& world,
                       const FixedView& fixed, const PreparedThing& thing) {
  if (fixed.ground_roughness_rad() < 0) return {};
  return TraceFootprint(FootprintOf(camera, thing.thing.limbs, thing.thing.blocks, true,
                                    fixed.ground_roughness_rad()),
                        thing.solid, [&](int x, int y) {
                          const std::size_t pixel =
                              static_cast<std::size_t>(y) * static_cast<std::size_t>(rays.width()) +
                              static_cast<std::size_t>(x);
                          if (fixed.At(pixel).mirror_t_m <= 0)
                            return Ray{rays.center_m(), Eigen::Vector3f::Zero()};
                          return fixed.MirroredRay(world, rays, x, y);
                        });
}

}  // namespace vantage::simulation::internal
