// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/presets.h"

#include <array>

namespace vantage::simulation {
namespace {

struct Maker {
  Preset preset;
  Result<Stage> (*make)(const PresetOptions&);
};

constexpr std::array<Maker, 4> kMakers = {{
    {{"floorball", "40 x 20 m, 12 players on it and their benches, 8 cameras, 960 x 768, 20 /s"},
     MakeFloorball},
    {{"campus", "after PETS 2009 S2.L1: a road, a lamp post, its 8 cameras, 7 /s"}, MakeCampus},
    {{"crowd", "after WILDTRACK: a square full of people, its 7 cameras, 960 x 540, 10 /s"},
     MakeCrowd},
    {{"ghosts", "one camera; people and things that stay, leave and come back"}, MakeGhosts},
}};

}  // namespace

const std::vector<Preset>& Presets() {
  static const std::vector<Preset> presets = [] {
    std::vector<Preset> all;
    for (const Maker& maker : kMakers) all.push_back(maker.preset);
    return all;
  }();
  return presets;
}

Result<Stage> MakeStage(std::string_view preset, const PresetOptions& options) {
  if (options.frames && (*options.frames < 1 || *options.frames > 100000)) {
    return Fail("frames is {}; it must be between 1 and 100000", *options.frames);
  }
  if (!(options.scale >= 0.1 && options.scale <= 2)) {
    return Fail("scale is {}; it must be between 0.1 and 2", options.scale);
  }
  std::string names;
  for (const Maker& maker : kMakers) {
    if (maker.preset.name == preset) return maker.make(options);
    names += (names.empty() ? "" : ", ") + std::string(maker.preset.name);
  }
  return Fail("{}: no such preset; there are {}", preset, names);
}

}  // namespace vantage::simulation
