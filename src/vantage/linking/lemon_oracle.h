// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "vantage/linking/linker.h"

/// For tests and benchmarks only: the same problem, stated arc by arc to an independent solver.

namespace vantage::testing {

struct LemonAnswer {
  std::int64_t cost_units = 0;  ///< of 2^-20
  std::int64_t paths = 0;
  std::int64_t arcs = 0;
};

/// Solves `problem` with LEMON's NetworkSimplex on the explicit node-split graph.
LemonAnswer SolveWithLemon(const LinkingProblem& problem, const LinkingOptions& options);

}  // namespace vantage::testing
