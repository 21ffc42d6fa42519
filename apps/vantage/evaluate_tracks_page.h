// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "evaluate_tracks_report.h"

namespace vantage::app {

/// A page that stands alone: all figures with their definitions, charts over time and over the
/// thresholds of HOTA, who was matched to whom when, and every track.
std::string TrackComparisonPage(const TrackComparison& comparison);

}  // namespace vantage::app
