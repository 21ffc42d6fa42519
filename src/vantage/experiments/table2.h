// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vantage/experiments/experiment.h"

namespace vantage {

/// Ghost detection and the whole tracker (the thesis's table 2).
Experiment Table2Experiment();

}  // namespace vantage
