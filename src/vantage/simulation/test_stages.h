// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "vantage/simulation/stage.h"

/// What every stage must keep to.

namespace vantage::simulation::testing {

inline std::map<int, Eigen::Vector2d> PeopleAt(const Stage& stage, FrameIndex frame) {
  std::map<int, Eigen::Vector2d> people;
  for (const Thing& thing : stage.script->At(frame)) {
    if (thing.kind == Thing::Kind::kPerson) people[thing.id] = thing.ground_m;
  }
  return people;
}

inline int PeopleInArea(const Stage& stage, FrameIndex frame) {
  int count = 0;
  for (const auto& [id, place] : PeopleAt(stage, frame)) count += stage.area.Contains(place);
  return count;
}

/// Ids ascend, materials exist, gains fit the lights, soles are near the ground.
inline void ExpectSoundFrame(const Stage& stage, FrameIndex frame) {
  const auto is_material = [&](MaterialIndex index) {
    return index >= 0 && index < static_cast<int>(stage.materials.size());
  };
  int last_id = 0;
  for (const Thing& thing : stage.script->At(frame)) {
    EXPECT_GT(thing.id, last_id) << "frame " << frame;
    last_id = thing.id;
    double lowest = 1e9;
    for (const Limb& limb : thing.limbs) {
      EXPECT_TRUE(is_material(limb.material));
      EXPECT_TRUE(limb.a_m.allFinite() && limb.b_m.allFinite());
      lowest = std::min<double>(
          lowest, std::min(limb.a_m.z() - limb.a_radius_m, limb.b_m.z() - limb.b_radius_m));
    }
    for (const Block& block : thing.blocks) EXPECT_TRUE(is_material(block.material));
    if (thing.kind == Thing::Kind::kPerson) {
      EXPECT_NEAR(lowest, 0, 0.08) << "person " << thing.id << ", frame " << frame;
      EXPECT_TRUE(thing.foreground);
    }
    if (thing.kind == Thing::Kind::kScenery) {
      EXPECT_FALSE(thing.foreground);
    }
  }
  const std::vector<float> gains = stage.script->Gains(frame);
  EXPECT_EQ(gains.size(), stage.lighting.lamps.size() + 1);
  for (const float gain : gains) EXPECT_GE(gain, 0);
  for (const Block& block : stage.blocks) EXPECT_TRUE(is_material(block.material));
  for (const Limb& limb : stage.limbs) EXPECT_TRUE(is_material(limb.material));
}

/// Nobody moves faster than this between frames.
inline void ExpectNobodyJumps(const Stage& stage, double fastest_m_s) {
  std::map<int, Eigen::Vector2d> before;
  for (FrameIndex frame = 0; frame < stage.frames; ++frame) {
    const std::map<int, Eigen::Vector2d> now = PeopleAt(stage, frame);
    for (const auto& [id, place] : now) {
      const auto was = before.find(id);
      if (was == before.end()) continue;
      ASSERT_LE((place - was->second).norm() * stage.frames_per_second, fastest_m_s)
          << "person " << id << " at (" << place.transpose() << "), frame " << frame;
    }
    before = now;
  }
}

/// True when a straight line between two points passes through a fixed block.
inline bool IsHidden(const Stage& stage, const Eigen::Vector3d& from_m,
                     const Eigen::Vector3d& to_m) {
  for (const Block& block : stage.blocks) {
    const double c = std::cos(block.yaw_rad);
    const double s = std::sin(block.yaw_rad);
    const auto local = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
      const Eigen::Vector3d d = p - block.center_m.cast<double>();
      return {c * d.x() + s * d.y(), -s * d.x() + c * d.y(), d.z()};
    };
    const Eigen::Vector3d a = local(from_m);
    const Eigen::Vector3d way = local(to_m) - a;
    double enters = 0;
    double leaves = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double half = block.half_m[axis];
      if (std::abs(way[axis]) < 1e-12) {
        if (std::abs(a[axis]) > half) leaves = -1;
        continue;
      }
      const double t1 = (-half - a[axis]) / way[axis];
      const double t2 = (half - a[axis]) / way[axis];
      enters = std::max(enters, std::min(t1, t2));
      leaves = std::min(leaves, std::max(t1, t2));
    }
    if (enters < leaves && enters < 1) return true;
  }
  return false;
}

/// Whether any camera sees the middle of a person who stands there.
inline bool IsSeen(const Stage& stage, const Eigen::Vector2d& ground_m) {
  for (const StageCamera& camera : stage.cameras) {
    const Eigen::Vector3d middle = {ground_m.x(), ground_m.y(), 1.0};
    const auto pixel = camera.camera.ImageFromWorld(middle);
    if (!pixel || !camera.camera.InPicture(*pixel)) continue;
    if (!IsHidden(stage, camera.camera.center_m(), middle)) return true;
  }
  return false;
}

/// Nobody appears or vanishes before a camera's eyes.
inline void ExpectNobodyPopsUp(const Stage& stage) {
  std::map<int, Eigen::Vector2d> before = PeopleAt(stage, 0);
  for (FrameIndex frame = 1; frame < stage.frames; ++frame) {
    const std::map<int, Eigen::Vector2d> now = PeopleAt(stage, frame);
    for (const auto& [id, place] : now) {
      if (before.count(id) > 0) continue;
      EXPECT_FALSE(IsSeen(stage, place))
          << "person " << id << " appears at (" << place.transpose() << "), frame " << frame;
    }
    for (const auto& [id, place] : before) {
      if (now.count(id) > 0) continue;
      EXPECT_FALSE(IsSeen(stage, place))
          << "person " << id << " vanishes at (" << place.transpose() << "), frame " << frame;
    }
    before = now;
  }
}

/// The same things at the same places, to the last bit.
inline void ExpectSameThings(const Stage& a, const Stage& b, FrameIndex frame) {
  const std::vector<Thing> first = a.script->At(frame);
  const std::vector<Thing> second = b.script->At(frame);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].id, second[i].id);
    EXPECT_EQ(first[i].ground_m, second[i].ground_m);
    ASSERT_EQ(first[i].limbs.size(), second[i].limbs.size());
    for (std::size_t k = 0; k < first[i].limbs.size(); ++k) {
      EXPECT_EQ(first[i].limbs[k].a_m, second[i].limbs[k].a_m);
      EXPECT_EQ(first[i].limbs[k].material, second[i].limbs[k].material);
    }
  }
}

}  // namespace vantage::simulation::testing
