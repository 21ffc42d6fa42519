// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "vantage/base/run_control.h"
#include "vantage/linking/network.h"
#include "vantage/linking/node_store.h"
#include "vantage/linking/sweep.h"

/// Internal to the linking module.

namespace vantage::linking {

/// How the work is divided between searches and sweeps: changes the time taken, never the optimum.
/// Chosen on simulated rooms, halls and crowds.
struct SearchEffort {
  /// Reach of the sweep before all searches, in cost: two misses or a few more. Farther labels
  /// would mislead the searches of step 3. Of the sweeps in a step for far targets the first
  /// reaches as far, each one after it twice as far. 0: no sweeps.
  double reach = 30;
  /// A target that takes more expansions of vertices than this to find is far.
  std::int64_t nearby = 200;
  /// Searches for far targets expand so many vertices, as a share of the nodes, between sweeps.
  double share_between_sweeps = 0.1;
};
/// For streams: a sweep speaks for the frames that are here, not for those to come.
inline constexpr SearchEffort kNoSweeps = {.reach = 0};

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
///  1. Start: y = 0, and exactly the arcs with c(v) < 0 carry flow. The reversed arcs cost
///     -c(v) > 0, all others at least 0, so the condition holds without any search. Every such node
///     has one unit too many at out(v) and one too few at in(v). A sweep in time (Sweep) replaces
///     y by distances, under which the condition holds as well.
///  2. Each lack is filled along a shortest residual path that comes from the nearest out(v) with
///     an excess, or from the edge, whose balance is settled by step 3.
///  3. Each excess left over goes along a shortest residual path to the edge.
/// A shortest path and the update of potentials that belongs to it keep the condition (lemma 9.12),
/// whichever vertices they join, and each takes away one imbalance: it ends at the exact optimum.
/// In steps 2 and 3 a target can always be reached, since the empty flow is feasible: the
/// difference between it and the pseudo-flow is made of residual paths from excess to lack.
///
/// Why it is fast: people are seen in most frames, so nearly every lack finds its target one move
/// behind at cost 0. A search goes only as far as its target, in cost, and cells where nobody is
/// seen cost much; whole tracks are never searched.
///
/// A stream. Frames may be added after the flow was settled, and the oldest dropped:
///  - A new frame takes from the frame before the right to end everywhere (and at another cost):
///    paths that ended there have an excess again. Its nodes get the largest potentials <= 0 that
///    the new arcs allow (AddFrame), so the condition holds, and settling goes on from there.
///  - Dropping a frame fixes the flow in it and takes its residual arcs away. Fewer arcs keep the
///    condition: the flow stays optimal among those that continue what was dropped.
class FlowSolver {
 public:
  explicit FlowSolver(const Network& network) : FlowSolver(network, SearchEffort{}) {}
  FlowSolver(const Network& network, const SearchEffort& effort);

  /// Adds the next frame, which CheckFrame has passed; `probability` must outlive the frame here.
  /// After Settle only with kNoSweeps.
  void AddFrame(std::span<const float> probability);

  /// While the last frame is not the end of the recording, paths that reach it may stop there for
  /// nothing: nobody knows yet where they end. Before the first frame.
  void OpenEnd() { last_exit_cost_ = 0; }
  /// The last frame is the last one: who ends there pays. Settle must follow.
  void CloseEnd();

  /// Finds the minimum-cost flow over the frames that are here. False when stopped by the caller.
  bool Settle(const RunControl& control);

  /// Takes paths away, each time the one whose loss costs least (rerouting the others), until at
  /// most `count` are left: a shortest residual path from the edge's end of paths to their
  /// beginning. It leaves a minimum-cost flow of its number of paths (theorem 9.3 once more), and
  /// since the optimal cost is convex in that number, the best of at most `count`. After Settle;
  /// no frame may be added afterwards. False when stopped.
  bool KeepAtMost(std::int64_t count, const RunControl& control);

  /// Forgets the oldest frame, whose flow is final. After Settle; with kNoSweeps.
  void DropFrame();

  const NodeStore& nodes() const { return nodes_; }

  /// The least reduced cost of all residual arcs, which the method keeps at 0 or above. Slow; for
  /// tests.
  Cost LeastReducedCost() const;

  /// The paths, each a first node and the cells after it, in the order of first nodes. While no
  /// frame was dropped.
  std::vector<LinkedPath> Paths() const;

  /// What the flow through a frame costs: its nodes, the moves on from them, entries and exits.
  Cost FrameCost(std::int64_t frame) const;
  /// Sum over all frames that are here.
  Cost TotalCost() const;

 private:
  struct QueueEntry {
    Cost distance;
    std::int32_t order;  // among equals the one farthest along goes first, as if sent straight on
    Vertex vertex;
    friend bool operator>(const QueueEntry& a, const QueueEntry& b) {
      return std::tie(a.distance, a.order, a.vertex) > std::tie(b.distance, b.order, b.vertex);
    }
  };
  using Arc = std::pair<Vertex, Vertex>;

  /// Of the arc between the node and the edge, on one side; kNever: there is none.
  Cost EdgeCost(const Node& node, Side side) const {
    const std::size_t cell = network_.Cell(node.column, node.row);
    if (side == kIn) return node.frame == 0 ? network_.entry_cost : network_.entry_costs[cell];
    return node.frame + 1 == nodes_.end_frame() ? last_exit_cost_ : network_.exit_costs[cell];
  }
  Cost MoveCost(const Node& a, const Node& b) const {
    return network_.MoveCost(b.column - a.column, b.row - a.row);
  }
  void ReopenLastFrame();
  void SetFirstPotentials();

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
  /// Potentials under which the reduced cost to the nearest target is 0, for searches to come.
  template <Side kNear>
  void SweepPotentials(double reach);
  template <Side kNear>
  void Expand(Vertex vertex, Cost distance);
  template <Side kNear>
  void ExpandMoves(NodeId id, Cost base);
  template <Side kNear>
  void Relax(Vertex to, Cost distance, Vertex from);
  template <Side kNear>
  QueueEntry Entry(Cost distance, Vertex vertex) const;
  void OfferTarget(Vertex target, Cost distance, Vertex from);
  QueueEntry PopNearest();
  template <Side kNear>
  void UpdatePotentials();
  void ForgetLabels();
  std::vector<Arc> PathToTarget() const;
  void PushFlowAlong(const std::vector<Arc>& arcs, Side near);

  Link& LinkOf(Vertex vertex) { return nodes_[NodeOf(vertex)].link[SideOf(vertex)]; }
  Cost& PotentialOf(Vertex vertex) { return nodes_[NodeOf(vertex)].potential[SideOf(vertex)]; }
  Cost& DistanceOf(Vertex vertex) { return nodes_[NodeOf(vertex)].distance[SideOf(vertex)]; }

  const Network& network_;
  const SearchEffort effort_;
  NodeStore nodes_;
  Cost last_exit_cost_;
  std::vector<NodeId> open_;  // nodes with an imbalance, the oldest first

  // The edge is one vertex until paths are taken away; then its two sides part.
  EdgePotentials edge_potential_ = {0, 0};

  // One search at a time.
  Targets targets_ = Targets::kImbalances;
  std::vector<Vertex> reached_;  // vertices with a distance
  std::vector<QueueEntry> queue_;
  std::vector<const Move*> absent_;  // of one expansion
  Cost target_distance_ = 0;
  std::int64_t expansions_ = 0;  // since the last sweep
  Arc target_arc_ = {kEdge, kEdge};
};

}  // namespace vantage::linking
