// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vantage/experiments/cell.h"
#include "vantage/experiments/experiment.h"
#include "vantage/experiments/ghost_experiment.h"

/// The ghost experiment as cells: one for each case and rule, with all settings of the rule.

namespace vantage {

struct GhostPlan {
  std::vector<GhostVariant> variants;
  std::vector<GhostCase> cases = {};      ///< those that can be run
  std::vector<std::string> skipped = {};  ///< the others and why, one line each
  std::vector<CellPtr> cells = {};        ///< case by case, rule by rule
};

/// Of the standard cases those that are `wanted`. Real sequences must be in the study's data
/// folder; the others are simulated.
Result<GhostPlan> PlanGhosts(const Study& study,
                             const std::function<bool(const GhostCase&)>& wanted);

/// What the cells found. Fails on results that are not of these cells.
Result<GhostResults> GhostResultsOf(const GhostPlan& plan, const CellResults& results);

/// Figures 8 to 11, and "ghosts": all cases in detail, beside OpenCV's methods and the rival, and
/// the default settings on the simulated presets.
std::vector<Experiment> GhostExperiments();

}  // namespace vantage
