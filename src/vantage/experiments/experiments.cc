// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/area_tables.h"
#include "vantage/experiments/experiment.h"
#include "vantage/experiments/figure12.h"
#include "vantage/experiments/figure16.h"
#include "vantage/experiments/ghosts_cell.h"
#include "vantage/experiments/map_figures.h"
#include "vantage/experiments/table2.h"

namespace vantage {

const std::vector<Experiment>& Experiments() {
  static const std::vector<Experiment> experiments = {
      GhostsExperiment(),   Table2Experiment(),     Table3Experiment(),  Table4Experiment(),
      Figure12Experiment(), MapFiguresExperiment(), Figure16Experiment()};
  return experiments;
}

}  // namespace vantage
