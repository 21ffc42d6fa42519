// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "vantage/base/result.h"
#include "vantage/occupancy/maps.h"

/// Occupancy maps as an HDF5 file:
///   /occupancy [frame, row, column] float, one compressed chunk a frame, with the attributes
///       min_x_m, min_y_m, cell_m (double), frames_per_second (double), first_frame (int64)
///   /in_area, /visible [row, column] uint8, 0 or 1

namespace vantage {

/// Writes the maps whole or not at all. Fails when the maps are inconsistent (sizes that do not fit
/// each other, values outside [0, 1]) or the file cannot be written.
Status WriteMaps(const std::filesystem::path& path, const OccupancyMaps& maps);

/// Reads maps. Fails on files that are not HDF5, are truncated, lack a part, have parts of another
/// rank, type or size than above or that store less than they declare, and on values outside [0,
/// 1]. MapReader reads the same piece by piece.
Result<OccupancyMaps> ReadMaps(const std::filesystem::path& path);

}  // namespace vantage
