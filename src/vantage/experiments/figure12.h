// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "vantage/experiments/experiment.h"

namespace vantage {

/// The system's stages (the thesis's figure 12), with their own pictures of one frame and their
/// share of the time.
Experiment Figure12Experiment();

/// The diagram as SVG, from the result of the experiment's cell.
std::string StagesSvg(const nlohmann::ordered_json& result);

}  // namespace vantage
