// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "vantage/experiments/cell.h"
#include "vantage/experiments/experiment.h"
#include "vantage/simulation/recording.h"

namespace vantage {

/// A cell that makes a simulated recording, as simulation::RecordScene lays it out, in data/NAME of
/// the working folder. Its result: frames, cameras, people, seconds. `frames` of the study bounds
/// the recording. Fails when the file of people cannot be read.
Result<CellPtr> SimulatedRecording(const Study& study, const std::string& name,
                                   simulation::RecordOptions options);

/// What real data are, for the inputs of cells: a file's size and SHA-256; of a folder, how
/// many files and bytes are in it. Fails when there is nothing or it cannot be read.
Result<nlohmann::ordered_json> DescribeData(const std::filesystem::path& path);

}  // namespace vantage
