// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/geometry/grid.h"

namespace vantage {

/// How a map becomes detections.
struct PeakOptions {
  /// Cells with a smaller probability are no detections, 0 < threshold <= 1.
  double threshold = 0.5;
  /// The cell's centre of a detection is at least this far from the position of every stronger
  /// one, in metres, 0 <= distance <= 100.
  double distance_m = 0.35;
  /// Position between cells: the mean of the cell's and its eight neighbours' centres, weighted by
  /// their probabilities. Otherwise the cell's centre.
  bool refine = true;
};
void VisitOptions(PeakOptions& options, OptionVisitor& visitor);

struct Peak {
  CellIndex cell = 0;
  /// On the ground, in metres.
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  /// Probability of presence at the cell.
  float probability = 0;
};

/// Detections of one map, q[cell] in [0, 1]: cells that no neighbour exceeds, taken in descending
/// order of probability (ties: ascending index) unless a stronger one is nearer than the distance.
/// Fails when q is not of the grid's size or an option breaks its rule.
Result<std::vector<Peak>> FindPeaks(const GroundGrid& grid, std::span<const float> q,
                                    const PeakOptions& options);

}  // namespace vantage
