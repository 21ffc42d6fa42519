// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/texture.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace vantage::simulation::internal {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

Material Make(Material::Pattern pattern, float scale_m = 0.5F) {
  return {pattern, {0.8F, 0.6F, 0.4F}, {0.1F, 0.2F, 0.3F}, scale_m};
}

TEST(Texture, StaysBetweenReflectances) {
  for (const auto pattern :
       {Material::Pattern::kPlain, Material::Pattern::kSpeckle, Material::Pattern::kStripes,
        Material::Pattern::kChecks, Material::Pattern::kPlaid, Material::Pattern::kBricks,
        Material::Pattern::kPlanks, Material::Pattern::kLetters, Material::Pattern::kGrass}) {
    const Material material = Make(pattern);
    float least = 1;
    float most = 0;
    for (int i = 0; i < 5000; ++i) {
      const auto step = static_cast<float>(i);
      const Vector3f color =
          TextureColor(material, {std::sin(step) * step / 100, std::cos(3 * step) * 9});
      EXPECT_GE(color.minCoeff(), 0);
      EXPECT_LE(color.maxCoeff(), 1.2F);
      least = std::min(least, color.x());
      most = std::max(most, color.x());
    }
    if (pattern != Material::Pattern::kPlain) {
      EXPECT_GT(most - least, 0.25F) << static_cast<int>(pattern);
    }
  }
}

TEST(Texture, ChecksHaveTheirSide) {
  const Material material = Make(Material::Pattern::kChecks, 0.5F);
  EXPECT_EQ(TextureColor(material, {0.25F, 0.25F}), material.color);
  EXPECT_EQ(TextureColor(material, {0.75F, 0.25F}), material.second);
  EXPECT_EQ(TextureColor(material, {0.75F, 0.75F}), material.color);
  EXPECT_EQ(TextureColor(material, {-0.25F, 0.25F}), material.second);
}

TEST(Texture, SeedsMakeSurfacesDiffer) {
  Material material = Make(Material::Pattern::kGrass);
  const Vector3f one = TextureColor(material, {1.3F, 2.7F});
  EXPECT_EQ(one, TextureColor(material, {1.3F, 2.7F}));
  material.seed = 5;
  EXPECT_NE(one, TextureColor(material, {1.3F, 2.7F}));
}

TEST(Texture, PlacesOnWallsAreMetresAlongAndUp) {
  const Vector3f normal = Vector3f(1, 1, 0).normalized();
  const Vector3f level = Vector3f(-1, 1, 0).normalized();
  const Vector3f point(3, 4, 1);
  const Vector2f here = PlaceOnPlane(point, normal);
  const Vector2f there = PlaceOnPlane(point + 2 * level + Vector3f(0, 0, 0.5F), normal);
  EXPECT_NEAR(std::abs(there.x() - here.x()), 2, 1e-5);
  EXPECT_NEAR(there.y() - here.y(), 0.5, 1e-5);
  EXPECT_LT((PlaceOnPlane(point, -normal) - here).norm(), 1e-5) << "both faces alike";
  EXPECT_EQ(PlaceOnPlane(point, Vector3f::UnitZ()), Vector2f(3, 4));
}

/// The texture of a limb goes where the limb goes.
TEST(Texture, PlacesOnLimbsMoveWithThem) {
  const Limb limb{{0, 0, 1}, {0.1F, 0, 1.6F}, 0.1F, 0.1F, 0};
  const Vector3f shift(3, -2, 0.4F);
  const Limb moved{limb.a_m + shift, limb.b_m + shift, 0.1F, 0.1F, 0};
  const Vector3f point(0.05F, 0.1F, 1.3F);
  EXPECT_LT((PlaceOnLimb(limb, point) - PlaceOnLimb(moved, point + shift)).norm(), 1e-5);
  EXPECT_NEAR(PlaceOnLimb(limb, limb.b_m).x(), (limb.b_m - limb.a_m).norm(), 1e-6);
  // Half of the way around is pi times the radius.
  const Vector3f side = (limb.b_m - limb.a_m).cross(Vector3f::UnitX()).normalized();
  const float around = std::abs(PlaceOnLimb(limb, limb.a_m + 0.1F * side).y() -
                                PlaceOnLimb(limb, limb.a_m - 0.1F * side).y());
  EXPECT_NEAR(around, std::numbers::pi * 0.1, 1e-4);
}

TEST(MirroredShare, GrowsTowardsGrazingAngles) {
  EXPECT_EQ(MirroredShare(0, 0), 0);
  EXPECT_FLOAT_EQ(MirroredShare(0.05F, 1), 0.05F);
  EXPECT_FLOAT_EQ(MirroredShare(0.05F, 0), 1);
  EXPECT_GT(MirroredShare(0.05F, 0.2F), MirroredShare(0.05F, 0.5F));
}

}  // namespace
}  // namespace vantage::simulation::internal
