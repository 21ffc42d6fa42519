// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/peaks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vantage {
namespace {

/// Calls visit(neighbour) for the cells of the grid within `reach` columns and rows of a cell.
template <class Visit>
void ForNeighbours(const GroundGrid& grid, CellIndex cell, int reach, Visit visit) {
  const int column = grid.Column(cell), row = grid.Row(cell);
  const int last_column = std::min(column + reach, grid.columns - 1);
  const int last_row = std::min(row + reach, grid.rows - 1);
  for (int y = std::max(row - reach, 0); y <= last_row; ++y) {
    for (int x = std::max(column - reach, 0); x <= last_column; ++x) visit(grid.Index(x, y));
  }
}

float At(std::span<const float> q, CellIndex cell) { return q[static_cast<std::size_t>(cell)]; }

bool IsMaximum(const GroundGrid& grid, std::span<const float> q, CellIndex cell) {
  bool maximum = true;
  ForNeighbours(grid, cell, 1, [&](CellIndex other) {
    if (At(q, other) > At(q, cell)) maximum = false;
  });
  return maximum;
}

Eigen::Vector2d Refined(const GroundGrid& grid, std::span<const float> q, CellIndex cell) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0;
  ForNeighbours(grid, cell, 1, [&](CellIndex other) {
    sum += static_cast<double>(At(q, other)) * grid.Center(other);
    weight += static_cast<double>(At(q, other));
  });
  return sum / weight;
}

}  // namespace

void VisitOptions(PeakOptions& o, OptionVisitor& v) {
  v.Number({"threshold", "", "cells with a smaller probability are no detections"}, o.threshold,
           Range::AboveUpTo(0, 1));
  v.Number({"distance", "m", "detections are at least this far apart"}, o.distance_m,
           Range::Between(0, 100));
  v.Flag({"refine", "", "position between cells, by the probabilities around the cell"}, o.refine);
}

Result<std::vector<Peak>> FindPeaks(const GroundGrid& grid, std::span<const float> q,
                                    const PeakOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "peaks"));
  if (q.size() != static_cast<std::size_t>(grid.count())) {
    return Fail("the map has {} cells; the grid has {}", q.size(), grid.count());
  }
  std::vector<CellIndex> candidates;
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    if (At(q, cell) >= options.threshold && IsMaximum(grid, q, cell)) candidates.push_back(cell);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](CellIndex a, CellIndex b) { return At(q, a) > At(q, b); });
  const double longest = std::max(grid.columns, grid.rows);
  // A position between cells is less than a cell from its cell's centre.
  const int reach =
      static_cast<int>(std::min(std::ceil(options.distance_m / grid.cell_m) + 1, longest));
  std::vector<std::uint8_t> taken(q.size(), 0);
  std::vector<Peak> peaks;
  for (const CellIndex cell : candidates) {
    if (taken[static_cast<std::size_t>(cell)] != 0) continue;
    const Eigen::Vector2d position_m = options.refine ? Refined(grid, q, cell) : grid.Center(cell);
    peaks.push_back({cell, position_m, At(q, cell)});
    // From the position: a person between two cells may raise both to the same probability.
    ForNeighbours(grid, cell, reach, [&](CellIndex other) {
      // Cells at exactly the distance stay free whatever the rounding of their centres.
      if ((grid.Center(other) - position_m).norm() < options.distance_m - 1e-9) {
        taken[static_cast<std::size_t>(other)] = 1;
      }
    });
  }
  return peaks;
}

}  // namespace vantage
