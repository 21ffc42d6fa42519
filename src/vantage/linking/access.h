// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/geometry/polygon.h"
#include "vantage/linking/linker.h"
#include "vantage/occupancy/maps.h"

namespace vantage {

/// Per cell, non-zero where people may appear and vanish: the cells that `rule` names, and those
/// with their centre in a door.
std::vector<std::uint8_t> AccessCells(const OccupancyMaps& maps, AccessRule rule,
                                      std::span<const Polygon> doors);

/// The doors, and for each of the points the square of the cell that it lies in: another door.
/// Fails when a point lies outside the grid.
Result<std::vector<Polygon>> DoorsAndEntrances(const GroundGrid& grid,
                                               std::span<const Polygon> doors,
                                               std::span<const Eigen::Vector2d> entrances_m);

/// Per cell, non-zero where the cell's centre is in one of the polygons.
std::vector<std::uint8_t> CellsIn(const GroundGrid& grid, std::span<const Polygon> polygons);

}  // namespace vantage
