// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <span>
#include <vector>

#include "vantage/linking/network.h"

/// Internal to the linking module.

namespace vantage::linking {

enum Side : std::uint32_t { kIn = 0, kOut = 1 };
constexpr Side Other(Side side) { return side == kIn ? kOut : kIn; }

/// Number of a node in its store.
using NodeId = std::uint32_t;
inline constexpr NodeId kNoNode = ~NodeId{0};

/// 2 * node + side.
using Vertex = std::uint32_t;
inline constexpr Vertex kEdge = ~Vertex{0};
constexpr Vertex At(NodeId node, Side side) { return 2 * node + side; }
constexpr NodeId NodeOf(Vertex vertex) { return vertex / 2; }
constexpr Side SideOf(Vertex vertex) { return static_cast<Side>(vertex % 2); }

/// How the flow goes on from in(v) backward in time, from out(v) forward: the node there, or one of
/// these.
using Link = NodeId;
inline constexpr Link kToEdge = kNoNode;      ///< the path begins or ends here
inline constexpr Link kOpen = kNoNode - 1;    ///< the node carries flow that is not connected
inline constexpr Link kUnused = kNoNode - 2;  ///< the node carries no flow
inline constexpr Link kFinal = kNoNode - 3;   ///< the path comes from a frame that was dropped
constexpr bool IsNode(Link link) { return link < kFinal; }

/// Distance of what no search has reached.
inline constexpr Cost kUnreached = std::numeric_limits<Cost>::max();

/// One node of the network with all that the solver knows of it, in one cache line. See FlowSolver
/// for the meaning.
struct alignas(64) Node {
  std::int32_t frame = 0;
  std::int16_t column = 0;
  std::int16_t row = 0;
  std::int32_t cost = 0;
  Link link[2] = {kUnused, kUnused};
  Vertex parent[2] = {kEdge, kEdge};
  Cost potential[2] = {0, 0};
  Cost distance[2] = {kUnreached, kUnreached};

  bool Carries() const { return link[kIn] != kUnused; }
};

/// The nodes of a network that somebody has touched: where p > 1/2, and what searches came by. All
/// others are as they were at first, and their costs follow from the maps, which stay with the
/// caller. So memory and time go with what happens, not with the size of the grid.
class NodeStore {
 public:
  explicit NodeStore(const Network& network);

  /// Adds the next frame and its nodes with a cost below 0. `probability` must outlive the frame
  /// here. Returns the new nodes' ids, in the order of cells.
  std::vector<NodeId> AddFrame(std::span<const float> probability);
  /// Forgets the oldest frame and its nodes.
  void DropFrame();
  std::int64_t first_frame() const { return first_frame_; }
  std::int64_t end_frame() const { return first_frame_ + std::ssize(frames_); }

  Node& operator[](NodeId id) { return nodes_[id]; }
  const Node& operator[](NodeId id) const { return nodes_[id]; }
  const Network& network() const { return network_; }

  /// kNoNode when nobody has touched it. The cell must be one of the grid.
  NodeId Find(std::int64_t frame, int column, int row) const;
  NodeId FindOrAdd(std::int64_t frame, int column, int row);
  std::int32_t CostOf(std::int64_t frame, int column, int row) const;
  /// Of a node that nobody has touched.
  Cost PotentialOf(std::int64_t frame, int column, int row, Side side) const;

  /// The nodes of a frame, in the order of their coming.
  template <class Visit>
  void ForEach(std::int64_t frame, Visit visit) const;
  std::int64_t count() const { return std::ssize(nodes_) - std::ssize(free_); }
  std::span<const float> Probability(std::int64_t frame) const { return At(frame).probability; }

  /// The costs of all nodes of a frame, by cell; kept once they were asked for.
  std::span<const std::int32_t> Costs(std::int64_t frame);
  /// Potentials of all nodes of a frame on one side, sign * value by padded place, for those that
  /// nobody has touched; the other side's follow from out = in + cost.
  void SetPotentials(std::int64_t frame, Side side, double sign, std::vector<double> values);
  /// These potentials on the side that is asked for, of `count` cells of a row from `column` on.
  void GetPotentials(std::int64_t frame, int column, int row, Side side, std::span<double> values);

 private:
  /// Cells of one frame to nodes, in tiles of 8 x 8 cells; where nobody came by there is no tile.
  static constexpr int kTileShift = 3;
  static constexpr int kTileMask = (1 << kTileShift) - 1;
  using TileId = std::uint32_t;
  static constexpr TileId kNoTile = 0;
  struct Tile {
    NodeId nodes[1 << (2 * kTileShift)];
  };
  struct Frame {
    std::span<const float> probability;
    std::vector<TileId> tiles;        // by place on the grid
    std::vector<NodeId> nodes;        // in the order of their coming
    std::vector<std::int32_t> costs;  // empty: not asked for
    std::vector<double> potentials;   // empty: 0
    double potentials_sign = 1;
    Side potentials_side = kIn;
  };

  const Frame& At(std::int64_t frame) const {
    return frames_[static_cast<std::size_t>(frame - first_frame_)];
  }
  Frame& At(std::int64_t frame) { return frames_[static_cast<std::size_t>(frame - first_frame_)]; }
  std::size_t TilePlace(int column, int row) const {
    return static_cast<std::size_t>(column >> kTileShift) +
           static_cast<std::size_t>(row >> kTileShift) * tile_columns_;
  }
  static std::size_t PlaceInTile(int column, int row) {
    return static_cast<std::size_t>(column & kTileMask) +
           (static_cast<std::size_t>(row & kTileMask) << kTileShift);
  }
  NodeId NewNode();
  TileId NewTile();

  const Network& network_;
  const std::size_t tile_columns_;
  const std::size_t tiles_per_frame_;
  std::deque<Frame> frames_;
  std::int64_t first_frame_ = 0;
  std::vector<Node> nodes_;
  std::vector<NodeId> free_;
  std::vector<Tile> tiles_;  // the first is empty for ever: the one that is not there
  std::vector<TileId> free_tiles_;
};

inline NodeId NodeStore::Find(std::int64_t frame, int column, int row) const {
  return tiles_[At(frame).tiles[TilePlace(column, row)]].nodes[PlaceInTile(column, row)];
}

template <class Visit>
void NodeStore::ForEach(std::int64_t frame, Visit visit) const {
  for (const NodeId id : At(frame).nodes) visit(id);
}

}  // namespace vantage::linking
