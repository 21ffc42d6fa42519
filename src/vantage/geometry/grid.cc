// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/geometry/grid.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {
constexpr double kMaxCells = 4e6;
}

Result<GroundGrid> GroundGrid::Cover(const Polygon& area, double cell_m,
                                     const Extension& extension) {
  if (!std::isfinite(cell_m) || cell_m <= 0) {
    return Fail("grid: the cell is {} m; it must be above 0 m", cell_m);
  }
  for (const double side_m :
       {extension.min_x_m, extension.max_x_m, extension.min_y_m, extension.max_y_m}) {
    if (!std::isfinite(side_m) || side_m < 0) {
      return Fail("grid: the extension is {} m; it must be at least 0 m", side_m);
    }
  }
  const Eigen::Vector2d side_m = area.max_m() - area.min_m();
  // The slack: 20 m in cells of 0.1 m are 200 cells and not 201.
  const auto cells = [&](double length_m) { return std::ceil(length_m / cell_m - 1e-9); };
  const double left = cells(extension.min_x_m);
  const double below = cells(extension.min_y_m);
  const double columns = left + std::max(cells(side_m.x()), 1.0) + cells(extension.max_x_m);
  const double rows = below + std::max(cells(side_m.y()), 1.0) + cells(extension.max_y_m);
  if (columns * rows > kMaxCells) {
    return Fail(
        "grid: {:.6g} x {:.6g} cells of {} m are more than 4 million; use larger cells or a "
        "smaller area",
        columns, rows, cell_m);
  }
  return GroundGrid{.min_x_m = area.min_m().x() - left * cell_m,
                    .min_y_m = area.min_m().y() - below * cell_m,
                    .cell_m = cell_m,
                    .columns = static_cast<int>(columns),
                    .rows = static_cast<int>(rows)};
}

std::optional<CellIndex> GroundGrid::CellAt(const Eigen::Vector2d& point_m) const {
  const double column = std::floor((point_m.x() - min_x_m) / cell_m);
  const double row = std::floor((point_m.y() - min_y_m) / cell_m);
  // Written so that NaN fails.
  if (!(column >= 0 && column < columns && row >= 0 && row < rows)) return std::nullopt;
  return Index(static_cast<int>(column), static_cast<int>(row));
}

}  // namespace vantage
