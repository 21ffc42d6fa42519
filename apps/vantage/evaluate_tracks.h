// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include "command.h"

namespace vantage::app {

/// Adds the flags of `vantage evaluate tracks` to its subcommand.
Action DefineEvaluateTracks(CLI::App& app);

}  // namespace vantage::app
