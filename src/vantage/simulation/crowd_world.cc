// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/crowd_world.h"

#include "vantage/simulation/things.h"
#include "vantage/simulation/wardrobe.h"

namespace vantage::simulation {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;
using Pattern = Material::Pattern;

const Vector2f kTrees[] = {{-7.5F, -6}, {-7, 3},  {-7.5F, 16}, {-6, 30}, {15, 31},
                           {16.5F, 14}, {16, -6}, {12, -15},   {-6, -16}};
const Vector2f kBenches[] = {{-5.5F, 21}, {-5.5F, -2}, {14.5F, 6}};

/// A door in a wall: on the ground before the middle of the wall's outer face, which looks along
/// `outward`.
struct Door {
  Vector2f place_m;
  Vector2f outward;
};
constexpr float kWestWall = -13;
constexpr float kEastWall = 22;
constexpr float kSouthWall = -22;
constexpr float kNorthWall = 38;
const Door kDoors[] = {{{kWestWall, -4}, {1, 0}},   {{kWestWall, 12}, {1, 0}},
                       {{kWestWall, 25}, {1, 0}},   {{kEastWall, -8}, {-1, 0}},
                       {{kEastWall, 10}, {-1, 0}},  {{kEastWall, 24}, {-1, 0}},
                       {{-2, kSouthWall}, {0, 1}},  {{9, kSouthWall}, {0, 1}},
                       {{-1, kNorthWall}, {0, -1}}, {{9, kNorthWall}, {0, -1}}};

void LayPavement(Stage& stage, Dice& dice) {
  const auto add = [&](const Material& material) { return AddMaterial(stage.materials, material); };
  const MaterialIndex slabs = add({.pattern = Pattern::kBricks,
                                   .color = {0.27F, 0.26F, 0.245F},
                                   .second = {0.13F, 0.125F, 0.12F},
                                   .scale_m = 0.9F,
                                   .seed = dice.Seed()});
  const MaterialIndex dark = add({.pattern = Pattern::kBricks,
                                  .color = {0.13F, 0.13F, 0.135F},
                                  .second = {0.07F, 0.07F, 0.07F},
                                  .scale_m = 0.3F,
                                  .seed = dice.Seed()});
  const MaterialIndex light = add({.pattern = Pattern::kSpeckle,
                                   .color = {0.45F, 0.44F, 0.41F},
                                   .second = {0.38F, 0.37F, 0.35F},
                                   .scale_m = 0.3F,
                                   .seed = dice.Seed()});
  const MaterialIndex soil = add({.pattern = Pattern::kGrass,
                                  .color = {0.09F, 0.06F, 0.035F},
                                  .second = {0.04F, 0.03F, 0.02F},
                                  .scale_m = 0.06F,
                                  .seed = dice.Seed()});
  stage.blocks.push_back(Patch({4, 8}, {150, 150}, 0, 0, slabs));
  // Dark bands across the square between light lines, and a wheel of checks in its middle.
  for (int band = 0; band < 7; ++band) {
    const float y = -16 + 8 * static_cast<float>(band);
    stage.blocks.push_back(Patch({4.5F, y}, {17.4F, 0.45F}, 0, 1, dark));
    for (const float side : {-0.5F, 0.5F}) {
      stage.blocks.push_back(Patch({4.5F, y + side}, {17.4F, 0.05F}, 0, 1.2F, light));
    }
  }
  for (const float x : {-3.5F, 10.5F}) {
    stage.blocks.push_back(Patch({x, 8}, {0.3F, 29.5F}, 0, 1.5F, light));
  }
  stage.blocks.push_back(Patch({3.5F, 9}, {1.8F, 1.8F}, 0.785, 2, light));
  stage.blocks.push_back(Patch({3.5F, 9}, {1.4F, 1.4F}, 0.785, 2.5F, dark));
  for (const Vector2f& tree : kTrees) {
    stage.blocks.push_back(Patch(tree, {0.8F, 0.8F}, 0, 1.8F, soil));
  }
}

void BuildWalls(Stage& stage, Dice& dice) {
  const auto add = [&](const Material& material) { return AddMaterial(stage.materials, material); };
  const MaterialIndex stone = add({.pattern = Pattern::kBricks,
                                   .color = {0.42F, 0.38F, 0.30F},
                                   .second = {0.25F, 0.22F, 0.18F},
                                   .scale_m = 1.0F,
                                   .seed = dice.Seed()});
  const MaterialIndex brick = add({.pattern = Pattern::kBricks,
                                   .color = {0.27F, 0.11F, 0.07F},
                                   .second = {0.33F, 0.29F, 0.24F},
                                   .scale_m = 0.25F,
                                   .seed = dice.Seed()});
  const MaterialIndex plaster = add({.pattern = Pattern::kSpeckle,
                                     .color = {0.50F, 0.47F, 0.40F},
                                     .second = {0.44F, 0.41F, 0.35F},
                                     .scale_m = 0.8F,
                                     .seed = dice.Seed()});
  const MaterialIndex boards = add({.pattern = Pattern::kPlanks,
                                    .color = {0.16F, 0.17F, 0.19F},
                                    .second = {0.06F, 0.06F, 0.07F},
                                    .scale_m = 0.5F,
                                    .seed = dice.Seed()});
  const MaterialIndex glass = add({.color = {0.035F, 0.04F, 0.05F}, .gloss = 0.07F});
  const MaterialIndex frame = add({.color = {0.42F, 0.42F, 0.40F}});
  const MaterialIndex dark = add({.color = {0.006F, 0.006F, 0.007F}});
  const House houses[] = {{{kWestWall - 6, 8}, {6, 36}, 10, 0, stone, glass, frame},
                          {{kEastWall + 6, 8}, {6, 36}, 10, 0, boards, glass, frame},
                          {{4.5F, kSouthWall - 6}, {14.5F, 6}, 13, 0, brick, glass, frame},
                          {{4.5F, kNorthWall + 6}, {14.5F, 6}, 13, 0, plaster, glass, frame}};
  for (const House& house : houses) Build(stage, HouseShape(house));
  // Doors stand open on the dark: before the windows, with a frame round them.
  for (const Door& door : kDoors) {
    const bool along_x = door.outward.x() == 0;
    const auto sheet = [&](float half_width, float height, float out, MaterialIndex material) {
      const Vector2f at = door.place_m + out * door.outward;
      stage.blocks.push_back(
          {{at.x(), at.y(), 0.5F * height},
           {along_x ? half_width : 0.01F, along_x ? 0.01F : half_width, 0.5F * height},
           0,
           material});
    };
    sheet(1.35F, 2.7F, 0.04F, frame);
    sheet(1.2F, 2.55F, 0.06F, dark);
  }
}

}  // namespace

void BuildSquare(Stage& stage, Rehearsal& rehearsal, double seconds, Dice& dice) {
  LayPavement(stage, dice);
  BuildWalls(stage, dice);
  const auto add = [&](const Material& material) { return AddMaterial(stage.materials, material); };
  const MaterialIndex wood = add({.pattern = Pattern::kPlanks,
                                  .color = {0.24F, 0.15F, 0.08F},
                                  .second = {0.08F, 0.05F, 0.03F},
                                  .scale_m = 0.2F,
                                  .seed = dice.Seed()});
  const MaterialIndex metal = add({.color = {0.05F, 0.05F, 0.055F}});
  for (const Vector2f& bench : kBenches) {
    const float yaw = bench.x() < 0 ? -1.5708F : 1.5708F;  // looks into the square
    Build(stage, Placed(Bench(wood, metal), {bench.x(), bench.y(), 0}, yaw));
  }
  AddTrees(stage, rehearsal, {std::begin(kTrees), std::end(kTrees)}, 5, 7.5, 60, dice);

  // The board with changing pictures, on two posts before the east wall.
  Board board{.id = kFirstThingId + 500,
              .block = {{19.5F, 2, 2.2F}, {0.06F, 1.8F, 1.1F}, 0, metal},
              .pictures = {},
              .secs = 6};
  const Vector3f colors[][2] = {{{0.6F, 0.1F, 0.05F}, {0.8F, 0.8F, 0.75F}},
                                {{0.05F, 0.2F, 0.5F}, {0.75F, 0.7F, 0.2F}},
                                {{0.7F, 0.7F, 0.7F}, {0.02F, 0.02F, 0.02F}}};
  for (const auto& [ground, print] : colors) {
    board.pictures.push_back(add({.pattern = Pattern::kLetters,
                                  .color = ground,
                                  .second = print,
                                  .scale_m = 0.7F,
                                  .seed = dice.Seed()}));
  }
  rehearsal.boards.push_back(board);
  for (const float y : {0.6F, 3.4F}) {
    stage.blocks.push_back({{19.6F, y, 0.55F}, {0.05F, 0.05F, 0.55F}, 0, metal});
  }

  stage.lighting.ambient = {0.46F, 0.48F, 0.52F};
  stage.lighting.sky = {0.48F, 0.53F, 0.60F};
  stage.lighting.lamps.push_back({.center_m = {70, -60, 170},
                                  .half_u_m = {1.3F, 1.5F, 0},
                                  .half_v_m = {-1.3F, 1.1F, 0.9F},
                                  .color = {0.95F, 0.89F, 0.80F}});
  rehearsal.lights = {{}, Clouds(seconds, dice)};
}

std::vector<Pillar> SquarePillars() {
  std::vector<Pillar> pillars;
  for (const Vector2f& tree : kTrees) pillars.push_back({tree.cast<double>(), 0.3});
  for (const Vector2f& bench : kBenches) pillars.push_back({bench.cast<double>(), 1.0});
  pillars.push_back({{19.5, 2}, 1.9});
  return pillars;
}

std::vector<Gate> SquareGates() {
  std::vector<Gate> gates;
  for (const Door& door : kDoors) {
    const Eigen::Vector2d place = door.place_m.cast<double>();
    const Eigen::Vector2d outward = door.outward.cast<double>();
    gates.push_back({place - 1.5 * outward, place + 1.0 * outward});
  }
  return gates;
}

}  // namespace vantage::simulation
