// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "vantage/base/test_support.h"
#include "vantage/simulation/presets.h"
#include "vantage/simulation/test_stages.h"

namespace vantage::simulation {
namespace {

using ::testing::HasSubstr;
using vantage::testing::MessageOf;

Stage Make(std::uint64_t seed = 1) { return std::move(MakeGhosts({.seed = seed}).value()); }

/// Objects by the frame from which on they are foreground.
std::map<int, FrameIndex> FirstForeground(const Stage& stage) {
  std::map<int, FrameIndex> first;
  for (FrameIndex frame = 0; frame < stage.frames; ++frame) {
    for (const Thing& thing : stage.script->At(frame)) {
      if (thing.kind != Thing::Kind::kObject) continue;
      if (thing.foreground) first.try_emplace(thing.id, frame);
      // Once foreground, always foreground.
      EXPECT_EQ(thing.foreground, first.count(thing.id) > 0) << "thing " << thing.id;
    }
  }
  return first;
}

TEST(GhostsTest, IsOneCameraAndAPlayOfItsOwn) {
  const Stage stage = Make();
  ASSERT_EQ(stage.cameras.size(), 1U);
  EXPECT_EQ(stage.cameras[0].camera.size(), (ImageSize{640, 480}));
  EXPECT_EQ(stage.frames, 1200);
  EXPECT_THAT(MessageOf(MakeGhosts({.cameras = 2})), HasSubstr("ghosts has 1"));
  EXPECT_THAT(MessageOf(MakeGhosts({.people = "truth.txt"})), HasSubstr("leave people out"));
}

TEST(GhostsTest, EveryFrameIsSound) {
  const Stage stage = Make();
  for (FrameIndex frame = 0; frame < stage.frames; frame += 10) {
    testing::ExpectSoundFrame(stage, frame);
  }
  testing::ExpectNobodyJumps(stage, 4.6);  // one runs
  testing::ExpectNobodyPopsUp(stage);
}

TEST(GhostsTest, BagsAndCarAreForegroundFromTheirFirstMoveOn) {
  const std::map<int, FrameIndex> first = FirstForeground(Make());
  ASSERT_EQ(first.size(), 3U);
  std::vector<FrameIndex> frames;
  for (const auto& [id, frame] : first) frames.push_back(frame);
  // Brought at 4 s, lifted at 23.4 s, driven off at 20 s.
  EXPECT_THAT(frames, ::testing::ElementsAre(
                          ::testing::AllOf(::testing::Ge(100), ::testing::Le(102)),
                          ::testing::AllOf(::testing::Ge(585), ::testing::Le(588)), 501));
}

TEST(GhostsTest, APutDownBagStaysAndLiesOnTheGround) {
  const Stage stage = Make();
  const auto bag_at = [&](FrameIndex frame) {
    const std::vector<Thing> things = stage.script->At(frame);
    const auto bag = std::find_if(things.begin(), things.end(), [](const Thing& thing) {
      return thing.kind == Thing::Kind::kObject;
    });
    return *bag;
  };
  const Thing put_down = bag_at(260);
  EXPECT_NEAR(put_down.blocks[0].center_m.z(), put_down.blocks[0].half_m.z(), 1e-4);
  EXPECT_EQ(put_down.ground_m, bag_at(1199).ground_m);
  EXPECT_GT((put_down.ground_m - bag_at(150).ground_m).norm(), 1);
}

TEST(GhostsTest, PeopleSitStandAndComeBack) {
  const Stage stage = Make();
  const auto highest = [&](int id, FrameIndex frame) {
    double top = 0;
    for (const Thing& thing : stage.script->At(frame)) {
      if (thing.id != id) continue;
      for (const Limb& limb : thing.limbs) {
        top = std::max<double>(
            top, std::max(limb.a_m.z() + limb.a_radius_m, limb.b_m.z() + limb.b_radius_m));
      }
    }
    return top;
  };
  EXPECT_LT(highest(2, 0), 1.5);
  EXPECT_GT(highest(2, 440), 1.5);
  EXPECT_EQ(highest(2, 700), 0);  // gone in
  EXPECT_LT(highest(4, 1000), 1.5);
  // The first one stands still, is away, and is back at about the same place.
  const auto place = [&](FrameIndex frame) { return testing::PeopleAt(stage, frame).at(1); };
  EXPECT_EQ(place(0), place(240));
  EXPECT_GT((place(500) - place(0)).norm(), 9);
  EXPECT_LT((place(1100) - place(0)).norm(), 0.5);
}

TEST(GhostsTest, LightsChangeSlowlyAndAtOnce) {
  const Stage stage = Make();
  double slowest = 1;
  for (FrameIndex frame = 1; frame < stage.frames; ++frame) {
    const std::vector<float> before = stage.script->Gains(frame - 1);
    const std::vector<float> now = stage.script->Gains(frame);
    EXPECT_LT(std::abs(now[1] - before[1]), 0.01);
    slowest = std::min<double>(slowest, now[1]);
  }
  EXPECT_LT(slowest, 0.6);
  EXPECT_EQ(stage.script->Gains(1049)[2], 0);
  EXPECT_EQ(stage.script->Gains(1050)[2], 1);
}

}  // namespace
}  // namespace vantage::simulation
