// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/linking/node_store.h"
#include "vantage/linking/sweep_kernel.h"

/// Internal to the linking module.

namespace vantage::linking {

/// What a sweep measures distances to.
enum class Targets {
  kImbalances,  ///< nodes that lack a unit (or have one too many), and the edge
  kBeginnings,  ///< the edge where paths begin; paths that end there may be taken up again
};

/// Distances of all vertices to the nearest target in the residual network of a flow (see
/// FlowSolver), by dynamic programming over whole frames: every arc once, without a queue.
///
/// Moves lead one frame ahead, so that one pass against time gives the distances over all arcs but
/// those that the flow has reversed. These lead back along the paths, which are few: a pass in time
/// over the nodes that carry flow relaxes them. The two alternate until nothing changes; a frame is
/// done again only if distances in the next one fell. (With no path yet, as at first, nothing
/// changes after the first pass.) At the end every residual arc u -> w has d(u) <= cost + d(w): the
/// labels are shortest distances, as those of Bellman and Ford's algorithm, of which this is an
/// order of relaxing. There is no negative cycle because the flow is optimal for its imbalances.
///
/// Every vertex has a target within reach: from a node that carries no flow one can stay until the
/// last frame, an exit, or until the place is taken by a path; from a node that carries flow one
/// can go back along its path, to a lack or to the path's entry.
class Sweep {
 public:
  Sweep(const Network& network, NodeStore& nodes);

  /// Sets all potentials to the distances, negated for kNear = kOut: then all reduced costs are at
  /// least 0, and 0 along the shortest paths. For kNear = kIn the same in mirror image: distances
  /// from the targets, time reversed. No frame was dropped. Returns the distance of the edge on the
  /// side of kNear.
  template <Side kNear>
  Cost SetPotentials(Targets targets, double most);

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
    /// Distances on the far side, by padded place; infinite outside the grid and at obstacles.
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
  void StartCarriers(Targets targets);
  template <Side kNear>
  void FirstPass();
  /// Does the `todo` of a frame again (by row; none empty: all of it).
  template <Side kNear>
  void DoFrame(std::int64_t step, std::span<const Stretch> todo);
  template <Side kNear>
  void DoStretch(std::int64_t step, int row, Stretch stretch, double* out);
  /// What depends on the distances that fell in the frame before.
  std::span<const Stretch> ToDoAfter(const Frame& ahead);
  /// Whether any distance fell.
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
  double most_ = 0;
  double near_edge_ = 0;
  bool near_edge_fell_ = false;
};

}  // namespace vantage::linking
