// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "vantage/background/disturbance.h"

namespace vantage {

/// What the background stage of one camera did so far.
struct BackgroundReport {
  std::int64_t rehearsed = 0;  ///< frames learnt ahead of the first
  std::int64_t frames = 0;
  std::int64_t ghost_frames = 0;  ///< frames in which ghosts were absorbed
  std::int64_t ghosts_px = 0;     ///< their pixels
  std::int64_t shadows_px = 0;    ///< taken out of masks
  std::int64_t unreliable = 0;    ///< frames whose mask a disturbance made unreliable
  DisturbanceReport disturbances;
  double method_secs = 0;
  double disturbance_secs = 0;
  double shadow_secs = 0;
  double ghost_secs = 0;
  double cleanup_secs = 0;
};

/// All of it, with a list of the events; frames count from the first that the stage was given.
nlohmann::ordered_json JsonOf(const BackgroundReport& report);

/// One line for people, e.g. "light changed, levels x 0.61: frame 620, 3 frames unreliable".
/// `first_frame` is the number of the stage's first frame.
std::string TextOf(const DisturbanceEvent& event, std::int64_t first_frame = 0);

}  // namespace vantage
