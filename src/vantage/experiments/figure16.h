// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vantage/experiments/experiment.h"

namespace vantage {

/// The size of cells (the thesis's figure 16).
Experiment Figure16Experiment();

}  // namespace vantage
