// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

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
  Cost SetPotentials(Targets targets);

  /// One pass over every arc: what the first round does, for measuring.
  void PassOnce() { FirstPass<kOut>(); }

 private:
  // Frames in the order of a pass against the direction of kNear.
  template <Side kNear>
  std::int64_t FrameAt(std::int64_t step) const {
    return kNear == kOut ? nodes_.end_frame() - 1 - step : nodes_.first_frame() + step;
  }
  std::int64_t frames() const { return nodes_.end_frame() - nodes_.first_frame(); }
  std::vector<double>& Far(std::int64_t frame) {
    return far_[static_cast<std::size_t>(frame - nodes_.first_frame())];
  }

  std::uint8_t& Fell(std::int64_t frame) {
    return fell_[static_cast<std::size_t>(frame - nodes_.first_frame())];
  }

  template <Side kNear>
  void StartCarriers(Targets targets);
  template <Side kNear>
  void FirstPass();
  template <Side kNear>
  void DoFrame(std::int64_t step);
  /// Whether any distance fell.
  template <Side kNear>
  bool FollowPaths(Targets targets);
  template <Side kNear>
  void SetPotentialsOf(Node& node);
  void SetCosts(std::span<const float> probability);
  std::size_t Padded(int column, int row) const {
    return static_cast<std::size_t>(column + depth_ + (row + depth_) * stride_);
  }

  const Network& network_;
  NodeStore& nodes_;
  const int depth_;
  const int stride_;  // of padded frames: columns, and as many as a move may cross on both sides
  std::vector<KernelMove> moves_;
  std::vector<std::size_t> access_;        // padded places
  std::vector<std::size_t> obstacles_;     // cells
  std::vector<double> padded_far_, near_;  // of one frame, by padded place
  std::vector<double> cost_;               // of one frame, by cell
  std::vector<std::size_t> uncommon_;      // cells whose cost_ is not the common one
  float common_ = 0;
  double common_cost_ = 0;
  std::vector<double> fresh_;             // of one frame, by cell
  std::vector<std::vector<double>> far_;  // by frame, by cell
  std::vector<std::uint8_t> fell_;        // by frame: far_ changed after it was last used
  double near_edge_ = 0;
  bool near_edge_fell_ = false;
};

}  // namespace vantage::linking
