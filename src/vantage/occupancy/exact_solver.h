// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "vantage/occupancy/camera_cells.h"
#include "vantage/occupancy/solver.h"

namespace vantage::internal {

/// One frame for a solver; all sizes fit.
struct Problem {
  const OccupancyOptions& options;
  const std::vector<double>& priors;
  const std::vector<CameraCells>& cameras;
  const std::vector<Foreground>& foreground;
  std::span<const float> previous;  // may be empty
};

/// Every cell and every pixel, in double precision.
SolveReport SolveExactly(const Problem& problem, std::span<float> q);

}  // namespace vantage::internal
