// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"

namespace vantage::simulation {

/// Something that goes wrong with what one camera delivers. Frames are those of the scene.
struct CameraFault {
  enum class Kind {
    kDrop,    ///< frames are missing: what follows moves up
    kFreeze,  ///< the picture before them is repeated
    kBlack,   ///< black pictures
    kDrift,   ///< the clock is wrong: from `first` on it shows `drift_per_s` frames more a second
  };
  Kind kind = Kind::kFreeze;
  int camera = 0;          ///< from 0
  FrameIndex first = 0;    ///< the first frame concerned
  FrameIndex count = 1;    ///< how many; not of kDrift
  double drift_per_s = 0;  ///< of kDrift: below 0 the camera falls behind
};

/// "drop:CAMERA:FIRST:COUNT", "freeze:CAMERA:FIRST:COUNT", "black:CAMERA:FIRST:COUNT" or
/// "drift:CAMERA:FIRST:FRAMES", frames a second between -10 and 10. Cameras count from 1 here, as
/// in their names; a picture must be before what is frozen, so FIRST is then at least 1.
Result<CameraFault> ParseCameraFault(std::string_view text);

/// The frame of the scene that each delivered picture of a camera shows, in order of delivery;
/// none: a black picture. Never decreases. At most `frames` pictures.
std::vector<std::optional<FrameIndex>> DeliveredFrames(FrameIndex frames, double frames_per_second,
                                                       int camera,
                                                       const std::vector<CameraFault>& faults);

}  // namespace vantage::simulation
