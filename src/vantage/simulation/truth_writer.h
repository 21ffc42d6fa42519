// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <set>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/simulation/film.h"
#include "vantage/simulation/stage.h"
#include "vantage/tracks/track_file.h"
#include "vantage/video/mask_writer.h"

namespace vantage::simulation {

/// Writes what is true of a recording, frame by frame; the files are named in recording.h.
class TruthWriter {
 public:
  static Result<TruthWriter> Create(const Stage& stage, bool masks,
                                    const std::filesystem::path& folder);

  /// Frames in order; `shots` are one a camera.
  Status Write(FrameIndex frame, const std::vector<Thing>& things, const std::vector<Shot>& shots);

  /// To be called once, at the end.
  Status Finish();

  /// Different people so far.
  int people() const { return static_cast<int>(people_.size()); }

 private:
  TruthWriter(TrackWriter tracks, std::filesystem::path folder)
      : tracks_(std::move(tracks)), folder_(std::move(folder)) {}

  TrackWriter tracks_;
  std::filesystem::path folder_;
  std::vector<std::string> cameras_;
  std::ofstream visibility_;
  std::vector<std::ofstream> boxes_;  // one a camera
  std::vector<MaskWriter> masks_;     // one a camera, or none
  std::set<int> people_;
};

}  // namespace vantage::simulation
