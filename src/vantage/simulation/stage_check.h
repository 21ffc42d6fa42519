// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/simulation/stage.h"

/// Internal to the simulation module: what a stage must be before rays are sent into it.

namespace vantage::simulation::internal {

/// Fails when an index of a material is out of range, a number is not finite or absurd, or there is
/// no camera or no script.
Status CheckStage(const Stage& stage);

/// The same for what a script gives at a frame.
Status CheckThings(const Stage& stage, FrameIndex frame, std::span<const Thing> things);
Status CheckGains(const Stage& stage, FrameIndex frame, std::span<const float> gains);

}  // namespace vantage::simulation::internal
