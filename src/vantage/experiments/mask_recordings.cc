// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/mask_recordings.h"

#include "vantage/experiments/recordings.h"
#include "vantage/experiments/track_recording.h"

namespace vantage {

Result<CellPtr> MaskRecording(const Study& study, const std::string& preset) {
  if (preset == "floorball") {
    VANTAGE_ASSIGN_OR_RETURN(const TrackRecording recording, FloorballRecording(study));
    return recording.made_by;
  }
  if (preset == "campus") {
    VANTAGE_ASSIGN_OR_RETURN(const TrackRecording recording, CampusRecording(study));
    return recording.made_by;
  }
  simulation::RecordOptions options;
  options.preset = preset;
  options.stage.scale = study.quick ? 0.3 : 1;
  if (preset == "ghosts") {
    // Until the car has driven off.
    options.stage.frames = study.quick ? 760 : 1200;
  } else {
    options.stage.frames = study.quick ? 40 : 200;
    options.stage.cameras = study.quick ? 1 : 3;
  }
  return SimulatedRecording(study, study.quick ? preset + "-quick" : preset, options);
}

std::string CellName(const std::string& text) {
  std::string name;
  for (const char c : text) {
    if (c >= 'A' && c <= 'Z') {
      name += static_cast<char>(c - 'A' + 'a');
    } else {
      name += c == ' ' ? '-' : c;
    }
  }
  return name;
}

}  // namespace vantage
