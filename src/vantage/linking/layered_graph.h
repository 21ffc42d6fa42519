// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/linking/linker.h"

/// Internal to the linking module.

namespace vantage::linking {

/// Costs are integers in units of 2^-20.
using Cost = std::int64_t;
inline constexpr double kUnitsPerCost = 1 << 20;

/// cell + frame * cells.
using Node = std::uint32_t;

/// A step from a cell to one at most `depth` columns and rows away in the next frame.
struct Move {
  int columns = 0;
  int rows = 0;
  std::int32_t offset = 0;  ///< columns + rows * grid columns
  Cost cost = 0;            ///< at least 0
};

/// The layered graph of a LinkingProblem without any stored arc: from a node (cell, t) the moves
/// lead to nodes of frame t + 1.
struct LayeredGraph {
  int columns = 0;
  int rows = 0;
  std::int64_t frames = 0;
  std::uint32_t cells = 0;
  /// By length, the shortest first: where nothing else decides, people take the shorter step.
  std::vector<Move> moves;
  /// What a path pays where it begins and where it ends; together the birth cost.
  Cost entry_cost = 0;
  Cost exit_cost = 0;
  /// -log(p / (1 - p)) of every node, p clipped.
  std::vector<std::int32_t> node_cost;
  std::vector<std::uint8_t> access;    ///< by cell
  std::vector<std::uint8_t> obstacle;  ///< by cell

  Node node_count() const { return static_cast<Node>(node_cost.size()); }
  bool IsEntrance(Node node) const { return node < cells || access[node % cells] != 0; }
  bool IsExit(Node node) const { return node >= node_count() - cells || access[node % cells] != 0; }
};

/// -log(p / (1 - p)) in units, p clipped to [clip, 1 - clip].
std::int32_t NodeCost(double probability, double clip);

/// `cost` in units, rounded to the nearest.
Cost ToUnits(double cost);

/// Checks sizes, options and probabilities.
Result<LayeredGraph> MakeLayeredGraph(const LinkingProblem& problem, const LinkingOptions& options);

}  // namespace vantage::linking
