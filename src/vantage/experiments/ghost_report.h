// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "vantage/base/result.h"
#include "vantage/experiments/ghost_experiment.h"

/// What is written of a ghost experiment (FORMATS.md). Nothing here fails on results without runs
/// of some variants: their cells stay empty.

namespace vantage {

/// ghosts.csv: one line for each run.
std::string GhostCsv(const GhostResults& results);

/// ghosts_frames.csv: counts of every frame that counts, for the runs that the page's lines show:
/// none, fep-plain and the default, at the default colour and rate, for each alpha.
std::string GhostFramesCsv(const GhostResults& results);

/// ghosts.json: version, defaults, what was skipped, and every run's figures.
nlohmann::ordered_json GhostJson(const GhostResults& results);

/// ghosts.html: the page with plots and tables.
std::string GhostPage(const GhostResults& results);

/// The four files into `folder`, which exists.
Status WriteGhostReport(const GhostResults& results, const std::filesystem::path& folder);

/// Names of what a variant does, empty where it does not apply: OpenCV's methods have no colour
/// space, "none" has no threshold.
struct VariantText {
  std::string method, criterion, judgement, threshold, color, rate, alpha;
};
VariantText TextOf(const GhostVariant& variant);

/// Values of alpha among the variants of the mixture, in their order.
std::vector<double> AlphasOf(const GhostResults& results);

}  // namespace vantage
