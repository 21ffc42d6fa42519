// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/simulation/stage.h"

namespace vantage::simulation {

/// What a preset may be asked for; each has defaults of its own for what is not given.
struct PresetOptions {
  std::uint64_t seed = 1;
  std::optional<FrameIndex> frames = std::nullopt;  ///< 1 to 100000
  std::optional<int> cameras = std::nullopt;  ///< the first so many, 1 to as many as the preset has
  double scale = 1;                           ///< of the pictures' sides, 0.1 to 2
  /// Truth of a real recording whose people walk here (campus: a MOTChallenge file with ground
  /// positions; crowd: a folder with annotations_positions/); empty: invented people.
  std::filesystem::path people = {};
};

struct Preset {
  std::string_view name;
  std::string_view summary;
};

/// All presets, in the order of the help.
const std::vector<Preset>& Presets();

/// Fails, naming option and remedy, on an unknown preset, options out of range, and a truth file
/// that is missing or broken.
Result<Stage> MakeStage(std::string_view preset, const PresetOptions& options);

/// 40 x 20 m of floorball, eight cameras high around it (floorball.cc).
Result<Stage> MakeFloorball(const PresetOptions& options);
/// PETS 2009 S2.L1 (campus.cc).
Result<Stage> MakeCampus(const PresetOptions& options);
/// WILDTRACK's square (crowd.cc).
Result<Stage> MakeCrowd(const PresetOptions& options);
/// One camera and everything that makes ghosts (ghosts_preset.cc).
Result<Stage> MakeGhosts(const PresetOptions& options);

}  // namespace vantage::simulation
