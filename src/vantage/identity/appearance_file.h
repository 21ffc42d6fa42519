// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "vantage/base/result.h"
#include "vantage/identity/appearance.h"
#include "vantage/occupancy/maps.h"

/// Colours of people beside the maps that show them (occupancy/map_file.h), so that whoever links
/// the maps later can tell people apart, too. A group /appearances with one entry for each
/// Appearance, in compressed chunks:
///   frame  [entry] int64, cell [entry] int32, camera [entry] int32
///   colors [entry, 18] float, as BandColors

namespace vantage {

/// Adds colours to a file of maps; none add nothing. Fails when the file is not one of maps or has
/// colours, on colours that ReadAppearances would refuse, and when it cannot be written: then the
/// file may be of no use any more, so give it a temporary (StagedFile).
Status AddAppearances(const std::filesystem::path& maps_file, const Appearances& appearances);

/// Reads the colours beside `maps`, which were read from the same file; empty when it has none
/// (files of older versions and of other programs). Fails on a group that lacks a part, has parts
/// of another rank, type or size or that store less than they declare, and on frames that do not
/// ascend or have no map, cells outside the grid, cameras outside 0 to 10,000, and colours that are
/// neither NaN nor between 0 and 255.
Result<Appearances> ReadAppearances(const std::filesystem::path& maps_file,
                                    const OccupancyMaps& maps);

}  // namespace vantage
