// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "vantage/base/run_control.h"
#include "vantage/linking/layered_graph.h"

/// Internal to the linking module.

namespace vantage::linking {

/// Minimum-cost flow on a layered graph by successive shortest paths (Ahuja, Magnanti, Orlin,
/// "Network Flows", 1993, section 9.7), begun from the nodes instead of from the source.
///
/// The network. Every node v is split into in(v) and out(v), joined by an arc of capacity 1 and
/// cost c(v), so that it carries at most one path. Moves lead from out(v) to in(w). One further
/// vertex, the edge (of what is seen), leads to in(v) of every entrance at the entry cost and is
/// reached from out(v) of every exit at the exit cost: paths are circulations through the edge, of
/// any number.
///
/// The method keeps a pseudo-flow (vertices may be out of balance) and potentials y under which
/// every residual arc u -> w has a reduced cost, cost + y(u) - y(w), of at least 0. A pseudo-flow
/// like that with every vertex in balance is a minimum-cost flow (reduced-cost optimality,
/// theorem 9.3).
///  1. Start: y = 0, and exactly the arcs with c(v) < 0 carry flow. The reversed arcs cost -c(v) >
///  0,
///     all others at least 0, so the condition holds without any search. Every such node has one
///     unit too many at out(v) and one too few at in(v).
///  2. Each excess goes along a shortest residual path to the nearest in(w) that lacks a unit, or
///  to
///     the edge, whose balance is settled by step 3.
///  3. Each lack left over is filled along a shortest residual path that comes from the edge.
/// A shortest path and the update of potentials that belongs to it keep the condition (lemma 9.12),
/// whichever vertices they join, and each takes away one imbalance: it ends at the exact optimum.
/// In steps 2 and 3 a target can always be reached, since the empty flow is feasible: the
/// difference between it and the pseudo-flow is made of residual paths from excess to lack.
///
/// Why it is fast: people are seen in most frames, so nearly every excess finds its target one move
/// ahead at cost 0. A search goes only as far as its target, in cost, and cells where nobody is
/// seen cost much; whole tracks are never searched.
class FlowSolver {
 public:
  /// Changes the time taken, never the optimum. In expansions of vertices.
  struct Effort {
    /// A target that takes more than this to find is far.
    std::int64_t nearby = 5000;
    /// Searches for far targets cost this much, as a share of the nodes, between sweeps.
    double share_between_sweeps = 0.5;
  };

  explicit FlowSolver(const LayeredGraph& graph) : FlowSolver(graph, Effort{}) {}
  FlowSolver(const LayeredGraph& graph, const Effort& effort);

  /// Finds the minimum-cost flow. False when stopped by the caller.
  bool Solve(const RunControl& control);

  /// Takes paths away, each time the one whose loss costs least (rerouting the others), until at
  /// most `count` are left: a shortest residual path from the edge's end of paths to their
  /// beginning. It leaves a minimum-cost flow of its number of paths (theorem 9.3 once more), and
  /// since the optimal cost is convex in that number, the best of at most `count`. After Solve.
  /// False when stopped.
  bool KeepAtMost(std::int64_t count, const RunControl& control);

  /// The paths, each a first node and the cells after it, in the order of first nodes.
  std::vector<LinkedPath> Paths() const;
  /// Sum of the costs of all arcs that carry flow.
  Cost TotalCost() const;

 private:
  enum Side : std::uint32_t { kIn = 0, kOut = 1 };
  /// 2 * node + side.
  using Vertex = std::uint32_t;
  static constexpr Vertex kEdge = ~Vertex{0};

  /// How the flow goes on from in(v) backward in time, from out(v) forward: the number of a move,
  /// or one of these.
  using Link = std::int16_t;
  static constexpr Link kToEdge = -1;   // the path begins or ends here
  static constexpr Link kOpen = -2;     // the node carries flow that is not connected: an imbalance
  static constexpr Link kUnused = -3;   // the node carries no flow
  static constexpr Link kBlocked = -4;  // an obstacle

  struct Label {
    Cost distance;
    Vertex parent;
  };
  using QueueEntry = std::pair<Cost, Vertex>;  // ties go to the lower vertex: same on every machine
  using Arc = std::pair<Vertex, Vertex>;

  static constexpr Side Other(Side side) { return side == kIn ? kOut : kIn; }
  static constexpr Vertex At(Node node, Side side) { return 2 * node + side; }
  static constexpr Node NodeOf(Vertex vertex) { return vertex / 2; }
  static constexpr Side SideOf(Vertex vertex) { return static_cast<Side>(vertex % 2); }
  bool Carries(Node node) const { return link_[At(node, kIn)] > kUnused; }

  /// Time runs forward in a search from an excess (kNear = kOut) and backward in one from a lack
  /// (kNear = kIn); the network is its own mirror image with in and out, begin and end exchanged
  /// and potentials negated.
  enum class Outcome { kFound, kGaveUp, kStopped };
  template <Side kNear>
  Outcome Search(std::span<const QueueEntry> starts, std::int64_t most_expansions,
                 const RunControl& control);
  /// Settles all imbalances from which a search of direction kNear starts.
  template <Side kNear>
  bool SettleAll(const RunControl& control);
  /// Potentials from the distances between every imbalance that is left and its nearest target: one
  /// Dijkstra's algorithm from all targets at once, against the direction of the searches that
  /// follow. kNear: the side on which the targets are.
  template <Side kNear>
  bool Spread(std::int64_t imbalances, const RunControl& control);
  /// Starts from both sides of the edge and the open vertices of side kNear.
  template <Side kNear>
  void StartSpread();
  template <Side kNear>
  void Expand(Vertex vertex, Cost distance);
  template <Side kNear>
  void ExpandMoves(Node node, Cost base);
  template <Side kNear>
  void Relax(Vertex to, Cost distance, Vertex from);
  void OfferTarget(Vertex target, Cost distance, Vertex from);
  QueueEntry PopNearest();
  template <Side kNear>
  void UpdatePotentials();
  void ForgetLabels();
  std::vector<Arc> PathToTarget() const;
  template <Side kNear>
  static Cost Mirror(Cost potential) {
    return kNear == kOut ? potential : -potential;
  }

  /// Along the arcs of a residual path, in any order; `near` as in Search.
  void PushFlowAlong(const std::vector<Arc>& arcs, Side near);
  Link LinkBetween(Node earlier, Node later) const;
  Node Follow(Node node, Side side) const;

  const LayeredGraph& graph_;
  const Effort effort_;
  std::vector<Link> link_;       // by vertex
  std::vector<Cost> potential_;  // by vertex

  // The edge is one vertex until paths are taken away; then its two sides part.
  Cost edge_potential_[2] = {0, 0};

  // One search at a time.
  enum class Targets { kImbalances, kBeginnings, kNone };
  Targets targets_ = Targets::kImbalances;
  std::vector<Label> label_;     // by vertex; kUnreached outside a search
  std::vector<Vertex> reached_;  // vertices with a label
  std::vector<QueueEntry> queue_;
  Cost target_distance_ = 0;
  Arc target_arc_ = {kEdge, kEdge};
  std::int64_t expansions_ = 0;  // in the searches since the last sweep
};

}  // namespace vantage::linking
