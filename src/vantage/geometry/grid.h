// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/geometry/polygon.h"

namespace vantage {

/// How far a grid goes beyond each side of the bounding box of an area, metres, at least 0.
struct Extension {
  double min_x_m = 0;
  double max_x_m = 0;
  double min_y_m = 0;
  double max_y_m = 0;

  static Extension Uniform(double all_m) { return {all_m, all_m, all_m, all_m}; }
  friend bool operator==(const Extension&, const Extension&) = default;
};

/// Square cells of the ground. Cell (column, row) covers
/// [min_x + column cell, min_x + (column + 1) cell) x [min_y + row cell, ...), metres;
/// its index is column + row * columns.
struct GroundGrid {
  double min_x_m = 0;
  double min_y_m = 0;
  double cell_m = 0;
  int columns = 0;
  int rows = 0;

  /// The smallest grid that covers the polygon and its extension, with the polygon's bounding box
  /// starting on a cell border: each side grows by whole cells. Fails when cell_m is not positive,
  /// an extension is negative, or the grid would have more than 4 million cells.
  static Result<GroundGrid> Cover(const Polygon& area, double cell_m, const Extension& extension);

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
