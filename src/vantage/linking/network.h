// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/linking/linker.h"
#include "vantage/linking/node_cost.h"
#include "vantage/linking/stream_linker.h"

/// Internal to the linking module.

namespace vantage::linking {

/// A step from a cell to one a few columns and rows away in the next frame.
struct Move {
  int columns = 0;
  int rows = 0;
  Cost cost = 0;  ///< at least 0
};

inline constexpr Cost kNever = std::numeric_limits<Cost>::max() / 4;

/// What all frames of the layered graph have in common. Nodes are cells at an instant; moves lead
/// to the next frame. No arc is stored.
struct Network {
  int columns = 0;
  int rows = 0;
  /// By length, the shortest first: where nothing else decides, people take the shorter step. With
  /// every move its opposite is there, at the same cost.
  std::vector<Move> moves;
  /// Most columns or rows of a move.
  int depth = 0;
  /// What a path pays where it begins and where it ends; together the birth cost.
  Cost entry_cost = 0;
  Cost exit_cost = 0;
  /// The same by cell for frames in which paths may not begin and end everywhere; kNever where they
  /// may not at all.
  std::vector<Cost> entry_costs, exit_costs;
  NodeCost node_cost{0.25};
  std::vector<std::uint8_t> obstacle;  ///< by cell

  std::size_t cells() const { return obstacle.size(); }
  std::size_t Cell(int column, int row) const {
    return static_cast<std::size_t>(column) +
           static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
  }
  /// Place of a cell in a frame that is padded on all sides by as many cells as a move may cross.
  std::size_t Padded(int column, int row) const {
    return static_cast<std::size_t>(column + depth) +
           static_cast<std::size_t>(row + depth) * padded_columns();
  }
  std::size_t padded_columns() const {
    return static_cast<std::size_t>(columns) + 2 * static_cast<std::size_t>(depth);
  }
  std::size_t padded_cells() const {
    return padded_columns() *
           (static_cast<std::size_t>(rows) + 2 * static_cast<std::size_t>(depth));
  }
  bool Contains(int column, int row) const {
    return column >= 0 && column < columns && row >= 0 && row < rows;
  }
  /// Cost of the move by so many columns and rows, which must be one.
  Cost MoveCost(int column_step, int row_step) const {
    const std::size_t side = 2 * static_cast<std::size_t>(depth) + 1;
    return move_costs[static_cast<std::size_t>(column_step + depth) +
                      static_cast<std::size_t>(row_step + depth) * side];
  }

  std::vector<Cost> move_costs;  ///< see MoveCost
};

StreamGrid GridOf(const LinkingProblem& problem);

/// Checks options and sizes.
Result<Network> MakeNetwork(const StreamGrid& grid, const LinkingOptions& options);

/// Checks that `probability` is one frame of the network: its size, every value in [0, 1]. `frame`
/// is for the message.
Status CheckFrame(const Network& network, std::span<const float> probability, std::int64_t frame);

}  // namespace vantage::linking
