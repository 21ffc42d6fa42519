// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/layered_graph.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <tuple>

namespace vantage::linking {
namespace {

// A node takes about 60 bytes in the solver, and costs of the longest path must fit 64 bits.
constexpr std::int64_t kMaxNodes = std::int64_t{1} << 27;
constexpr int kMaxDepth = 10;

Status CheckSizes(const LinkingProblem& problem) {
  if (problem.columns < 1 || problem.rows < 1) {
    return Fail("linking: the grid has {} x {} cells; it must have at least 1 x 1", problem.columns,
                problem.rows);
  }
  if (problem.frames < 0) {
    return Fail("linking: there are {} frames; there must be at least 0", problem.frames);
  }
  const std::int64_t cells = std::int64_t{problem.columns} * problem.rows;
  if (cells > kMaxNodes || problem.frames > kMaxNodes / cells) {
    return Fail(
        "linking: {} frames of {} x {} cells are more than 2^27 nodes; link a shorter "
        "stretch or use larger cells",
        problem.frames, problem.columns, problem.rows);
  }
  const auto expect = [](const char* what, std::size_t size, std::int64_t right) -> Status {
    if (size == static_cast<std::size_t>(right)) return {};
    return Fail("linking: {} has {} values; it must have {}", what, size, right);
  };
  VANTAGE_RETURN_IF_ERROR(
      expect("probability", problem.probability.size(), cells * problem.frames));
  VANTAGE_RETURN_IF_ERROR(expect("access", problem.access.size(), cells));
  if (!problem.obstacle.empty()) {
    VANTAGE_RETURN_IF_ERROR(expect("obstacle", problem.obstacle.size(), cells));
  }
  return {};
}

/// `reach`: cells per frame as the crow flies, if that limits people instead of `depth`.
std::vector<Move> MakeMoves(int depth, std::optional<double> reach, int grid_columns,
                            double movement_cost) {
  std::vector<Move> moves;
  if (reach) depth = std::max(1, static_cast<int>(*reach));
  for (int rows = -depth; rows <= depth; ++rows) {
    for (int columns = -depth; columns <= depth; ++columns) {
      const bool neighbour = std::max(std::abs(rows), std::abs(columns)) <= 1;
      if (reach && !neighbour && std::hypot(columns, rows) > *reach) continue;
      moves.push_back({.columns = columns,
                       .rows = rows,
                       .offset = columns + rows * grid_columns,
                       .cost = ToUnits(movement_cost * std::hypot(columns, rows))});
    }
  }
  std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
    const auto key = [](const Move& move) {
      return std::tuple(move.columns * move.columns + move.rows * move.rows, move.rows,
                        move.columns);
    };
    return key(a) < key(b);
  });
  return moves;
}

/// Cells per frame that options.max_speed_mps allows.
Result<std::optional<double>> Reach(const LinkingProblem& problem, const LinkingOptions& options) {
  if (!options.max_speed_mps) return std::optional<double>();
  if (!(problem.cell_m > 0) || !(problem.frames_per_second > 0)) {
    return Fail(
        "linking: max_speed needs the size of cells and the frame rate, and they are {} m and {} "
        "frames per second; give linking.depth instead",
        problem.cell_m, problem.frames_per_second);
  }
  const double reach = *options.max_speed_mps / problem.frames_per_second / problem.cell_m;
  if (reach > kMaxDepth) {
    return Fail(
        "linking.max_speed is {} m/s, {:.3g} cells of {} m per frame; at most {} cells are "
        "possible: lower it or use larger cells",
        *options.max_speed_mps, reach, problem.cell_m, kMaxDepth);
  }
  return std::optional(reach);
}

}  // namespace

std::int32_t NodeCost(double probability, double clip) {
  const double largest = std::log((1 - clip) / clip);
  // Clipped as a cost: 1 - clip itself may round to 1.
  const double cost = std::log((1 - probability) / probability);
  return static_cast<std::int32_t>(ToUnits(std::clamp(cost, -largest, largest)));
}

Cost ToUnits(double cost) { return std::llround(cost * kUnitsPerCost); }

Result<LayeredGraph> MakeLayeredGraph(const LinkingProblem& problem,
                                      const LinkingOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "linking"));
  VANTAGE_RETURN_IF_ERROR(CheckSizes(problem));
  VANTAGE_ASSIGN_OR_RETURN(const std::optional<double> reach, Reach(problem, options));
  LayeredGraph graph;
  graph.columns = problem.columns;
  graph.rows = problem.rows;
  graph.frames = problem.frames;
  graph.cells = static_cast<std::uint32_t>(problem.columns * problem.rows);
  graph.moves = MakeMoves(options.depth, reach, problem.columns, options.movement_cost);
  const Cost birth_cost = ToUnits(options.birth_cost);
  graph.entry_cost = birth_cost / 2;
  graph.exit_cost = birth_cost - graph.entry_cost;
  graph.access.assign(problem.access.begin(), problem.access.end());
  graph.obstacle.assign(problem.obstacle.begin(), problem.obstacle.end());
  graph.obstacle.resize(graph.cells, 0);
  graph.node_cost.reserve(problem.probability.size());
  for (const float probability : problem.probability) {
    if (!(probability >= 0 && probability <= 1)) {  // NaN too
      const std::size_t node = graph.node_cost.size();
      return Fail("linking: the probability of cell {} in frame {} is {}; it must be from 0 to 1",
                  node % graph.cells, node / graph.cells, probability);
    }
    graph.node_cost.push_back(NodeCost(probability, options.clip));
  }
  return graph;
}

}  // namespace vantage::linking
