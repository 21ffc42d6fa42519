// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <utility>

#include "vantage/experiments/area_tables.h"
#include "vantage/experiments/experiment.h"
#include "vantage/experiments/figure12.h"
#include "vantage/experiments/figure16.h"
#include "vantage/experiments/ghost_cells.h"
#include "vantage/experiments/map_figures.h"
#include "vantage/experiments/mask_pictures.h"
#include "vantage/experiments/table2.h"

namespace vantage {

const std::vector<Experiment>& Experiments() {
  static const std::vector<Experiment> experiments = [] {
    std::vector<Experiment> all = MaskPictureExperiments();
    for (Experiment& one : GhostExperiments()) all.push_back(std::move(one));
    for (Experiment& one : std::vector<Experiment>{Table2Experiment(), Table3Experiment(),
                                                   Table4Experiment(), Figure12Experiment(),
                                                   MapFiguresExperiment(), Figure16Experiment()}) {
      all.push_back(std::move(one));
    }
    return all;
  }();
  return experiments;
}

}  // namespace vantage
