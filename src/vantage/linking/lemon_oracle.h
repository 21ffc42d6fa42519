// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vantage/linking/lemon_flow_oracle.h"
#include "vantage/linking/linker.h"

/// For tests and benchmarks only: the same problem, stated arc by arc to an independent solver.

namespace vantage::testing {

/// Solves `problem` with LEMON on the explicit node-split graph. Steps are those of options.depth,
/// which must be given.
LemonAnswer SolveWithLemon(const LinkingProblem& problem, const LinkingOptions& options,
                           LemonAlgorithm algorithm = LemonAlgorithm::kNetworkSimplex);

}  // namespace vantage::testing
