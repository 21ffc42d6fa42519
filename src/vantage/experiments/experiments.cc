// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/experiment.h"
#include "vantage/experiments/ghosts_cell.h"

namespace vantage {

const std::vector<Experiment>& Experiments() {
  static const std::vector<Experiment> experiments = {GhostsExperiment()};
  return experiments;
}

}  // namespace vantage
