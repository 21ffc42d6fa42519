// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/wardrobe.h"

#include <array>

namespace vantage::simulation {
namespace {

using Color = Eigen::Vector3f;
using Pattern = Material::Pattern;

constexpr std::array<std::array<float, 3>, 5> kSkins = {{{0.56F, 0.36F, 0.26F},
                                                         {0.48F, 0.29F, 0.20F},
                                                         {0.36F, 0.21F, 0.13F},
                                                         {0.22F, 0.12F, 0.08F},
                                                         {0.60F, 0.41F, 0.32F}}};
constexpr std::array<std::array<float, 3>, 5> kHairs = {{{0.02F, 0.015F, 0.01F},
                                                         {0.07F, 0.04F, 0.02F},
                                                         {0.22F, 0.14F, 0.06F},
                                                         {0.30F, 0.29F, 0.28F},
                                                         {0.14F, 0.05F, 0.02F}}};
// Coats and pullovers as in a street of the cold half of the year.
constexpr std::array<std::array<float, 3>, 8> kDark = {{{0.012F, 0.012F, 0.014F},
                                                        {0.02F, 0.025F, 0.05F},
                                                        {0.05F, 0.05F, 0.055F},
                                                        {0.06F, 0.04F, 0.03F},
                                                        {0.03F, 0.045F, 0.03F},
                                                        {0.09F, 0.015F, 0.02F},
                                                        {0.10F, 0.09F, 0.08F},
                                                        {0.03F, 0.03F, 0.08F}}};
constexpr std::array<std::array<float, 3>, 9> kBright = {{{0.62F, 0.62F, 0.60F},
                                                          {0.50F, 0.05F, 0.05F},
                                                          {0.08F, 0.20F, 0.48F},
                                                          {0.55F, 0.42F, 0.08F},
                                                          {0.10F, 0.32F, 0.14F},
                                                          {0.42F, 0.40F, 0.36F},
                                                          {0.30F, 0.10F, 0.34F},
                                                          {0.55F, 0.25F, 0.28F},
                                                          {0.20F, 0.38F, 0.45F}}};
constexpr std::array<std::array<float, 3>, 6> kTrousers = {{{0.025F, 0.04F, 0.09F},
                                                            {0.05F, 0.08F, 0.16F},
                                                            {0.012F, 0.012F, 0.014F},
                                                            {0.28F, 0.22F, 0.14F},
                                                            {0.08F, 0.08F, 0.085F},
                                                            {0.13F, 0.10F, 0.07F}}};

template <std::size_t kCount>
Color Pick(const std::array<std::array<float, 3>, kCount>& colors, Dice& dice) {
  const auto& color = colors[static_cast<std::size_t>(dice.Below(static_cast<int>(kCount)))];
  const auto shade = static_cast<float>(dice.Uniform(0.85, 1.15));
  return shade * Color(color[0], color[1], color[2]);
}

Material Plain(const Color& color) { return {.color = color, .second = color}; }

/// Cloth: slight noise, so that it is never one colour.
Material Cloth(const Color& color, Dice& dice) {
  return {.pattern = Pattern::kSpeckle,
          .color = color,
          .second = 0.7F * color,
          .scale_m = 0.07F,
          .seed = dice.Seed()};
}

Material Shirt(Dice& dice) {
  Material shirt = Cloth(Pick(kBright, dice), dice);
  const double kind = dice.Uniform(0, 1);
  if (kind < 0.35) return shirt;
  if (kind < 0.6) {
    shirt.pattern = Pattern::kStripes;
    shirt.scale_m = static_cast<float>(dice.Uniform(0.025, 0.08));
  } else if (kind < 0.85) {
    shirt.pattern = Pattern::kPlaid;
    shirt.scale_m = static_cast<float>(dice.Uniform(0.04, 0.1));
  } else {
    shirt.pattern = Pattern::kLetters;
    shirt.scale_m = 0.1F;
  }
  shirt.second = dice.Chance(0.5) ? Pick(kDark, dice) : Pick(kBright, dice);
  return shirt;
}

}  // namespace

MaterialIndex AddMaterial(std::vector<Material>& materials, const Material& material) {
  materials.push_back(material);
  return static_cast<MaterialIndex>(materials.size()) - 1;
}

Figure DressUp(std::vector<Material>& materials, Dice& dice) {
  const auto add = [&](const Material& material) { return AddMaterial(materials, material); };
  Figure figure;
  figure.height_m = dice.Uniform(1.58, 1.92);
  figure.build = dice.Uniform(0.88, 1.18);
  figure.skin = add(Plain(Pick(kSkins, dice)));
  figure.hair = add(Plain(Pick(kHairs, dice)));
  const bool coat = dice.Chance(0.5);
  figure.shirt = add(coat ? Cloth(Pick(kDark, dice), dice) : Shirt(dice));
  figure.sleeves = figure.shirt;
  figure.long_sleeves = coat || dice.Chance(0.7);
  figure.shorts = add(Cloth(Pick(kTrousers, dice), dice));
  const bool bare_legs = !coat && dice.Chance(0.15);
  figure.legs = bare_legs ? figure.skin : figure.shorts;
  figure.shoes = add(Plain(dice.Chance(0.3) ? Pick(kBright, dice) : Pick(kDark, dice)));
  return figure;
}

}  // namespace vantage::simulation
