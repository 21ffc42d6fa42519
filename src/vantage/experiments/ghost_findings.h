// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vantage/experiments/experiment.h"
#include "vantage/experiments/ghost_experiment.h"

namespace vantage {

/// F1 that differs by no more is about the same.
constexpr double kSameF1 = 0.02;

/// What the thesis found about masks (sections 3.2 and 3.5) in its figure 8, 9, 10 or 11, or, for
/// 0, over all of its sequences, and what these results say to it: one finding for each kind of
/// data and judgement (plain, as in the thesis, and ours) that was run. Gains in F1 over no ghost
/// detection, means over cases, colours, rates and alphas. The parking car of figure 5 is something
/// that had become background and moves away, as the cases of figure 8 are.
std::vector<Finding> GhostFindings(const GhostResults& results, int figure);

}  // namespace vantage
