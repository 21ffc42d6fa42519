// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "vantage/experiments/ghost_experiment.h"
#include "vantage/experiments/report_page.h"

namespace vantage {

/// What the thesis found (section 3.5) and what these results say to it.
struct GhostFinding {
  std::string thesis;
  std::string here;
  bool holds = false;
};

/// F1 that differs by no more is about the same.
constexpr double kSameF1 = 0.02;

/// Those findings that the results have runs for: gains in F1 over no ghost detection, means over
/// cases, colours, rates and alphas.
std::vector<GhostFinding> GhostFindings(const GhostResults& results);

/// Their table on the page; nothing where there is none.
void AddFindings(const GhostResults& results, ReportPage& page);

}  // namespace vantage
