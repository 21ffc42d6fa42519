// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/access.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace vantage {
namespace {

/// Seen, and beside something that nobody sees: there people come out of nowhere.
bool OnBorderOfSeen(const OccupancyMaps& maps, int column, int row) {
  const GroundGrid& grid = maps.grid;
  if (maps.visible[static_cast<std::size_t>(grid.Index(column, row))] == 0) return false;
  for (int y = row - 1; y <= row + 1; ++y) {
    for (int x = column - 1; x <= column + 1; ++x) {
      if (x < 0 || y < 0 || x >= grid.columns || y >= grid.rows) return true;
      if (maps.visible[static_cast<std::size_t>(grid.Index(x, y))] == 0) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::uint8_t> CellsIn(const GroundGrid& grid, std::span<const Polygon> polygons) {
  std::vector<std::uint8_t> cells(static_cast<std::size_t>(grid.count()), 0);
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    const Eigen::Vector2d center = grid.Center(cell);
    cells[static_cast<std::size_t>(cell)] =
        std::any_of(polygons.begin(), polygons.end(),
                    [&](const Polygon& polygon) { return polygon.Contains(center); });
  }
  return cells;
}

std::vector<std::uint8_t> AccessCells(const OccupancyMaps& maps, AccessRule rule,
                                      std::span<const Polygon> doors) {
  std::vector<std::uint8_t> access = CellsIn(maps.grid, doors);
  if (rule == AccessRule::kDoors) return access;
  for (int row = 0; row < maps.grid.rows; ++row) {
    for (int column = 0; column < maps.grid.columns; ++column) {
      if (rule == AccessRule::kAnywhere || OnBorderOfSeen(maps, column, row)) {
        access[static_cast<std::size_t>(maps.grid.Index(column, row))] = 1;
      }
    }
  }
  return access;
}

Result<std::vector<Polygon>> DoorsAndEntrances(const GroundGrid& grid,
                                               std::span<const Polygon> doors,
                                               std::span<const Eigen::Vector2d> entrances_m) {
  std::vector<Polygon> all(doors.begin(), doors.end());
  for (const Eigen::Vector2d& entrance : entrances_m) {
    const std::optional<CellIndex> cell = grid.CellAt(entrance);
    if (!cell) {
      return Fail(
          "area.entrances: ({}, {}) is outside the grid, which goes from ({}, {}) to ({}, {}) m",
          entrance.x(), entrance.y(), grid.min_x_m, grid.min_y_m,
          grid.min_x_m + grid.columns * grid.cell_m, grid.min_y_m + grid.rows * grid.cell_m);
    }
    const Eigen::Vector2d half = Eigen::Vector2d::Constant(grid.cell_m / 2);
    const Eigen::Vector2d center = grid.Center(*cell);
    VANTAGE_ASSIGN_OR_RETURN(Polygon square, Polygon::Rectangle(center - half, center + half));
    all.push_back(std::move(square));
  }
  return all;
}

}  // namespace vantage
