// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/linking/linker.h"
#include "vantage/linking/network.h"

/// Internal to the linking module.

namespace vantage::linking {

/// Residual network of an optimal set of paths over the frames [first, last] of a problem; what
/// lies outside is fixed, the moves across the bounds too.
///
/// Vertices: in(v) and out(v) of every node v, joined by an arc of
/// cost c(v); the source, whence paths begin, at the entry cost; the sink, where they end, at the
/// exit cost; and an arc from the sink to the source of capacity max_paths, so that sets of paths
/// are circulations. All other capacities are 1. An arc without flow is in the residual network as
/// it is, an arc with flow reversed, its cost negated. The optimum has no cycle of negative cost
/// there (theorem 9.1), and every other set of paths is the optimum and some cycles.
class ResidualNetwork {
 public:
  using Vertex = std::uint32_t;
  /// cell + (frame - first) * cells.
  using Node = std::uint32_t;

  /// Fails when the sizes or options are wrong, when the paths are not a solution of the problem,
  /// and when they are not an optimal one.
  static Result<ResidualNetwork> Create(const LinkingProblem& problem,
                                        const LinkingOptions& options,
                                        const std::vector<LinkedPath>& paths, std::int64_t first,
                                        std::int64_t last, const RunControl& control);

  Node NodeAt(std::int64_t frame, CellIndex cell) const {
    return static_cast<Node>((frame - first_) * cells_) + static_cast<Node>(cell);
  }
  /// kNever where paths may not begin or end.
  Cost EntryCost(Node node) const;
  Cost ExitCost(Node node) const;
  Cost NodeCostAt(Node node) const { return node_cost_[node]; }
  Cost MoveCost(CellIndex from, CellIndex to) const;

  /// What the cheapest solution without the used move between these nodes costs more than the
  /// optimum, if that is less than `bound`: the shortest residual cycle through the reversed move.
  std::optional<Cost> MarginOfMove(Node from, Node to, Cost bound);

  struct Walk {
    Cost cost = 0;
    std::int64_t first_frame = 0;
    std::int64_t last_frame = 0;
  };
  /// The shortest residual path from source to sink other than the arc between them: one path more.
  std::optional<Walk> OneMorePath();

  /// The shortest residual cycle through source or sink and any vertex of the frames [first, last],
  /// if it costs less than `bound`. The walk that is found may pass a vertex twice; then it is made
  /// of several cycles, of which one through these frames costs no more, through source or sink or
  /// not.
  std::optional<Cost> CycleThroughEdgeAndFrames(std::int64_t first, std::int64_t last, Cost bound);

 private:
  /// How a node's path goes on: a node, or one of these.
  static constexpr Node kFree = ~Node{0};        // the node has no path
  static constexpr Node kEdge = ~Node{0} - 1;    // the path begins or ends here
  static constexpr Node kBeyond = ~Node{0} - 2;  // the path comes from or goes to frames outside

  /// A vertex, or that vertex on a walk that has been in the frames asked about.
  using State = std::uint32_t;
  struct Label {
    Cost distance;
    State parent;
  };

  ResidualNetwork() = default;
  Status Occupy(const std::vector<LinkedPath>& paths);
  Status OccupyStep(const LinkedPath& path, std::int64_t step);
  Status FindPotentials(const RunControl& control);
  Cost SumOfNegativeArcs() const;

  Vertex In(Node node) const { return 2 * node; }
  Vertex Out(Node node) const { return 2 * node + 1; }
  Vertex source() const { return 2 * node_count(); }
  Vertex sink() const { return source() + 1; }
  Vertex vertex_count() const { return source() + 2; }
  std::int64_t FrameOf(Vertex vertex) const { return first_ + vertex / 2 / cells_; }
  bool IsEntrance(Node node) const;
  bool IsExit(Node node) const;

  /// Calls visit(to, cost) for every residual arc that leaves `vertex`.
  template <class Visit>
  void ForEachArc(Vertex vertex, const Visit& visit) const;
  template <class Visit>
  void ForEachMove(Node node, const Visit& visit) const;

  /// Dijkstra's algorithm on reduced costs, up to `target`; true when that is nearer than `bound`
  /// (a reduced cost). `touches(vertex)` tells the vertices that put a walk into its second layer.
  template <class Touches>
  bool Search(State start, State target, Cost bound, const Touches& touches);
  Cost Reduced(Vertex from, Vertex to, Cost cost) const {
    return cost + potential_[from] - potential_[to];
  }

  Node node_count() const { return static_cast<Node>(node_cost_.size()); }

  Network network_;
  Node cells_ = 0;
  std::vector<std::int32_t> node_cost_;  // by node
  std::int64_t first_ = 0;
  std::int64_t frames_ = 0;
  bool from_beginning_ = false;  // the first frame is the problem's
  bool to_end_ = false;
  std::int64_t path_count_ = 0;
  bool may_add_ = false;
  std::vector<Node> next_, previous_;    // by node
  std::vector<Node> entrances_, lasts_;  // nodes where paths may begin; where paths end
  std::vector<Cost> potential_;          // by vertex

  // One search at a time.
  std::vector<Label> label_;    // by state
  std::vector<State> reached_;  // states with a label
};

}  // namespace vantage::linking
