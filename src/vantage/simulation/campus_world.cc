// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/campus_world.h"

#include "vantage/simulation/things.h"
#include "vantage/simulation/wardrobe.h"

namespace vantage::simulation {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using Pattern = Material::Pattern;

/// Foot of the lamp post, and the places of the cameras 5 to 8, which stand on tripods.
const Vector2f kLampPost = {-13.78F, -10.66F};
const Vector3f kTripodCameras[] = {{-14.64F, -1.67F, 2.11F},
                                   {-15.86F, -12.99F, 2.24F},
                                   {-2.78F, -16.58F, 2.16F},
                                   {-0.17F, -3.53F, 1.79F}};

const Vector2f kTrees[] = {{9.8F, 15}, {-3.9F, 22}, {10, -15}, {21, -13},  {-19, 7.5F}, {-31, 1},
                           {-36, -12}, {-4, -37},   {8, -31},  {-30, -48}, {-12, 31},   {18, 33}};

void LayGround(Stage& stage, Dice& dice) {
  const auto add = [&](const Material& material) { return AddMaterial(stage.materials, material); };
  const auto add_block = [&](const Block& block) { stage.blocks.push_back(block); };
  const MaterialIndex grass = add({.pattern = Pattern::kGrass,
                                   .color = {0.075F, 0.13F, 0.025F},
                                   .second = {0.035F, 0.07F, 0.015F},
                                   .scale_m = 0.12F,
                                   .seed = dice.Seed()});
  const MaterialIndex asphalt = add({.pattern = Pattern::kSpeckle,
                                     .color = {0.20F, 0.20F, 0.205F},
                                     .second = {0.125F, 0.125F, 0.13F},
                                     .scale_m = 0.9F,
                                     .seed = dice.Seed()});
  const MaterialIndex dark = add({.pattern = Pattern::kSpeckle,
                                  .color = {0.11F, 0.11F, 0.115F},
                                  .second = {0.075F, 0.075F, 0.08F},
                                  .scale_m = 0.4F,
                                  .seed = dice.Seed()});
  const MaterialIndex gravel = add({.pattern = Pattern::kGrass,
                                    .color = {0.30F, 0.24F, 0.16F},
                                    .second = {0.14F, 0.11F, 0.08F},
                                    .scale_m = 0.06F,
                                    .seed = dice.Seed()});
  const MaterialIndex kerb = add({.pattern = Pattern::kBricks,
                                  .color = {0.38F, 0.37F, 0.34F},
                                  .second = {0.12F, 0.12F, 0.11F},
                                  .scale_m = 0.9F,
                                  .seed = dice.Seed()});
  const MaterialIndex white = add({.color = {0.6F, 0.6F, 0.58F}});
  const MaterialIndex yellow = add({.color = {0.55F, 0.38F, 0.04F}});
  const MaterialIndex cover = add({.pattern = Pattern::kChecks,
                                   .color = {0.05F, 0.05F, 0.05F},
                                   .second = {0.14F, 0.13F, 0.12F},
                                   .scale_m = 0.09F});
  add_block(Patch({0, 0}, {300, 300}, 0, 0, grass));

  // Roads: kerbs below, asphalt on them, each piece a little higher than what it overlaps.
  struct Piece {
    Vector2f from, to;
    float width_m;
  };
  const Piece roads[] = {{{-7.5F, 60}, {-7.5F, -1}, 4.9F},      {{-7.5F, 1}, {-8.4F, -6}, 5.5F},
                         {{-7.9F, -3}, {-9.6F, -9.5F}, 6.2F},   {{-8.6F, -6}, {-12.6F, -20}, 8.4F},
                         {{-12.3F, -19}, {-26, -70}, 8.2F},     {{-9.5F, -8.2F}, {80, -3.0F}, 6.6F},
                         {{-8.5F, -5.5F}, {-1.5F, -6.4F}, 4.4F}};
  float height_mm = 1.0F;
  for (const Piece& road : roads) {
    add_block(GroundLine(road.from, road.to, road.width_m + 0.3F, height_mm, kerb));
    height_mm += 0.1F;
  }
  for (const Piece& road : roads) {
    add_block(GroundLine(road.from, road.to, road.width_m, height_mm, asphalt));
    height_mm += 0.1F;
  }
  add_block(Patch({-1.6F, 7.6F}, {3.3F, 8.4F}, 0.02, 2.5F, dark));  // parking bay
  for (int line = 0; line < 6; ++line) {
    const float y = 1.2F + 2.7F * static_cast<float>(line);
    add_block(GroundLine({-3.2F, y}, {1.7F, y + 0.1F}, 0.12F, 3, white));
  }
  add_block(Patch({-3.2F, -2.0F}, {1.9F, 1.2F}, -0.7, 2.7F, gravel));

  // Markings: the lines of the junction, double yellow ones along its kerb, a crossing.
  const Piece lines[] = {{{-11, -7.1F}, {-7.2F, -8.7F}, 0.12F},
                         {{-10.05F, -11.9F}, {-6.4F, -9.2F}, 0.12F},
                         {{-7.6F, -8.4F}, {-3.2F, -8.8F}, 0.12F},
                         {{-5.0F, -5.0F}, {-0.5F, -5.3F}, 0.12F}};
  for (const Piece& line : lines) {
    add_block(GroundLine(line.from, line.to, line.width_m, 3.4F, white));
  }
  for (const float aside : {0.0F, 0.22F}) {
    add_block(GroundLine({-6.9F - aside, -14.5F}, {-4.6F - aside, -11.0F}, 0.09F, 3.5F, yellow));
    add_block(GroundLine({-4.6F, -11.0F + aside}, {30, -9.0F + aside}, 0.09F, 3.6F, yellow));
  }
  for (int stripe = 0; stripe < 5; ++stripe) {
    const float x = -9.4F + 0.95F * static_cast<float>(stripe);
    add_block(GroundLine({x, 0.4F}, {x, -1.6F}, 0.45F, 3.8F, white));
  }
  add_block(Patch({-9.0F, -10.3F}, {0.32F, 0.32F}, 0.5, 4, cover));
  add_block(Patch({-7.2F, -4.2F}, {0.25F, 0.4F}, 0.1, 4, cover));
}

void BuildHouses(Stage& stage, Dice& dice) {
  const auto add = [&](const Material& material) { return AddMaterial(stage.materials, material); };
  const MaterialIndex brick = add({.pattern = Pattern::kBricks,
                                   .color = {0.28F, 0.135F, 0.07F},
                                   .second = {0.34F, 0.29F, 0.23F},
                                   .scale_m = 0.24F,
                                   .seed = dice.Seed()});
  const MaterialIndex pale = add({.pattern = Pattern::kBricks,
                                  .color = {0.36F, 0.27F, 0.17F},
                                  .second = {0.20F, 0.18F, 0.15F},
                                  .scale_m = 0.3F,
                                  .seed = dice.Seed()});
  const MaterialIndex glass = add({.color = {0.03F, 0.035F, 0.04F}, .gloss = 0.06F});
  const MaterialIndex red = add({.color = {0.22F, 0.05F, 0.03F}});
  const MaterialIndex light = add({.color = {0.45F, 0.44F, 0.42F}});
  const House houses[] = {{{21.5F, 5}, {8.5F, 6.2F}, 7, 0.094F, brick, glass, red},
                          {{43, 46}, {17, 5}, 7, -0.25F, brick, glass, light},
                          {{-22, 16}, {9.5F, 4}, 6.5F, 0, pale, glass, light},
                          {{-20, -72}, {30, 5}, 9.5F, 0, brick, glass, light},
                          {{45, -28}, {6, 15}, 7, 0.1F, pale, glass, red},
                          {{-62, -18}, {6, 30}, 7, 0.05F, brick, glass, light},
                          {{-16, 66}, {22, 6}, 9.5F, 0.1F, brick, glass, red},
                          {{88, 2}, {5, 14}, 9.5F, 0, pale, glass, light}};
  for (const House& house : houses) Build(stage, HouseShape(house));
}

void PlaceThings(Stage& stage, Dice& dice) {
  const auto add = [&](const Material& material) { return AddMaterial(stage.materials, material); };
  const MaterialIndex steel = add({.color = {0.30F, 0.34F, 0.36F}});
  const MaterialIndex black = add({.color = {0.02F, 0.02F, 0.02F}});
  const MaterialIndex white = add({.color = {0.7F, 0.7F, 0.68F}});
  const MaterialIndex orange = add({.color = {0.75F, 0.16F, 0.02F}});
  const MaterialIndex sign = add({.pattern = Pattern::kLetters,
                                  .color = {0.02F, 0.26F, 0.22F},
                                  .second = {0.7F, 0.72F, 0.7F},
                                  .scale_m = 0.16F,
                                  .seed = dice.Seed()});
  const MaterialIndex tape = add({.pattern = Pattern::kStripes,
                                  .color = {0.7F, 0.7F, 0.7F},
                                  .second = {0.6F, 0.05F, 0.04F},
                                  .scale_m = 0.25F});
  const MaterialIndex stone = add({.pattern = Pattern::kSpeckle,
                                   .color = {0.33F, 0.31F, 0.27F},
                                   .second = {0.2F, 0.19F, 0.17F},
                                   .scale_m = 0.15F,
                                   .seed = dice.Seed()});

  // The lamp post, its arm, and the sign that hides people's heads from View 1.
  const Vector3f foot = {kLampPost.x(), kLampPost.y(), 0};
  const Vector3f bend = foot + Vector3f(0.02F, 0.08F, 4.75F);
  const Vector3f arm = bend + Vector3f(-0.1F, 0.4F, 0.7F);
  stage.limbs.push_back({foot, bend, 0.085F, 0.055F, steel});
  stage.limbs.push_back({bend, arm, 0.05F, 0.04F, steel});
  stage.limbs.push_back({arm, arm + Vector3f(0.15F, -0.45F, 0.08F), 0.08F, 0.12F, white});
  stage.blocks.push_back(
      {foot + Vector3f(-0.08F, -0.05F, 2.72F), {0.012F, 0.28F, 0.32F}, 0.53F, sign});
  for (const Vector3f& camera : kTripodCameras) Build(stage, Tripod(camera, black));

  const Vector2f cones[] = {{-5.2F, 13}, {-5.15F, 8}, {-5.15F, 3}, {-4.6F, -0.9F}, {-1.7F, -4.2F}};
  for (std::size_t i = 0; i < std::size(cones); ++i) {
    Build(stage, Placed(TrafficCone(orange, white), {cones[i].x(), cones[i].y(), 0.005F}, 0.3F));
    if (i == 0) continue;
    stage.limbs.push_back({{cones[i - 1].x(), cones[i - 1].y(), 0.7F},
                           {cones[i].x(), cones[i].y(), 0.7F},
                           0.03F,
                           0.03F,
                           tape});
  }
  for (const Vector2f& at : {Vector2f(-12.2F, -1.7F), Vector2f(-0.9F, -11.6F),
                             Vector2f(-3.4F, -12.4F), Vector2f(-5.7F, -13.9F)}) {
    stage.limbs.push_back(
        {{at.x(), at.y(), 0.1F}, {at.x() + 0.1F, at.y(), 0.3F}, 0.3F, 0.16F, stone});
  }

  const MaterialIndex glass = add({.color = {0.03F, 0.04F, 0.05F}, .gloss = 0.08F});
  const MaterialIndex teal = add({.color = {0.16F, 0.33F, 0.36F}, .gloss = 0.03F});
  const MaterialIndex rear = add({.color = {0.5F, 0.04F, 0.03F}});
  Build(stage, Placed(Car({white, glass, black, rear}, true), {20.5F, -3.6F, 0.01F}, 0.06F));
  Build(stage, Placed(Car({teal, glass, black, rear}, false), {27, -3.3F, 0.01F}, 0.06F));
}

}  // namespace

void BuildCampus(Stage& stage, Rehearsal& rehearsal, double seconds, Dice& dice) {
  LayGround(stage, dice);
  BuildHouses(stage, dice);
  PlaceThings(stage, dice);

  AddTrees(stage, rehearsal, {std::begin(kTrees), std::end(kTrees)}, 5, 8, 50, dice);

  // A low sun in the south-west between clouds.
  stage.lighting.ambient = {0.42F, 0.45F, 0.50F};
  stage.lighting.sky = {0.46F, 0.52F, 0.60F};
  stage.lighting.lamps.push_back({.center_m = {-90, -110, 140},
                                  .half_u_m = {1.55F, -1.27F, 0},
                                  .half_v_m = {0.9F, 1.1F, 1.44F},
                                  .color = {1.05F, 0.97F, 0.85F}});
  rehearsal.lights = {{}, Clouds(seconds, dice)};
}

std::vector<Pillar> CampusPillars() {
  std::vector<Pillar> pillars = {{kLampPost.cast<double>(), 0.15}};
  for (const Vector3f& camera : kTripodCameras) {
    pillars.push_back({camera.head<2>().cast<double>(), 0.55});
  }
  for (const Vector2f& tree : kTrees) pillars.push_back({tree.cast<double>(), 0.35});
  return pillars;
}

std::vector<Gate> CampusGates() {
  return {{{-0.3, -27.5}, {-6, -20.5}},        // south, below View 2
          {{-25, -3}, {-20, -5}},              // west, across the lawn
          {{-22, 25}, {-10, 24}, {-8.5, 14}},  // north, behind the house
          {{33, 5}, {34, -5.8}, {14, -7}}};    // east, behind the brick house
}

}  // namespace vantage::simulation
