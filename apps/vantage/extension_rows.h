// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "command.h"
#include "vantage/occupancy/extension.h"
#include "vantage/scene/scene.h"

namespace vantage::app {

/// How far the grid goes beyond each side of the area, and why, for a command's table.
std::vector<ReportRow> ExtensionRows(const ExtensionReport& report, const Scene& scene);

}  // namespace vantage::app
