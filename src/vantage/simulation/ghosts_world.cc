// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/ghosts_world.h"

#include <numbers>

#include "vantage/simulation/things.h"
#include "vantage/simulation/wardrobe.h"

namespace vantage::simulation {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using Pattern = Material::Pattern;

void LayGround(Stage& stage, Dice& dice) {
  const auto add = [&](const Material& material) { return AddMaterial(stage.materials, material); };
  const MaterialIndex asphalt = add({.pattern = Pattern::kSpeckle,
                                     .color = {0.185F, 0.185F, 0.19F},
                                     .second = {0.105F, 0.105F, 0.11F},
                                     .scale_m = 0.5F,
                                     .seed = dice.Seed()});
  const MaterialIndex paving = add({.pattern = Pattern::kBricks,
                                    .color = {0.33F, 0.27F, 0.21F},
                                    .second = {0.10F, 0.09F, 0.08F},
                                    .scale_m = 0.6F,
                                    .seed = dice.Seed()});
  const MaterialIndex checks = add({.pattern = Pattern::kChecks,
                                    .color = {0.42F, 0.40F, 0.36F},
                                    .second = {0.09F, 0.09F, 0.095F},
                                    .scale_m = 0.5F});
  const MaterialIndex hatching = add({.pattern = Pattern::kStripes,
                                      .color = {0.55F, 0.55F, 0.52F},
                                      .second = {0.13F, 0.13F, 0.135F},
                                      .scale_m = 0.4F});
  const MaterialIndex white = add({.color = {0.6F, 0.6F, 0.57F}});
  const MaterialIndex grass = add({.pattern = Pattern::kGrass,
                                   .color = {0.08F, 0.14F, 0.03F},
                                   .second = {0.03F, 0.06F, 0.012F},
                                   .scale_m = 0.1F,
                                   .seed = dice.Seed()});
  stage.blocks.push_back(Patch({0, 0}, {100, 100}, 0, 0, asphalt));
  stage.blocks.push_back(Patch({0, 10.6F}, {40, 1.9F}, 0, 1, paving));
  // The first one's ghost lies over checks, the car's on asphalt before bricks; hatching beside it.
  stage.blocks.push_back(Patch({10.1F, 6.4F}, {2.7F, 1.5F}, 0, 2, hatching));
  stage.blocks.push_back(Patch({0.2F, 5.6F}, {1.2F, 1.2F}, 0, 2.5F, checks));
  for (const float x : {1.7F, 7.3F, 12.9F}) {
    stage.blocks.push_back(GroundLine({x, 4.6F}, {x, 8.2F}, 0.12F, 3, white));
  }
  stage.blocks.push_back(GroundLine({-30, 0.2F}, {30, -0.4F}, 0.15F, 3, white));
  stage.blocks.push_back(Patch({-12.5F, -1.5F}, {8.5F, 3.2F}, 0.1, 3.5F, grass));
}

void BuildOffice(Stage& stage, Dice& dice) {
  const auto add = [&](const Material& material) { return AddMaterial(stage.materials, material); };
  const MaterialIndex brick = add({.pattern = Pattern::kBricks,
                                   .color = {0.30F, 0.13F, 0.08F},
                                   .second = {0.36F, 0.32F, 0.27F},
                                   .scale_m = 0.3F,
                                   .seed = dice.Seed()});
  const MaterialIndex glass = add({.color = {0.04F, 0.045F, 0.05F}, .gloss = 0.06F});
  const MaterialIndex frame = add({.color = {0.5F, 0.5F, 0.47F}});
  const MaterialIndex dark = add({.color = {0.008F, 0.008F, 0.008F}});
  Build(stage, HouseShape({{0, 17.5F}, {26, 5}, 6.5F, 0, brick, glass, frame}));
  stage.blocks.push_back({{-2.4F, 12.46F, 1.3F}, {0.95F, 0.01F, 1.3F}, 0, frame});
  stage.blocks.push_back({{-2.4F, 12.44F, 1.2F}, {0.8F, 0.01F, 1.2F}, 0, dark});
  const MaterialIndex letters = add({.pattern = Pattern::kLetters,
                                     .color = {0.04F, 0.08F, 0.28F},
                                     .second = {0.65F, 0.65F, 0.6F},
                                     .scale_m = 0.35F,
                                     .seed = dice.Seed()});
  stage.blocks.push_back({{-2.4F, 12.42F, 2.98F}, {1.6F, 0.03F, 0.35F}, 0, letters});
}

}  // namespace

void BuildForecourt(Stage& stage, Rehearsal& rehearsal, Dice& dice) {
  LayGround(stage, dice);
  BuildOffice(stage, dice);
  const auto add = [&](const Material& material) { return AddMaterial(stage.materials, material); };
  const MaterialIndex wood = add({.pattern = Pattern::kPlanks,
                                  .color = {0.27F, 0.16F, 0.08F},
                                  .second = {0.08F, 0.05F, 0.03F},
                                  .scale_m = 0.2F,
                                  .seed = dice.Seed()});
  const MaterialIndex metal = add({.color = {0.06F, 0.06F, 0.065F}});
  const Eigen::Vector2f bench = (0.5 * (kBenchLeft + kBenchRight)).cast<float>();
  Build(stage, Placed(Bench(wood, metal), {bench.x(), bench.y(), 0}, std::numbers::pi_v<float>));

  // The sign that stands before people: two posts and a board from the knee to the chest.
  const MaterialIndex print = add({.pattern = Pattern::kLetters,
                                   .color = {0.55F, 0.5F, 0.1F},
                                   .second = {0.03F, 0.03F, 0.03F},
                                   .scale_m = 0.22F,
                                   .seed = dice.Seed()});
  stage.blocks.push_back({{2.2F, 1.8F, 1.05F}, {0.45F, 0.02F, 0.3F}, 0, print});
  for (const float x : {1.8F, 2.6F}) {
    stage.limbs.push_back({{x, 1.84F, 0}, {x, 1.84F, 1.4F}, 0.03F, 0.03F, metal});
  }
  AddTrees(stage, rehearsal, {{-8.0F, 9.9F}, {8.3F, 10.6F}, {-13, -2}}, 4.2, 5.6, 70, dice);
  // A bare young tree in front: thin branches that break people into pieces.
  const MaterialIndex bark = add({.color = {0.09F, 0.07F, 0.05F}});
  const Vector3f foot = {-2.5F, 1.5F, 0};
  stage.limbs.push_back({foot, foot + Vector3f(0.05F, 0, 3.2F), 0.07F, 0.03F, bark});
  for (int branch = 0; branch < 9; ++branch) {
    const float z = 0.7F + 0.22F * static_cast<float>(branch);
    const auto angle = static_cast<float>(dice.Uniform(0, 2 * std::numbers::pi));
    stage.limbs.push_back(
        {foot + Vector3f(0, 0, z),
         foot + Vector3f(0.8F * std::cos(angle), 0.8F * std::sin(angle), z + 0.5F), 0.028F, 0.01F,
         bark});
  }

  stage.lighting.ambient = {0.38F, 0.41F, 0.47F};
  stage.lighting.sky = {0.42F, 0.50F, 0.62F};
  stage.lighting.lamps.push_back({.center_m = {-80, -90, 120},
                                  .half_u_m = {1.5F, -1.3F, 0},
                                  .half_v_m = {0.9F, 1.0F, 1.4F},
                                  .color = {1.05F, 0.97F, 0.85F}});
  stage.lighting.lamps.push_back({.center_m = {-2.4F, 11.6F, 4.2F},
                                  .half_u_m = {0.5F, 0, 0},
                                  .half_v_m = {0, 0.1F, 0},
                                  .color = {0.30F, 0.26F, 0.17F}});
  rehearsal.lights = {
      {}, {{0, 1}, {13, 1}, {27, 0.55}, {31, 0.6}, {38, 0.9}}, {{41.98, 0}, {42, 1}}};
}

Shape BagShape(Stage& stage, Dice& dice) {
  const MaterialIndex cloth = AddMaterial(stage.materials, {.pattern = Pattern::kSpeckle,
                                                            .color = {0.35F, 0.05F, 0.04F},
                                                            .second = {0.22F, 0.03F, 0.03F},
                                                            .scale_m = 0.08F,
                                                            .seed = dice.Seed()});
  const MaterialIndex strap = AddMaterial(stage.materials, {.color = {0.03F, 0.03F, 0.03F}});
  Shape bag;
  bag.blocks.push_back({{0, 0, 0.16F}, {0.26F, 0.13F, 0.16F}, 0, cloth});
  bag.limbs.push_back({{-0.12F, 0, 0.33F}, {0, 0, 0.46F}, 0.018F, 0.018F, strap});
  bag.limbs.push_back({{0, 0, 0.46F}, {0.12F, 0, 0.33F}, 0.018F, 0.018F, strap});
  return bag;
}

Shape GhostCarShape(Stage& stage) {
  const auto add = [&](const Material& material) { return AddMaterial(stage.materials, material); };
  return Car({add({.color = {0.03F, 0.06F, 0.20F}, .gloss = 0.03F}),
              add({.color = {0.03F, 0.035F, 0.04F}, .gloss = 0.08F}),
              add({.color = {0.015F, 0.015F, 0.015F}}), add({.color = {0.6F, 0.55F, 0.45F}})},
             false);
}

}  // namespace vantage::simulation
