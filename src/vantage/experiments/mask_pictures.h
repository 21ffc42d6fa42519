// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vantage/experiments/experiment.h"

namespace vantage {

/// Figure 1, how the background comes about at either learning rate; figures 5 to 7, masks of every
/// criterion as pictures: a simulated parked car and all that leaves ghosts, simulated floorball
/// begun in its middle, and PETS 2009 View_001 (the real video where it is to be had) begun with
/// its first picture as background.
std::vector<Experiment> MaskPictureExperiments();

}  // namespace vantage
