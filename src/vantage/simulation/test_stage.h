// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "vantage/geometry/test_cameras.h"
#include "vantage/simulation/stage.h"

/// Small stages for tests only; not installed.

namespace vantage::testing {

/// A script made of two functions of the frame.
class TestScript final : public simulation::Script {
 public:
  using Things = std::function<std::vector<simulation::Thing>(FrameIndex)>;
  using Lights = std::function<std::vector<float>(FrameIndex)>;
  TestScript(Things things, Lights gains) : things_(std::move(things)), gains_(std::move(gains)) {}
  std::vector<simulation::Thing> At(FrameIndex frame) const override { return things_(frame); }
  std::vector<float> Gains(FrameIndex frame) const override { return gains_(frame); }

 private:
  Things things_;
  Lights gains_;
};

inline simulation::Limb Ball(const Eigen::Vector3f& center_m, float radius_m,
                             simulation::MaterialIndex material) {
  return {center_m, center_m, radius_m, radius_m, material};
}

inline simulation::Thing BallThing(int id, const Eigen::Vector3f& center_m, float radius_m,
                                   simulation::MaterialIndex material) {
  simulation::Thing thing;
  thing.id = id;
  thing.limbs.push_back(Ball(center_m, radius_m, material));
  return thing;
}

/// A person of four limbs.
inline simulation::Thing Person(int id, const Eigen::Vector2d& ground_m,
                                simulation::MaterialIndex material) {
  simulation::Thing person;
  person.id = id;
  person.ground_m = ground_m;
  const auto at = [&](float aside, float up) {
    const Eigen::Vector2f ground = ground_m.cast<float>();
    return Eigen::Vector3f(ground.x() + aside, ground.y(), up);
  };
  person.limbs.push_back({at(0.12F, 0.06F), at(0.1F, 0.9F), 0.06F, 0.09F, material});
  person.limbs.push_back({at(-0.12F, 0.06F), at(-0.1F, 0.9F), 0.06F, 0.09F, material});
  person.limbs.push_back({at(0, 0.95F), at(0, 1.4F), 0.16F, 0.2F, material});
  person.limbs.push_back(Ball(at(0, 1.66F), 0.11F, material));
  return person;
}

/// Materials of TestStage.
enum : simulation::MaterialIndex { kTestGround, kTestWall, kTestRed, kTestBlack };

/// One camera 6 m up that looks north at the ground 8 m away, a speckled ground, a wall of bricks
/// behind it, and one small lamp high above the origin.
inline simulation::Stage TestStage(TestScript::Things things, TestScript::Lights gains = nullptr,
                                   float gloss = 0) {
  using Pattern = simulation::Material::Pattern;
  simulation::Stage stage;
  stage.area = Polygon::Rectangle({-5, -5}, {5, 5}).value();
  stage.frames = 1000;
  stage.materials.resize(4);
  stage.materials[kTestGround] = {
      Pattern::kSpeckle, {0.5F, 0.4F, 0.3F}, {0.3F, 0.3F, 0.3F}, 0.7F, gloss};
  stage.materials[kTestWall] = {Pattern::kBricks, {0.5F, 0.2F, 0.1F}, {0.5F, 0.5F, 0.5F}, 0.5F};
  stage.materials[kTestRed] = {Pattern::kPlain, {0.8F, 0.05F, 0.05F}};
  stage.materials[kTestBlack] = {Pattern::kPlain, {0.01F, 0.01F, 0.01F}};
  stage.blocks.push_back({{0, 0, -0.5F}, {30, 30, 0.5F}, 0, kTestGround});
  stage.blocks.push_back({{0, 10, 1}, {10, 0.1F, 1}, 0, kTestWall});
  stage.lighting.ambient = {0.25F, 0.25F, 0.25F};
  stage.lighting.lamps.push_back({{0, 0, 20}, {0.3F, 0, 0}, {0, 0.3F, 0}, {0.7F, 0.7F, 0.7F}});
  const PinholeModel lens{
      .fx_px = 70, .fy_px = 70, .cx_px = 47.5, .cy_px = 35.5, .distortion = {-0.1, 0.01}};
  simulation::StageCamera camera{
      "one", Camera::Create({96, 72}, lens, LookAt({0, -8, 6}, {0, 0, 0})).value()};
  stage.cameras.push_back(camera);
  if (!gains) gains = [](FrameIndex) { return std::vector<float>{1, 1}; };
  stage.script = std::make_unique<TestScript>(std::move(things), std::move(gains));
  return stage;
}

}  // namespace vantage::testing
