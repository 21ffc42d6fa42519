// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/lemon_oracle.h"

#include <algorithm>

namespace vantage::testing {

LemonAnswer SolveWithLemon(const LinkingProblem& problem, const LinkingOptions& options,
                           LemonAlgorithm algorithm) {
  return SolveWithLemon(
      PlainLinkingProblem{.columns = problem.columns,
                          .rows = problem.rows,
                          .frames = problem.frames,
                          .probability = problem.probability.data(),
                          .access = problem.access.data(),
                          .obstacle = problem.obstacle.empty() ? nullptr : problem.obstacle.data(),
                          .depth = options.depth.value(),
                          .birth_cost = options.birth_cost,
                          .clip = options.clip,
                          .movement_cost = options.movement_cost / std::max(*options.depth, 1),
                          .inside_cost = options.inside_cost.value_or(-1),
                          .max_paths = options.max_paths},
      algorithm);
}

}  // namespace vantage::testing
