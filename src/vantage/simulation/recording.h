// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/simulation/film.h"
#include "vantage/simulation/presets.h"

namespace vantage::simulation {

/// Something that goes wrong with one camera's delivery. Frames are those of the scene.
struct CameraFault {
  enum class Kind {
    kDrop,    ///< the frames are missing: what follows moves up
    kFreeze,  ///< the picture before them is repeated
    kBlack,   ///< black pictures
    kDrift,   ///< the clock runs wrong: `drift` frames more (or fewer) a second from first on
  };
  Kind kind = Kind::kFreeze;
  int camera = 0;        ///< from 0
  FrameIndex first = 0;  ///< the first frame concerned
  FrameIndex count = 1;  ///< at least 1; not used by kDrift
  double drift = 0;      ///< frames a second, -1 to 1
};

/// Parses "drop:CAMERA:FIRST:COUNT", "freeze:...", "black:...", "drift:CAMERA:FIRST:FRAMES_A_SEC";
/// cameras count from 1 here, as their names do.
Result<CameraFault> ParseCameraFault(std::string_view text);

struct RecordOptions {
  std::string preset;
  PresetOptions stage;
  bool masks = true;  ///< write the true masks
  std::vector<CameraFault> faults;
};

struct RecordReport {
  FilmReport film;
  FrameIndex frames = 0;
  int cameras = 0;
  int people = 0;
  double encode_secs = 0;
  double total_secs = 0;
};

/// Writes a simulated recording into `folder`:
///   scene.toml                      cameras with calibration, area, frames per second
///   camera1.mp4 ...                 H.264
///   truth/tracks.csv                frame,id,x,y of every person in every frame, inside the area
///   or not truth/boxes/camera1.txt ...     MOTChallenge truth:
///   frame,id,left,top,width,height,1,1,visibility truth/masks/camera1/masks.mkv   exact masks
///   (lossless video), PNG where sides are odd simulation.json                 preset, seed,
///   options, version
/// Tracks and boxes are the same files for the same options whatever the thread count; so are the
/// pictures before encoding. `folder` is a StagedDirectory's: the caller commits it.
Result<RecordReport> RecordScene(const RecordOptions& options, const std::filesystem::path& folder,
                                 int threads, const RunControl& control = {});

}  // namespace vantage::simulation
