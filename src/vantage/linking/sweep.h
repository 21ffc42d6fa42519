// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/linking/node_store.h"
#include "vantage/linking/sweep_kernel.h"

/// Internal to the linking module.

namespace vantage::linking {

/// The edge's two sides; its potentials, as those of vertices.
using EdgePotentials = std::array<Cost, 2>;

/// What a sweep measures distances to.
enum class Targets {
  kImbalances,  ///< nodes that lack a unit (or have one too many), and the edge
  kBeginnings,  ///< the edge where paths begin; paths that end there may be taken up again
};

/// Distances, in reduced cost, of all vertices to the nearest target in the residual network of a
/// flow (see FlowSolver), by dynamic programming over whole frames: every arc once, without a
/// queue.
///
/// It keeps labels l(u) = d(u) - y(u), d being the reduced distance and y the potential, so that
/// the old potentials need not be added to every arc: a target has l = -y, and every residual arc
/// u -> w demands l(u) <= cost + l(w). The new potentials are -l. Distances stop at a given reach:
/// l(u) <= reach - y(u). Every label that is the least over a vertex's own arcs and that bound
/// meets its demands; so do targets, since no label falls below -y.
///
/// Moves lead one frame ahead, so that one pass against time gives the labels over all arcs but
/// those that the flow has reversed. These lead back along the paths, which are few: a pass in time
/// over the nodes that carry flow relaxes them. The two alternate until nothing changes; only those
/// cells are done again that depend on labels which fell. (With no path yet, as at first, nothing
/// changes after the first pass.) It ends, as Bellman and Ford's algorithm does, of which this is
/// an order of relaxing: there is no negative cycle because the flow is optimal for its imbalances.
///
/// Every vertex has a target within reach if that is infinite: from a node that carries no flow one
/// can stay until the last frame, an exit, or until the place is taken by a path; from a node that
/// carries flow one can go back along its path, to a lack or to the path's entry.
class Sweep {
 public:
  Sweep(const Network& network, NodeStore& nodes);

  /// Sets all potentials and those of the edge: then no reduced cost is below 0, and those along
  /// shortest paths to targets within reach (in units; may be infinite) are 0. As described for
  /// kNear = kOut; for kNear = kIn in mirror image: distances from the targets, time reversed,
  /// potentials negated. No frame was dropped.
  template <Side kNear>
  void SetPotentials(Targets targets, double reach, EdgePotentials& edge);

  /// One pass over every arc: what the first round does, for measuring.
  void PassOnce();

 private:
  /// Columns [begin, end) of a row.
  struct Stretch {
    int begin = 0;
    int end = 0;
    bool empty() const { return begin >= end; }
    void Add(Stretch other) {
      if (other.empty()) return;
      *this = empty() ? other : Stretch{std::min(begin, other.begin), std::max(end, other.end)};
    }
  };
  struct Frame {
    /// Labels on the far side, by padded place; infinite outside the grid and at obstacles.
    std::vector<double> far;
    /// By row, where they fell since the next frame of a pass was done; empty: nowhere.
    std::vector<Stretch> fell;
  };

  // Frames in the order of a pass against the direction of kNear.
  template <Side kNear>
  std::int64_t FrameAt(std::int64_t step) const {
    return kNear == kOut ? nodes_.end_frame() - 1 - step : nodes_.first_frame() + step;
  }
  std::int64_t frame_count() const { return std::ssize(frames_); }
  Frame& At(std::int64_t frame) {
    return frames_[static_cast<std::size_t>(frame - nodes_.first_frame())];
  }

  template <Side kNear>
  void StartCarriers();
  template <Side kNear>
  void FirstPass();
  /// Does the `todo` of a frame again (by row; none empty: all of it).
  template <Side kNear>
  void DoFrame(std::int64_t step, std::span<const Stretch> todo);
  template <Side kNear>
  void DoStretch(std::int64_t step, int row, Stretch stretch, double* out);
  /// The labels at the reach on the far side.
  template <Side kNear>
  void SetMost(std::int64_t frame, std::span<const Stretch> todo);
  /// What depends on the labels that fell in the frame before.
  std::span<const Stretch> ToDoAfter(const Frame& ahead);
  /// Whether any label fell.
  template <Side kNear>
  bool FollowPaths(Targets targets);
  template <Side kNear>
  void SetPotentialsOf(Node& node);
  /// Of the arc between the node and the edge.
  Cost EdgeCost(const Node& node, Side side) const;

  const Network& network_;
  NodeStore& nodes_;
  std::vector<KernelMove> moves_;
  std::vector<double> edge_;                 // of one row: of the arcs between near and edge
  std::vector<std::vector<int>> obstacles_;  // by row: columns
  std::vector<Frame> frames_;
  std::vector<Stretch> all_, todo_;  // by row
  std::vector<double> fresh_;        // of one frame, by padded place
  std::vector<double> most_;         // of one frame, by cell: labels at the reach
  double reach_ = 0;
  double near_edge_ = 0;  // the edge's labels
  double far_edge_ = 0;
  bool near_edge_fell_ = false;
};

}  // namespace vantage::linking
