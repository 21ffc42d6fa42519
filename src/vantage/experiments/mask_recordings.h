// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "vantage/experiments/cell.h"
#include "vantage/experiments/experiment.h"

namespace vantage {

/// The simulated recording of a preset whose masks are looked at; that of the tracking experiments
/// where they have one.
Result<CellPtr> MaskRecording(const Study& study, const std::string& preset);

/// "office from 900" as the name of a cell has it: small letters, digits and '-'.
std::string CellName(const std::string& text);

}  // namespace vantage
