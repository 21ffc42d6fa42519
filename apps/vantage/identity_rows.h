// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "command.h"
#include "vantage/identity/identify.h"

namespace vantage::app {

/// What people's colours decided, for a command's table; no row where no colours were seen.
std::vector<ReportRow> IdentityRows(const IdentityReport& report);

}  // namespace vantage::app
