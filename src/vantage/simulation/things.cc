// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/things.h"

#include "vantage/simulation/wardrobe.h"

namespace vantage::simulation {

void AddTrees(Stage& stage, Rehearsal& rehearsal, const std::vector<Eigen::Vector2f>& places_m,
              double low_m, double high_m, int clusters, Dice& dice) {
  const MaterialIndex bark = AddMaterial(stage.materials, {.pattern = Material::Pattern::kSpeckle,
                                                           .color = {0.10F, 0.075F, 0.05F},
                                                           .second = {0.05F, 0.04F, 0.03F},
                                                           .scale_m = 0.1F,
                                                           .seed = dice.Seed()});
  std::vector<MaterialIndex> leaves;
  for (const float shade : {1.0F, 0.7F, 1.35F}) {
    leaves.push_back(
        AddMaterial(stage.materials, {.pattern = Material::Pattern::kGrass,
                                      .color = shade * Eigen::Vector3f(0.09F, 0.15F, 0.03F),
                                      .second = shade * Eigen::Vector3f(0.03F, 0.06F, 0.01F),
                                      .scale_m = 0.15F,
                                      .seed = dice.Seed()}));
  }
  for (const Eigen::Vector2f& place : places_m) {
    const double height_m = dice.Uniform(low_m, high_m);
    const Tree tree = Plant(place, height_m, clusters, bark, leaves, dice);
    Build(stage, tree.wood);
    rehearsal.scenery.push_back(
        {kFirstThingId + static_cast<int>(rehearsal.scenery.size()), tree.foliage});
  }
}

void AddWalkers(Stage& stage, Rehearsal& rehearsal, const std::vector<NumberedWalk>& people,
                Dice& dice) {
  for (const NumberedWalk& person : people) {
    const Figure figure = DressUp(stage.materials, dice);
    rehearsal.actors.push_back(
        {person.id, figure, person.walk.first,
         Postures(person.walk, rehearsal.frames_per_second, figure.height_m)});
  }
}

}  // namespace vantage::simulation
