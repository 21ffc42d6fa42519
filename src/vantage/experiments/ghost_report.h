// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "vantage/experiments/experiment.h"
#include "vantage/experiments/ghost_experiment.h"
#include "vantage/experiments/report_page.h"

/// What is written of a ghost experiment (FORMATS.md). Nothing here fails on results without runs
/// of some variants: their cells stay empty.

namespace vantage {

/// ghosts.csv: one line for each run.
std::string GhostCsv(const GhostResults& results);

/// ghosts_frames.csv: counts of every frame that counts, for the runs that the page's lines show:
/// none, fep-plain and the default, at the default colour and rate, for each alpha.
std::string GhostFramesCsv(const GhostResults& results);

/// The thesis's figure 8, 9, 10 or 11: bars of recall, precision and F1, means over the figure's
/// cases, for each rule, and their table; real and simulated data apart but for figure 11. The bars
/// go to `figures`, too.
void AddGhostFigure(const GhostResults& results, int figure, ReportPage& page,
                    std::vector<Figure>& figures);

/// All else: ours beside OpenCV's methods, what the default does, each case with its lines and
/// tables, the time, the options.
void AddGhostDetails(const GhostResults& results, ReportPage& page);

/// Names of what a variant does, empty where it does not apply: OpenCV's methods have no colour
/// space, "none" has no threshold.
struct VariantText {
  std::string method, criterion, judgement, threshold, color, rate, alpha;
};
VariantText TextOf(const GhostVariant& variant);

/// Values of alpha among the variants of the mixture, in their order.
std::vector<double> AlphasOf(const GhostResults& results);

}  // namespace vantage
