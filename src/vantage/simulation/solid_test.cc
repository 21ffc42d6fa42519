// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/solid.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "vantage/geometry/test_cameras.h"

namespace vantage::simulation::internal {
namespace {

using Eigen::Vector3f;
using testing::Random;

Vector3f RandomPoint(Random& random, double reach) {
  const auto x = static_cast<float>(random.Between(-reach, reach));
  const auto y = static_cast<float>(random.Between(-reach, reach));
  return {x, y, static_cast<float>(random.Between(-reach, reach))};
}

/// Signed distance to the hull of two spheres, by the sphere that comes nearest (slow).
float DistanceTo(const Limb& limb, const Vector3f& point) {
  float nearest = std::numeric_limits<float>::infinity();
  for (int i = 0; i <= 2000; ++i) {
    const float share = static_cast<float>(i) / 2000;
    const Vector3f center = limb.a_m + share * (limb.b_m - limb.a_m);
    const float radius = limb.a_radius_m + share * (limb.b_radius_m - limb.a_radius_m);
    nearest = std::min(nearest, (point - center).norm() - radius);
  }
  return nearest;
}

class SolidTest : public ::testing::Test {
 protected:
  Device device_ = MakeDevice(1).value();
};

TEST_F(SolidTest, HitsLieOnLimbs) {
  Random random(3);
  int hits = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<Limb> limbs(3);
    for (Limb& limb : limbs) {
      limb = {RandomPoint(random, 1), RandomPoint(random, 1),
              static_cast<float>(random.Between(0.05, 0.3)),
              static_cast<float>(random.Between(0.05, 0.3)), 0};
    }
    limbs[1].b_m = limbs[1].a_m;  // a sphere
    const Solid solid = Solid::Build(device_.get(), limbs, {}).value();
    for (int shot = 0; shot < 50; ++shot) {
      const Vector3f origin = RandomPoint(random, 1).normalized() * 4;
      const Ray ray{origin, (RandomPoint(random, 0.7) - origin).normalized()};
      const Hit hit = solid.Trace(ray);
      EXPECT_EQ(hit.Exists(), solid.Blocks(ray));
      if (!hit.Exists()) continue;
      ++hits;
      const Vector3f point = ray.origin_m + hit.t_m * ray.direction;
      ASSERT_LE(hit.part, 3U);
      EXPECT_NEAR(DistanceTo(limbs[hit.part - 1], point), 0, 1e-3);
      for (const Limb& limb : limbs) EXPECT_GT(DistanceTo(limb, point), -1e-3);
      EXPECT_NEAR(hit.normal.norm(), 1, 1e-4);
      EXPECT_LE(hit.normal.dot(ray.direction), 0);
      EXPECT_GT(DistanceTo(limbs[hit.part - 1], point + 0.01F * hit.normal), 0.008F);
    }
  }
  EXPECT_GT(hits, 200);
}

TEST_F(SolidTest, TurnedBlocksAreHitFromAllSides) {
  const Block block{{1, 2, 3}, {0.5F, 0.25F, 1}, 0.6F, 0};
  const Solid solid = Solid::Build(device_.get(), {}, std::vector{block}).value();
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(0.6F, Vector3f::UnitZ()).toRotationMatrix();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) {
      const Vector3f outward = sign * turn.col(axis);
      const Hit hit =
          solid.Trace({block.center_m + 5 * outward + Vector3f(0.01F, 0.02F, 0.03F), -outward});
      ASSERT_TRUE(hit.Exists());
      EXPECT_EQ(hit.part, 1U);
      EXPECT_NEAR(hit.t_m, 5 - block.half_m[axis], 0.05);
      EXPECT_LT((hit.normal - outward).norm(), 1e-4);
    }
  }
}

TEST_F(SolidTest, SheetsAreHitFromBothSides) {
  const Solid solid =
      Solid::Build(device_.get(), {}, std::vector<Block>{{{0, 0, 1}, {1, 1, 0}, 0, 0}}).value();
  for (const float z : {0.0F, 3.0F}) {
    const Hit hit = solid.Trace({{0.3F, 0.2F, z}, {0, 0, z < 1 ? 1.0F : -1.0F}});
    ASSERT_TRUE(hit.Exists());
    EXPECT_NEAR(hit.t_m, std::abs(z - 1), 1e-6);
    EXPECT_NEAR(hit.normal.z(), z < 1 ? -1 : 1, 1e-6);
  }
}

TEST_F(SolidTest, AnEndWithinTheOtherIsTheOtherAlone) {
  const Solid solid =
      Solid::Build(device_.get(), std::vector<Limb>{{{0, 0, 0}, {0, 0, 0.1F}, 0.5F, 0.1F, 0}}, {})
          .value();
  EXPECT_NEAR(solid.Trace({{0, 0, 3}, {0, 0, -1}}).t_m, 2.5, 1e-4);
  EXPECT_NEAR(solid.Trace({{3, 0, 0}, {-1, 0, 0}}).t_m, 2.5, 1e-4);
}

TEST_F(SolidTest, JoinedSolidsBlockAsEachDoes) {
  const Solid a =
      Solid::Build(device_.get(), std::vector<Limb>{{{0, 0, 1}, {0, 0, 2}, 0.1F, 0.1F, 0}}, {})
          .value();
  const Solid b =
      Solid::Build(device_.get(), {}, std::vector<Block>{{{2, 0, 1}, {0.2F, 0.2F, 0.2F}, 0, 0}})
          .value();
  const std::array<const Solid*, 2> both = {&a, &b};
  const Scene joined = JoinSolids(device_.get(), both).value();
  for (const float x : {0.0F, 1.0F, 2.0F}) {
    EXPECT_EQ(IsBlocked(joined.get(), {{x, -3, 1}, {0, 1, 0}}), x != 1);
    EXPECT_FALSE(IsBlocked(joined.get(), {{x, -3, 1}, {0, 1, 0}, 1.5F})) << "ends before";
  }
  // A fan of rays, all at once as one by one.
  std::vector<Ray> rays;
  for (int i = 0; i < 21; ++i) {
    rays.push_back({{0, -3, 1}, Vector3f(0.05F * static_cast<float>(i), 1, 0).normalized()});
    const std::uint32_t blocked = BlockedRays(joined.get(), rays);
    for (std::size_t ray = 0; ray < rays.size(); ++ray) {
      EXPECT_EQ((blocked >> ray & 1U) != 0, IsBlocked(joined.get(), rays[ray]));
    }
  }
  EXPECT_EQ(BlockedRays(joined.get(), {}), 0U);
}

}  // namespace
}  // namespace vantage::simulation::internal
