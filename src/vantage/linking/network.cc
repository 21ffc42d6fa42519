// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/network.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <tuple>

namespace vantage::linking {
namespace {

constexpr int kMaxSide = 32'767;  // columns and rows are kept in 16 bits
constexpr std::int64_t kMaxCells = std::int64_t{1} << 27;
constexpr int kMaxDepth = 10;
// What a move costs at most, so that sums over a recording stay exact: only speeds near 0 ask more.
constexpr double kMaxMoveCost = 15'000;

Status CheckSizes(const StreamGrid& grid) {
  if (grid.columns < 1 || grid.rows < 1) {
    return Fail("linking: the grid has {} x {} cells; it must have at least 1 x 1", grid.columns,
                grid.rows);
  }
  const std::int64_t cells = std::int64_t{grid.columns} * grid.rows;
  if (grid.columns > kMaxSide || grid.rows > kMaxSide || cells > kMaxCells) {
    return Fail("linking: the grid has {} x {} cells; at most {} on a side and {} are possible",
                grid.columns, grid.rows, kMaxSide, kMaxCells);
  }
  const auto expect = [cells](const char* what, std::size_t size) -> Status {
    if (size == static_cast<std::size_t>(cells)) return {};
    return Fail("linking: {} has {} values; it must have {}", what, size, cells);
  };
  VANTAGE_RETURN_IF_ERROR(expect("access", grid.access.size()));
  if (!grid.obstacle.empty()) {
    VANTAGE_RETURN_IF_ERROR(expect("obstacle", grid.obstacle.size()));
  }
  return {};
}

/// Cells per frame, as the crow flies, that max_speed allows.
Result<double> Reach(const StreamGrid& grid, double max_speed_mps) {
  if (!(grid.cell_m > 0) || !(grid.frames_per_second > 0)) {
    return Fail(
        "linking.max_speed needs the size of cells and the frame rate, and they are {} m and {} "
        "frames per second; give linking.depth in its place",
        grid.cell_m, grid.frames_per_second);
  }
  return max_speed_mps / grid.frames_per_second / grid.cell_m;
}

/// To all cells within network.depth; with a `reach`, to those as near as that, and the neighbours.
/// A move of `reach` or `depth` costs movement_cost.
void MakeMoves(std::optional<double> reach, double movement_cost, Network& network) {
  const double cost_per_cell = movement_cost / reach.value_or(std::max(network.depth, 1));
  const int depth = network.depth;
  for (int rows = -depth; rows <= depth; ++rows) {
    for (int columns = -depth; columns <= depth; ++columns) {
      const double length = std::sqrt(columns * columns + rows * rows);
      const Cost cost = length > 0 && movement_cost > 0
                            ? ToUnits(std::min(cost_per_cell * length, kMaxMoveCost))
                            : 0;
      network.move_costs.push_back(cost);
      const bool neighbour = std::max(std::abs(rows), std::abs(columns)) <= 1;
      if (reach && !neighbour && std::hypot(columns, rows) > *reach) continue;
      network.moves.push_back({.columns = columns, .rows = rows, .cost = cost});
    }
  }
  std::sort(network.moves.begin(), network.moves.end(), [](const Move& a, const Move& b) {
    const auto key = [](const Move& move) {
      return std::tuple(move.columns * move.columns + move.rows * move.rows, move.rows,
                        move.columns);
    };
    return key(a) < key(b);
  });
}

}  // namespace

StreamGrid GridOf(const LinkingProblem& problem) {
  return {.columns = problem.columns,
          .rows = problem.rows,
          .access = problem.access,
          .obstacle = problem.obstacle,
          .cell_m = problem.cell_m,
          .frames_per_second = problem.frames_per_second};
}

Result<Network> MakeNetwork(const StreamGrid& grid, const LinkingOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "linking"));
  VANTAGE_RETURN_IF_ERROR(CheckSizes(grid));
  std::optional<double> reach;
  if (!options.depth) {
    VANTAGE_ASSIGN_OR_RETURN(reach, Reach(grid, options.max_speed_mps));
  }
  Network network;
  network.columns = grid.columns;
  network.rows = grid.rows;
  network.depth =
      reach ? static_cast<int>(std::clamp<double>(*reach, 1, kMaxDepth)) : *options.depth;
  MakeMoves(reach, options.movement_cost, network);
  const Cost birth_cost = ToUnits(options.birth_cost);
  network.entry_cost = birth_cost / 2;
  network.exit_cost = birth_cost - network.entry_cost;
  network.node_cost = NodeCost(options.clip);
  network.obstacle.assign(grid.obstacle.begin(), grid.obstacle.end());
  network.obstacle.resize(grid.access.size(), 0);
  for (const std::uint8_t access : grid.access) {
    const Cost extra = access != 0           ? 0
                       : options.inside_cost ? ToUnits(*options.inside_cost)
                                             : kNever;
    network.entry_costs.push_back(std::min(network.entry_cost + extra, kNever));
    network.exit_costs.push_back(std::min(network.exit_cost + extra, kNever));
  }
  return network;
}

Status CheckFrame(const Network& network, std::span<const float> probability, std::int64_t frame) {
  if (probability.size() != network.cells()) {
    return Fail("linking: the map of frame {} has {} values; it must have {}", frame,
                probability.size(), network.cells());
  }
  // One comparison a value and no branch: this loop reads all the maps.
  const auto wrong = [](float p) { return !(p >= 0 && p <= 1); };  // NaN too
  unsigned any_wrong = 0;
  for (const float p : probability) any_wrong |= static_cast<unsigned>(wrong(p));
  if (any_wrong == 0) return {};
  const auto first = std::find_if(probability.begin(), probability.end(), wrong);
  return Fail("linking: the probability of cell {} in frame {} is {}; it must be from 0 to 1",
              first - probability.begin(), frame, *first);
}

}  // namespace vantage::linking
