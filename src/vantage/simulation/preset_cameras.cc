// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/preset_cameras.h"

#include <algorithm>
#include <cmath>

#include "vantage/simulation/dice.h"

namespace vantage::simulation {

Result<std::vector<StageCamera>> SetUpCameras(std::string_view preset,
                                              const std::vector<NamedCamera>& all,
                                              const PresetOptions& options, double exposure) {
  const int available = static_cast<int>(all.size());
  const int count = options.cameras.value_or(available);
  if (count < 1 || count > available) {
    return Fail("cameras is {}; {} has {}: ask for 1 to {}", count, preset, available, available);
  }
  Dice dice(~options.seed);  // apart from what happens before them
  std::vector<StageCamera> cameras;
  for (int i = 0; i < count; ++i) {
    const NamedCamera& named = all[static_cast<std::size_t>(i)];
    const auto scaled = [&](int side) {
      return std::max(2, 2 * static_cast<int>(std::lround(0.5 * options.scale * side)));
    };
    VANTAGE_ASSIGN_OR_RETURN(const Camera camera,
                             named.camera.Scaled({scaled(named.camera.size().width),
                                                  scaled(named.camera.size().height)}));
    StageCamera stage{.name = std::string(named.name), .camera = camera};
    stage.exposure = exposure * dice.Uniform(0.88, 1.12);
    stage.balance = {static_cast<float>(dice.Uniform(0.93, 1.07)), 1,
                     static_cast<float>(dice.Uniform(0.9, 1.1))};
    stage.noise = dice.Uniform(0.006, 0.012);
    stage.vignetting = dice.Uniform(0.08, 0.22);
    cameras.push_back(stage);
  }
  return cameras;
}

}  // namespace vantage::simulation
