// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vantage/geometry/polygon.h"
#include "vantage/metrics/clear_mot.h"

/// What `vantage evaluate tracks` tells, as tables, JSON and CSV.

namespace vantage::app {

struct TrackComparison {
  std::filesystem::path truth_file, results_file;
  bool boxes = false;
  EvaluationOptions options;
  std::optional<Polygon> area;
  TrackAnalysis analysis;
  std::vector<std::string> warnings, notes;  ///< each names its file
};

struct Measure {
  const char* name;
  std::string text;
  nlohmann::ordered_json value;
  std::string definition;
};

/// All measures, each with its definition.
std::vector<Measure> ListMeasures(const TrackComparison& comparison);

/// What makes a match, in words.
std::string MatchRule(const TrackComparison& comparison);
std::string AreaText(const TrackComparison& comparison);

/// A table of objects: cells under a header, and a line on each column that needs one.
struct ObjectTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};
ObjectTable TruthTable(const TrackAnalysis& analysis);
ObjectTable ResultTable(const TrackAnalysis& analysis);
/// Definitions of the columns of both.
std::vector<std::string> ObjectDefinitions(const TrackComparison& comparison);

void PrintTables(const TrackComparison& comparison, bool per_object);
void PrintJson(const TrackComparison& comparison, bool per_object);
std::string FrameCountsCsv(const TrackComparison& comparison);

}  // namespace vantage::app
