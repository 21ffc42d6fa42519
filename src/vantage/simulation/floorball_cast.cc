// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/floorball_cast.h"

#include <array>
#include <utility>

#include "vantage/simulation/floorball_hall.h"
#include "vantage/simulation/floorball_walkers.h"

namespace vantage::simulation {
namespace {

using Eigen::Vector3f;
using Pattern = Material::Pattern;
using Role = FloorballGame::Role;

// Fabric is never of one shade.
Material Cloth(const Vector3f& color, std::uint32_t seed) {
  return {.pattern = Pattern::kSpeckle,
          .color = color,
          .second = 0.7F * color + Vector3f::Constant(0.004F),
          .scale_m = 0.08F,
          .seed = seed};
}

class Wardrobe {
 public:
  Wardrobe(Stage& stage, std::uint64_t seed) : stage_(stage), dice_(seed * 31 + 7) {
    for (const Vector3f& color : {Vector3f(0.55F, 0.34F, 0.24F), Vector3f(0.62F, 0.42F, 0.32F),
                                  Vector3f(0.46F, 0.27F, 0.17F), Vector3f(0.20F, 0.11F, 0.07F)}) {
      skins_.push_back(AddMaterial(stage_, {.color = color}));
    }
    for (const Vector3f& color : {Vector3f(0.05F, 0.03F, 0.02F), Vector3f(0.14F, 0.08F, 0.04F),
                                  Vector3f(0.40F, 0.28F, 0.12F), Vector3f(0.02F, 0.02F, 0.02F)}) {
      hairs_.push_back(AddMaterial(stage_, {.color = color}));
    }
    for (const Vector3f& color : {Vector3f(0.70F, 0.70F, 0.68F), Vector3f(0.03F, 0.03F, 0.03F),
                                  Vector3f(0.50F, 0.05F, 0.05F), Vector3f(0.25F, 0.26F, 0.27F),
                                  Vector3f(0.06F, 0.25F, 0.10F), Vector3f(0.06F, 0.15F, 0.45F),
                                  Vector3f(0.60F, 0.45F, 0.06F), Vector3f(0.30F, 0.20F, 0.10F)}) {
      colors_.push_back(AddMaterial(stage_, Cloth(color, 100 + Next())));
    }
    teams_ = {AddMaterial(stage_, Cloth({0.014F, 0.026F, 0.10F}, Next())),
              AddMaterial(stage_, Cloth({0.016F, 0.016F, 0.018F}, Next()))};
    keepers_ = {AddMaterial(stage_, Cloth({0.55F, 0.25F, 0.04F}, Next())),
                AddMaterial(stage_, Cloth({0.30F, 0.32F, 0.30F}, Next()))};
    referee_ = AddMaterial(stage_, Cloth({0.75F, 0.12F, 0.35F}, Next()));
  }

  Figure Dress(const FloorballGame::Person& person) {
    Figure figure;
    figure.height_m = person.height_m;
    figure.build = dice_.Uniform(0.92, 1.12);
    figure.skin = Any(skins_);
    figure.hair = Any(hairs_);
    figure.shoes = Any(colors_);
    figure.legs = dice_.Unit() < 0.75 ? Any({colors_[0], colors_[1], colors_[3]}) : Any(colors_);
    figure.shorts = Any(colors_);
    const auto team = static_cast<std::size_t>(person.team);
    switch (person.role) {
      case Role::kPlayer:
        figure.shirt = figure.sleeves = teams_[team];
        figure.stick = true;
        figure.stick_material = Any(colors_);
        break;
      case Role::kKeeper:
        figure.shirt = figure.sleeves = keepers_[team];
        figure.shorts = figure.legs = colors_[team == 0 ? 3 : 1];
        figure.long_sleeves = true;
        figure.build = 1.2;
        break;
      case Role::kReferee:
        figure.shirt = figure.sleeves = referee_;
        figure.shorts = figure.legs = colors_[1];
        break;
      case Role::kCoach:
        figure.shirt = figure.sleeves = teams_[team];
        figure.shorts = figure.legs = colors_[team == 0 ? 5 : 1];
        figure.long_sleeves = true;
        break;
      case Role::kSpectator:
        figure.shirt = figure.sleeves = AddMaterial(
            stage_, {.pattern = dice_.Unit() < 0.5 ? Pattern::kPlaid : Pattern::kStripes,
                     .color = stage_.materials[Index(Any(colors_))].color,
                     .second = stage_.materials[Index(Any(colors_))].color,
                     .scale_m = 0.09F,
                     .seed = Next()});
        figure.long_sleeves = true;
        figure.legs = figure.shorts;
        break;
    }
    return figure;
  }

 private:
  static std::size_t Index(MaterialIndex material) { return static_cast<std::size_t>(material); }
  std::uint32_t Next() { return next_++; }
  MaterialIndex Any(const std::vector<MaterialIndex>& of) {
    return of[static_cast<std::size_t>(dice_.Below(static_cast<int>(of.size())))];
  }

  Stage& stage_;
  Dice dice_;
  std::uint32_t next_ = 200;
  std::vector<MaterialIndex> skins_, hairs_, colors_;
  std::array<MaterialIndex, 2> teams_ = {}, keepers_ = {};
  MaterialIndex referee_ = 0;
};

}  // namespace

std::vector<Figure> DressPeople(const std::vector<FloorballGame::Person>& people,
                                std::uint64_t seed, Stage& stage) {
  Wardrobe wardrobe(stage, seed);
  std::vector<Figure> figures;
  for (const FloorballGame::Person& person : people) figures.push_back(wardrobe.Dress(person));
  return figures;
}

}  // namespace vantage::simulation
