// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vantage/experiments/cell.h"
#include "vantage/experiments/experiment.h"
#include "vantage/scene/scene.h"
#include "vantage/tracks/track.h"

namespace vantage {

/// A recording of several cameras whose people's true positions are known.
struct TrackRecording {
  std::string name;   ///< for cells: "floorball"
  std::string title;  ///< for readers: where it is from, real or simulated, how large
  bool simulated = false;
  CellPtr made_by = nullptr;  ///< none: real
  nlohmann::ordered_json inputs =
      nlohmann::ordered_json::object();  ///< of real ones: what they are
  /// The scene, in a working folder that holds the recording.
  std::function<Result<Scene>(const std::filesystem::path& folder)> scene = {};
  std::filesystem::path truth = {};                 ///< relative to the working folder
  std::optional<FrameIndex> frames = std::nullopt;  ///< the first so many; none: all
  double picture_scale = 1;  ///< sides of its pictures, of those of the full recording
  /// The thesis's truth of floorball is of every 40th frame: measured besides every frame.
  FrameIndex sparse_truth = 1;

  /// Cells that must have run before this recording is used.
  std::vector<CellPtr> Needs() const;
  /// The true positions in the frames that are used, of every `every`-th frame.
  Result<Tracks> Truth(const std::filesystem::path& folder, FrameIndex every = 1) const;
};

/// The preset floorball: 8 cameras, 1000 frames; quick: 4 small ones, 80 frames.
Result<TrackRecording> FloorballRecording(const Study& study);

/// The preset campus in 7 views, 795 frames, with PETS's own people where the data folder has them;
/// quick: 4 small views, 60 frames.
Result<TrackRecording> CampusRecording(const Study& study);

/// Real: the video of PETS 2009 S2.L1, View_001, alone, DATA/pets2009/vtest.avi or that of Debian's
/// package opencv-doc, with DATA/pets2009/gt-mot15-3d.txt; quick: 100 frames. None, and a line in
/// `skipped`, when they are not there.
Result<std::optional<TrackRecording>> PetsVideoRecording(const Study& study,
                                                         std::vector<std::string>& skipped);

/// Real: a detector's boxes in seven views of PETS 2009 S2.L1 (DATA/pets2009/detections), drawn
/// filled as masks; quick: 100 frames. None, and a line in `skipped`, when they are not there.
Result<std::optional<TrackRecording>> PetsBoxesRecording(const Study& study,
                                                         std::vector<std::string>& skipped);

}  // namespace vantage
