// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/geometry/polygon.h"

namespace vantage {

/// Square cells of the ground. Cell (column, row) covers
/// [min_x + column cell, min_x + (column + 1) cell) x [min_y + row cell, ...), metres;
/// its index is column + row * columns.
struct GroundGrid {
  double min_x_m = 0;
  double min_y_m = 0;
  double cell_m = 0;
  int columns = 0;
  int rows = 0;

  /// The smallest grid that covers the polygon and `extension_m` around its bounding box, with the
  /// polygon's bounding box starting on a cell border. Fails when cell_m is not positive,
  /// extension_m is negative, or the grid would have more than 4 million cells.
  static Result<GroundGrid> Cover(const Polygon& area, double cell_m, double extension_m);

  CellIndex count() const { return columns * rows; }
  CellIndex Index(int column, int row) const { return column + row * columns; }
  int Column(CellIndex cell) const { return cell % columns; }
  int Row(CellIndex cell) const { return cell / columns; }
  Eigen::Vector2d Center(CellIndex cell) const {
    return {min_x_m + (Column(cell) + 0.5) * cell_m, min_y_m + (Row(cell) + 0.5) * cell_m};
  }
  std::optional<CellIndex> CellAt(const Eigen::Vector2d& point_m) const;

  friend bool operator==(const GroundGrid&, const GroundGrid&) = default;
};

}  // namespace vantage
