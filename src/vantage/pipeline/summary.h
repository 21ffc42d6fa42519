// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/pipeline/track.h"

namespace vantage {

/// What was asked for, for the record of a run.
struct RunRequest {
  std::vector<std::string> arguments;  ///< as typed, without the program's name
  std::filesystem::path scene;
  std::filesystem::path data;  ///< empty: paths are relative to the scene file
  int threads = 1;
};

/// How far the grid goes beyond each side of the area and why, as in summary.json (FORMATS.md).
nlohmann::ordered_json JsonOf(const ExtensionReport& report, const Scene& scene);

/// The record of a run (summary.json): version, what was asked for, SHA-256 of every input file,
/// options of every stage as used, counts, and seconds and frames per second of every stage.
Result<nlohmann::ordered_json> Summarize(const RunRequest& request, const Scene& scene,
                                         const StageOptions& options, const TrackingResult& result);

}  // namespace vantage
