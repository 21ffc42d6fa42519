// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

/// Internal to lemon_oracle.cc: the explicit graph and LEMON's algorithms on it. LEMON 1.3.1 is not
/// all C++20, so this header and its source are C++17 and know none of our types.

namespace vantage::testing {

enum class LemonAlgorithm { kNetworkSimplex, kCapacityScaling, kCostScaling };

struct LemonAnswer {
  std::int64_t cost_units = 0;  ///< of 2^-20
  std::int64_t paths = 0;
  std::int64_t arcs = 0;
};

/// A LinkingProblem with its options.
struct PlainLinkingProblem {
  int columns, rows;
  std::int64_t frames;
  const float* probability;
  const std::uint8_t* access;
  const std::uint8_t* obstacle;  ///< null: none
  int depth;
  double birth_cost, clip, movement_cost;  // the last per cell
  double inside_cost;                      ///< below 0: never
  int max_paths;
};

/// Builds the node-split graph arc by arc and finds the minimum-cost circulation.
LemonAnswer SolveWithLemon(const PlainLinkingProblem& problem, LemonAlgorithm algorithm);

}  // namespace vantage::testing
