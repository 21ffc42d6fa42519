// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vantage/experiments/experiment.h"

namespace vantage {

/// Extension of the area and visibility rules: the thesis's table 3 and figure 17 (floorball), and
/// its table 4 and figure 18 (PETS: simulated pictures, and boxes in the real views).
Experiment Table3Experiment();
Experiment Table4Experiment();

}  // namespace vantage
