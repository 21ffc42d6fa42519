// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "command.h"
#include "vantage/pipeline/track.h"
#include "vantage/scene/scene.h"

namespace vantage::app {

/// A scene with the options of all stages: the defaults, then what the scene's tables say, then the
/// flags given on the command line.
struct SceneSetup {
  Scene scene;
  StageOptions options;
  std::filesystem::path data;  ///< empty: paths are relative to the scene file
};

/// The flags of the commands that work on a scene.
class SceneFlags {
 public:
  /// Flags of every stage, each prefixed by its stage's name. Returns the option of the scene file,
  /// which the command may require.
  CLI::Option* DefineForTracking(CLI::App& app);
  /// Flags up to the occupancy maps; those of the occupancy stage itself have no prefix.
  CLI::Option* DefineForOccupancy(CLI::App& app);
  bool given() const { return !scene_.empty(); }
  Result<SceneSetup> Load() const;

 private:
  CLI::Option* DefineUpToOccupancy(CLI::App& app, const std::string& occupancy_prefix);
  std::string scene_, data_;
  OptionFlags grid_, person_, background_, hold_, occupancy_, linking_, identity_, tracks_;
};

}  // namespace vantage::app
