// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "vantage/simulation/presets.h"

namespace vantage::simulation {

/// A camera by name, delivering pictures of its own full size.
struct NamedCamera {
  std::string_view name;
  Camera camera;
};

/// The first options.cameras of them (all, if not given), their pictures scaled by options.scale
/// to even sides. Exposure and colour balance differ a little from camera to camera, as the seed
/// wants. Fails, naming the option and what `preset` has, when there are not so many.
Result<std::vector<StageCamera>> SetUpCameras(std::string_view preset,
                                              const std::vector<NamedCamera>& all,
                                              const PresetOptions& options, double exposure);

/// The eight cameras of PETS 2009, in the order view 1, 3, 4, 5, 6, 7, 8 (the seven that are
/// usually tracked with), 2.
std::vector<NamedCamera> CampusCameras();

/// The seven cameras of WILDTRACK without their distortion (the data set's intrinsic_zero), as for
/// full pictures of 1920 x 1080.
std::vector<NamedCamera> CrowdCameras();

}  // namespace vantage::simulation
