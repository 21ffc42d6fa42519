// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/lens.h"

#include <gtest/gtest.h>

#include <vector>

#include "vantage/geometry/test_cameras.h"

namespace vantage::simulation::internal {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using testing::LookAt;
using testing::Random;

Camera SmallCamera(const Vector3d& center_m) {
  const PinholeModel lens{
      .fx_px = 60, .fy_px = 60, .cx_px = 39.5, .cy_px = 29.5, .distortion = {-0.15, 0.02}};
  return Camera::Create({80, 60}, lens, LookAt(center_m, {0, 0, 0.8})).value();
}

Limb RandomLimb(Random& random) {
  const auto point = [&] {
    const Eigen::Vector2f ground = random.Point(-2, 2).cast<float>();
    return Vector3f(ground.x(), ground.y(), static_cast<float>(random.Between(0.3, 2)));
  };
  const Vector3f a = point();
  const Vector3f b = point();
  return {a, b, static_cast<float>(random.Between(0.02, 0.3)),
          static_cast<float>(random.Between(0.02, 0.3)), 0};
}

TEST(PixelRays, PassBetweenThoseOfNeighbours) {
  const Camera camera = SmallCamera({1, -6, 4});
  const PixelRays rays(camera);
  for (const float dx : {-0.5F, 0.25F}) {
    for (const float dy : {-0.25F, 0.5F}) {
      for (const int x : {0, 17, 79}) {
        for (const int y : {0, 31, 59}) {
          const Vector3f exact = camera.RayFromImage({x + dx, y + dy}).value().cast<float>();
          EXPECT_LT((rays.Through(x, y, dx, dy).direction - exact).norm(), 3e-4)
              << x << " " << y << ": a fiftieth of a pixel";
        }
      }
    }
  }
}

/// Every pixel whose ray meets the solid is in its footprint.
TEST(Footprint, HoldsAllPixelsThatShowTheSolid) {
  const Device device = MakeDevice(1).value();
  Random random(5);
  int shown = 0;
  int tried = 0;
  for (int round = 0; round < 30; ++round) {
    const Camera camera = SmallCamera({random.Between(-3, 3), -5, random.Between(1, 6)});
    const PixelRays rays(camera);
    const std::vector<Limb> limbs = {RandomLimb(random), RandomLimb(random)};
    const std::vector<Block> blocks = {
        {RandomLimb(random).a_m, {0.2F, 0.4F, 0.1F}, static_cast<float>(random.Between(0, 3)), 0}};
    const Solid solid = Solid::Build(device.get(), limbs, blocks).value();
    for (const bool mirrored : {false, true}) {
      const Footprint footprint = FootprintOf(camera, limbs, blocks, mirrored, 0.05F);
      for (int y = 0; y < rays.height(); ++y) {
        for (int x = 0; x < rays.width(); ++x) {
          Ray ray = rays.Through(x, y);
          if (mirrored) {
            if (ray.direction.z() >= 0) continue;
            ray.origin_m -= ray.origin_m.z() / ray.direction.z() * ray.direction;
            ray.direction.z() *= -1;
            // Strayed to a random side.
            ray.direction += 0.03F * RandomLimb(random).a_m.normalized();
            ray.direction.normalize();
          }
          const bool inside =
              footprint.box.contains({x, y}) &&
              footprint.in[static_cast<std::size_t>((y - footprint.box.y) * footprint.box.width +
                                                    x - footprint.box.x)] != 0;
          tried += inside ? 1 : 0;
          if (!solid.Trace(ray).Exists()) continue;
          ++shown;
          EXPECT_TRUE(inside) << "round " << round << (mirrored ? " mirrored" : "") << ": " << x
                              << " " << y;
        }
      }
    }
  }
  EXPECT_GT(shown, 5000);
  EXPECT_LT(tried, 5 * shown) << "the footprint is not merely the whole picture";
}

TEST(Footprint, WhatIsBehindTheCameraHasNone) {
  const Camera camera = SmallCamera({0, -6, 4});
  EXPECT_TRUE(FootprintOf(camera, std::vector<Limb>{{{0, -9, 4}, {0, -9, 5}, 0.1F, 0.1F, 0}}, {})
                  .box.empty());
  EXPECT_TRUE(FootprintOf(camera, {}, std::vector<Block>{{{0, -9, 4}, {0.1F, 0.1F, 0.1F}, 0, 0}})
                  .box.empty());
}

}  // namespace
}  // namespace vantage::simulation::internal
