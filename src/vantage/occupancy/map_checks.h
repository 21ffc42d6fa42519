// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "vantage/base/result.h"
#include "vantage/occupancy/maps.h"

/// Internal to the occupancy module: what is asked of maps that are written or read.

namespace vantage {

/// Everything but the values; there is at least one cell.
Status CheckMapHeader(const std::filesystem::path& path, const OccupancyMaps& maps);

/// Values of whole maps of `cells` cells, `first_map` being the number of the first.
Status CheckMapValues(const std::filesystem::path& path, std::span<const float> values,
                      std::size_t cells, std::int64_t first_map);

}  // namespace vantage
