// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/simulation/faults.h"
#include "vantage/simulation/film.h"
#include "vantage/simulation/presets.h"

namespace vantage::simulation {

struct RecordOptions {
  std::string preset;
  PresetOptions stage;
  bool masks = true;  ///< whether the true masks are written
  std::vector<CameraFault> faults = {};
};

struct RecordReport {
  FilmReport film;
  FrameIndex frames = 0;
  int cameras = 0;
  int people = 0;  ///< different ones
  double encode_secs = 0;
  double total_secs = 0;
};

/// Writes a simulated recording into `folder`, which exists and is empty (a StagedDirectory's, so
/// that the recording appears whole or not at all):
///
///   scene.toml                     cameras with their calibration, area, frames per second
///   CAMERA.mp4                     H.264, one a camera
///   truth/tracks.csv               every person in every frame, inside the area or not, metres
///   truth/boxes/CAMERA.txt         MOTChallenge text: around all of a person that is in the
///                                  picture, hidden or not; columns 8 and 9 are x and y, metres
///   truth/visibility.csv           frame,camera,id,pixels,visible_pixels: how much of each person
///                                  is in the picture, and how much of that is not hidden
///   truth/masks/CAMERA/000000.png  masks of every frame, 0 and 255
///   simulation.json                preset, seed, options, version
///
/// Truth is that of the scene's frames, also where a camera's faults deliver other pictures. For
/// the same options truth and the pictures before encoding are the same for every thread count.
/// Fails as MakeStage does, on faults of a camera that there is not, on a camera that would
/// deliver nothing, and when a file cannot be written.
Result<RecordReport> RecordScene(const RecordOptions& options, const std::filesystem::path& folder,
                                 int threads, const RunControl& control = {});

}  // namespace vantage::simulation
