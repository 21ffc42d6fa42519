// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vantage/experiments/experiment.h"
#include "vantage/experiments/report_page.h"
#include "vantage/experiments/track_recording.h"

/// Tables and findings of experiments on tracks.

namespace vantage {

/// A row of the thesis's tables 2 to 4.
struct ThesisTracks {
  double mota, motp;
  int misses, false_positives, switches;
};

/// A result of TrackCell and what the thesis has in its place.
struct TrackRow {
  std::string name;
  nlohmann::ordered_json result;
  std::optional<ThesisTracks> thesis = std::nullopt;
};

/// How far the thesis's figures can be compared.
struct ThesisUnits {
  bool metres = true;  ///< its MOTP is in metres (of PETS it is not)
  bool counts = true;  ///< its truth has about as many positions, so that counts compare
};

/// A table of the measures with the thesis's beside them, and a line in figures.csv for each.
/// `which` is "every" or "sparse" (TrackCell). Data and whether they are simulated stand above.
void AddTrackTable(const TrackRecording& recording, const std::vector<TrackRow>& rows,
                   const std::string& which, const ThesisUnits& units, ReportPage& page,
                   ExperimentReport& report);

/// MOTA at every frame; NaN for none.
double MotaOf(const nlohmann::ordered_json& result);

/// MOTA that differs by no more is about the same.
inline constexpr double kSameMota = 0.005;

/// "The thesis says that this is better": holds beyond kSameMota, not decided within it.
Verdict VerdictOfGain(double gain);
/// "Both of these": the worse of two verdicts.
Verdict Both(Verdict a, Verdict b);

/// E.g. "0.9012 against 0.8893 (+0.0119)".
std::string Comparison(double value, double other);

/// Whether the default settings reach what the project set itself beside the thesis's best.
Finding GoalFinding(const TrackRecording& recording, const nlohmann::ordered_json& result,
                    double goal_mota, double thesis_mota);

}  // namespace vantage
