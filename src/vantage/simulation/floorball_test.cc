// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "vantage/simulation/presets.h"

namespace vantage::simulation {
namespace {

using testing::HasSubstr;

PresetOptions Short(FrameIndex frames = 200) {
  PresetOptions options;
  options.frames = frames;
  return options;
}

Stage Floorball(const PresetOptions& options = Short()) {
  Result<Stage> stage = MakeFloorball(options);
  EXPECT_TRUE(stage) << stage.error().message;
  return std::move(*stage);
}

void ExpectValid(const std::vector<Limb>& limbs, const std::vector<Block>& blocks,
                 std::size_t materials) {
  for (const Limb& limb : limbs) {
    EXPECT_TRUE(limb.a_m.allFinite() && limb.b_m.allFinite());
    EXPECT_GT(limb.a_radius_m, 0);
    EXPECT_GT(limb.b_radius_m, 0);
    EXPECT_GE(limb.material, 0);
    EXPECT_LT(static_cast<std::size_t>(limb.material), materials);
  }
  for (const Block& block : blocks) {
    EXPECT_TRUE(block.center_m.allFinite() && std::isfinite(block.yaw_rad));
    EXPECT_GE(block.half_m.minCoeff(), 0);
    EXPECT_GE(block.material, 0);
    EXPECT_LT(static_cast<std::size_t>(block.material), materials);
  }
}

TEST(Floorball, IsAsTheThesisDescribesIt) {
  const Stage stage = Floorball({});
  EXPECT_EQ(stage.frames, 1000);
  EXPECT_EQ(stage.frames_per_second, 20);
  EXPECT_NEAR(stage.area.area_m2(), 800, 1e-9);
  ASSERT_EQ(stage.cameras.size(), 8U);
  std::set<std::string> names;
  for (const StageCamera& camera : stage.cameras) {
    names.insert(camera.name);
    EXPECT_EQ(camera.camera.size(), (ImageSize{960, 768}));
    EXPECT_GE(camera.camera.center_m().z(), 6);
    EXPECT_LE(camera.camera.center_m().z(), 9);
    EXPECT_GT(stage.area.Distance(camera.camera.center_m().head<2>()), 0.5);
  }
  EXPECT_EQ(names.size(), 8U);
  EXPECT_TRUE(names.contains("camera1") && names.contains("camera8"));
}

TEST(Floorball, EveryPlaceInTheRinkIsSeenByThreeCamerasAndByOneOfTheFirstThree) {
  const Stage stage = Floorball();
  for (double x = -19.75; x < 20; x += 0.5) {
    for (double y = -9.75; y < 10; y += 0.5) {
      int seen = 0;
      bool early = false;
      for (std::size_t i = 0; i < stage.cameras.size(); ++i) {
        const Camera& camera = stage.cameras[i].camera;
        const auto foot = camera.ImageFromWorld({x, y, 0});
        const auto head = camera.ImageFromWorld({x, y, 1.8});
        if (!foot || !head || !camera.InPicture(*foot) || !camera.InPicture(*head)) continue;
        ++seen;
        early |= i < 3;
      }
      EXPECT_GE(seen, 3) << x << ", " << y;
      EXPECT_TRUE(early) << x << ", " << y;
    }
  }
}

TEST(Floorball, LensesReachTheCornersOfTheirPictures) {
  for (const StageCamera& camera : Floorball().cameras) {
    // The upper corners look above the horizon: at the ceiling.
    EXPECT_TRUE(camera.camera.WorldFromImage({0, 767}));
    EXPECT_TRUE(camera.camera.WorldFromImage({959, 767}));
    EXPECT_TRUE(camera.camera.WorldFromImage({0, 0}, 40) ||
                camera.camera.WorldFromImage({0, 0}, 0));
    EXPECT_TRUE(camera.camera.WorldFromImage({959, 0}, 40) ||
                camera.camera.WorldFromImage({959, 0}, 0));
  }
}

TEST(Floorball, ScalesAndLeavesOutCameras) {
  PresetOptions options = Short(3);
  options.cameras = 3;
  options.scale = 0.5;
  const Stage stage = Floorball(options);
  EXPECT_EQ(stage.frames, 3);
  ASSERT_EQ(stage.cameras.size(), 3U);
  const Stage full = Floorball(Short(3));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(stage.cameras[i].camera.size(), (ImageSize{480, 384}));
    const auto small = stage.cameras[i].camera.ImageFromWorld({1, 2, 0});
    const auto large = full.cameras[i].camera.ImageFromWorld({1, 2, 0});
    ASSERT_TRUE(small && large);
    EXPECT_LT((2 * *small - *large).norm(), 1);
  }
}

TEST(Floorball, RefusesWhatItCannotDo) {
  PresetOptions options = Short();
  options.cameras = 9;
  EXPECT_THAT(MakeFloorball(options).error().message, HasSubstr("cameras is 9"));
  options.cameras = 0;
  EXPECT_THAT(MakeFloorball(options).error().message, HasSubstr("1 to 8"));
  options = Short();
  options.people = "gt.txt";
  EXPECT_THAT(MakeFloorball(options).error().message, HasSubstr("people"));
}

TEST(Floorball, HasThingsThatAreFiniteAndDressed) {
  const Stage stage = Floorball();
  ExpectValid(stage.limbs, stage.blocks, stage.materials.size());
  for (const Material& material : stage.materials) {
    EXPECT_GT(material.scale_m, 0);
    EXPECT_GE(material.color.minCoeff(), 0);
    EXPECT_LE(material.color.maxCoeff(), 1);
    EXPECT_GE(material.second.minCoeff(), 0);
    EXPECT_LE(material.second.maxCoeff(), 1);
  }
  for (FrameIndex frame = 0; frame < stage.frames; frame += 7) {
    const std::vector<Thing> things = stage.script->At(frame);
    int people = 0;
    int last = 0;
    for (const Thing& thing : things) {
      EXPECT_GT(thing.id, last);
      last = thing.id;
      ExpectValid(thing.limbs, thing.blocks, stage.materials.size());
      if (thing.kind == Thing::Kind::kScenery) continue;
      people += thing.kind == Thing::Kind::kPerson ? 1 : 0;
      for (const Limb& limb : thing.limbs) {
        EXPECT_GE(std::min(limb.a_m.z() - limb.a_radius_m, limb.b_m.z() - limb.b_radius_m), -1e-3F);
      }
    }
    EXPECT_EQ(people, 29);
    EXPECT_EQ(things.size(), 32U);
  }
}

TEST(Floorball, ItsScriptDependsOnTheFrameAlone) {
  const Stage stage = Floorball();
  const Stage again = Floorball();
  for (const FrameIndex frame : {150, 3, 77, 3, 199, 0}) {
    const std::vector<Thing> a = stage.script->At(frame), b = again.script->At(frame);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].id, b[i].id);
      EXPECT_EQ(a[i].ground_m, b[i].ground_m);
      ASSERT_EQ(a[i].limbs.size(), b[i].limbs.size());
      for (std::size_t k = 0; k < a[i].limbs.size(); ++k) {
        EXPECT_EQ(a[i].limbs[k].b_m, b[i].limbs[k].b_m);
        EXPECT_EQ(a[i].limbs[k].material, b[i].limbs[k].material);
      }
    }
    EXPECT_EQ(stage.script->Gains(frame), again.script->Gains(frame));
  }
}

TEST(Floorball, ItsLightDriftsMildlyAndSometimesChangesSuddenly) {
  const Stage stage = Floorball(Short(2000));
  std::vector<float> before = stage.script->Gains(0);
  ASSERT_EQ(before.size(), 1 + stage.lighting.lamps.size());
  float steepest = 0;
  for (FrameIndex frame = 1; frame < stage.frames; ++frame) {
    const std::vector<float> gains = stage.script->Gains(frame);
    for (std::size_t i = 0; i < gains.size(); ++i) {
      EXPECT_GT(gains[i], 0.9F);
      EXPECT_LT(gains[i], 1.12F);
      steepest = std::max(steepest, std::abs(gains[i] - before[i]));
    }
    before = gains;
  }
  EXPECT_GT(steepest, 0.005F);
  EXPECT_LT(steepest, 0.03F);
}

}  // namespace
}  // namespace vantage::simulation
