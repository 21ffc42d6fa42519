// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/flow_solver.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace vantage::linking {
namespace {

constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max();
constexpr double kEverywhere = std::numeric_limits<double>::infinity();
constexpr double kFarthest = 0x1p40;
constexpr std::int64_t kExpansionsBetweenStopChecks = 1 << 14;

template <Side kNear>
constexpr Cost Mirror(Cost potential) {
  return kNear == kOut ? potential : -potential;
}

}  // namespace

FlowSolver::FlowSolver(const Network& network, const SearchEffort& effort)
    : network_(network), effort_(effort), nodes_(network), last_exit_cost_(network.exit_cost) {}

void FlowSolver::AddFrame(std::span<const float> probability) {
  if (nodes_.end_frame() > nodes_.first_frame()) ReopenLastFrame();
  const std::vector<NodeId> people = nodes_.AddFrame(probability);
  for (const NodeId id : people) nodes_[id].link[kIn] = nodes_[id].link[kOut] = kOpen;
  open_.insert(open_.end(), people.begin(), people.end());
  if (nodes_.end_frame() - 1 > nodes_.first_frame()) SetFirstPotentials();
}

// An exit arc that comes into being again, at the full cost, needs y(out(v)) >= -cost. To raise
// y(out(v)) of a path's end takes nothing from any other arc: the next frame has none yet, and
// those within the node come from out(v).
void FlowSolver::ReopenLastFrame() {
  const auto first = std::ssize(open_);
  nodes_.ForEach(nodes_.end_frame() - 1, [this](NodeId id) {
    Node& node = nodes_[id];
    if (node.link[kOut] != kToEdge) return;
    node.link[kOut] = kOpen;
    node.potential[kOut] = std::max(node.potential[kOut], -network_.exit_cost);
    open_.push_back(id);
  });
  std::sort(open_.begin() + first, open_.end());
}

void FlowSolver::CloseEnd() {
  ReopenLastFrame();
  last_exit_cost_ = network_.exit_cost;
}

// With y(in(w)) = min(0, min over moves of y(out(v)) + cost) the moves keep the condition, and the
// entries, which cost at least 0, do too. A node that carries flow (c < 0) needs y(out(w)) >=
// y(in(w)) + c, and y(out(w)) >= -exit cost (of the last frame) since w is an exit: 0 will do. One
// that carries none needs y(out(w)) in [-exit cost, y(in(w)) + c]; where that is empty a path
// through w would pay already, and w carries flow from the start. Nodes that no y(out(v)) < 0
// reaches keep y = 0.
void FlowSolver::SetFirstPotentials() {
  const std::int64_t frame = nodes_.end_frame() - 1;
  std::vector<NodeId> before;
  nodes_.ForEach(frame - 1, [&](NodeId id) {
    if (nodes_[id].potential[kOut] < 0) before.push_back(id);
  });
  std::sort(before.begin(), before.end());
  std::vector<NodeId> lowered;
  for (const NodeId id : before) {
    const Node from = nodes_[id];
    for (const Move& move : network_.moves) {
      const Cost potential = from.potential[kOut] + move.cost;
      const int column = from.column + move.columns;
      const int row = from.row + move.rows;
      if (potential >= 0 || !network_.Contains(column, row) ||
          network_.obstacle[network_.Cell(column, row)] != 0) {
        continue;
      }
      const NodeId to = nodes_.FindOrAdd(frame, column, row);
      if (nodes_[to].potential[kIn] == 0) lowered.push_back(to);
      nodes_[to].potential[kIn] = std::min(nodes_[to].potential[kIn], potential);
    }
  }
  for (const NodeId id : lowered) {
    Node& node = nodes_[id];
    if (node.Carries()) continue;
    const Cost highest = node.potential[kIn] + node.cost;
    node.potential[kOut] = std::clamp<Cost>(highest, -last_exit_cost_, 0);
    if (highest >= -last_exit_cost_) continue;
    node.link[kIn] = node.link[kOut] = kOpen;
    open_.push_back(id);
  }
}

bool FlowSolver::Settle(const RunControl& control) {
  if (effort_.reach > 0) SweepPotentials<kIn>(effort_.reach * kUnitsPerCost);
  if (!SettleAll<kIn>(control) || !SettleAll<kOut>(control)) return false;
  open_.clear();
  return true;
}

template <Side kNear>
bool FlowSolver::SettleAll(const RunControl& control) {
  const std::int64_t frames = nodes_.end_frame() - nodes_.first_frame();
  const std::int64_t frames_before = kNear == kIn ? 0 : frames;
  std::int64_t reported = -1;
  std::vector<Vertex> waiting;
  const auto settle = [&](NodeId id) {
    const Vertex vertex = At(id, kNear);
    const std::int64_t done = kNear == kOut ? nodes_.end_frame() - 1 - nodes_[id].frame
                                            : nodes_[id].frame - nodes_.first_frame();
    if (done > reported) control.Report(frames_before + done, 2 * frames);
    reported = std::max(reported, done);
    if (LinkOf(vertex) != kOpen) return true;
    const QueueEntry start = Entry<kNear>(0, vertex);
    const Outcome outcome = Search<kNear>(std::span(&start, 1), effort_.nearby, control);
    if (outcome == Outcome::kGaveUp) waiting.push_back(vertex);
    return outcome != Outcome::kStopped;
  };
  // Against the direction of the search: what lies ahead is linked already, what lies behind is
  // not, so that no search slides back along paths, on which reduced costs are 0, to their other
  // end.
  if (kNear == kOut ? !std::all_of(open_.rbegin(), open_.rend(), settle)
                    : !std::all_of(open_.begin(), open_.end(), settle)) {
    return false;
  }
  const std::int64_t nodes = frames * static_cast<std::int64_t>(network_.cells());
  const auto between_sweeps =
      static_cast<std::int64_t>(effort_.share_between_sweeps * static_cast<double>(nodes));
  expansions_ = between_sweeps;
  double reach = effort_.reach * kUnitsPerCost;
  for (const Vertex vertex : waiting) {
    if (effort_.reach > 0 && expansions_ >= between_sweeps) {
      SweepPotentials<kNear>(reach);
      reach = reach < kFarthest ? 2 * reach : kEverywhere;
    }
    const QueueEntry start = Entry<kNear>(0, vertex);
    if (Search<kNear>(std::span(&start, 1), kUnlimited, control) == Outcome::kStopped) return false;
  }
  control.Report(frames_before + frames, 2 * frames);
  return true;
}

bool FlowSolver::KeepAtMost(std::int64_t count, const RunControl& control) {
  targets_ = Targets::kBeginnings;
  std::vector<Vertex> ends;
  for (std::int64_t frame = nodes_.first_frame(); frame < nodes_.end_frame(); ++frame) {
    nodes_.ForEach(frame, [&](NodeId id) {
      if (nodes_[id].link[kOut] == kToEdge) ends.push_back(At(id, kOut));
    });
  }
  std::vector<QueueEntry> starts;
  while (std::ssize(ends) > count) {
    SweepPotentials<kOut>(kEverywhere);
    starts.clear();
    for (const Vertex end : ends) {
      starts.push_back(Entry<kOut>(
          edge_potential_[kOut] - EdgeCost(nodes_[NodeOf(end)], kOut) - PotentialOf(end), end));
    }
    if (Search<kOut>(starts, kUnlimited, control) == Outcome::kStopped) return false;
    // The search began at the edge's end of paths, at distance 0 (see UpdatePotentials).
    edge_potential_[kOut] -= target_distance_;
    // Only the path's first vertex has stopped being an end.
    std::erase_if(ends, [&](Vertex end) { return LinkOf(end) != kToEdge; });
  }
  return true;
}

// Dijkstra's algorithm on reduced costs from the vertices labelled so far. Reduced costs are at
// least 0, so a target is final as soon as nothing nearer is left in the queue, and vertices no
// nearer than the best target so far need no label: neither the path nor the new potentials depend
// on them.
template <Side kNear>
FlowSolver::Outcome FlowSolver::Search(std::span<const QueueEntry> starts,
                                       std::int64_t most_expansions, const RunControl& control) {
  target_distance_ = kUnreached;
  for (const QueueEntry& start : starts) {
    DistanceOf(start.vertex) = start.distance;
    nodes_[NodeOf(start.vertex)].parent[SideOf(start.vertex)] = kEdge;
    reached_.push_back(start.vertex);
  }
  queue_.assign(starts.begin(), starts.end());
  std::make_heap(queue_.begin(), queue_.end(), std::greater<>());
  std::int64_t expansions = 0;
  while (!queue_.empty() && queue_.front().distance < target_distance_) {
    if (expansions == most_expansions) {
      ForgetLabels();
      return Outcome::kGaveUp;
    }
    const QueueEntry nearest = PopNearest();
    if (nearest.distance > DistanceOf(nearest.vertex)) continue;  // a nearer way was found since
    Expand<kNear>(nearest.vertex, nearest.distance);
    if (++expansions % kExpansionsBetweenStopChecks == 0 && control.Stopped()) {
      return Outcome::kStopped;
    }
  }
  if (control.Stopped()) return Outcome::kStopped;
  expansions_ += expansions;
  PushFlowAlong(PathToTarget(), kNear);
  UpdatePotentials<kNear>();
  return Outcome::kFound;
}

template <Side kNear>
void FlowSolver::SweepPotentials(double reach) {
  Sweep(network_, nodes_).SetPotentials<kNear>(targets_, reach, edge_potential_);
  expansions_ = 0;
}

template <Side kNear>
void FlowSolver::Expand(Vertex vertex, Cost distance) {
  constexpr Side kFar = Other(kNear);
  const NodeId id = NodeOf(vertex);
  const Node& node = nodes_[id];
  const Side side = SideOf(vertex);
  const Link link = node.link[side];
  const Cost base = distance + Mirror<kNear>(node.potential[side]);
  const Vertex other_side = At(id, Other(side));
  if (side == kNear) {
    if (node.Carries()) Relax<kNear>(other_side, base - node.cost, vertex);
    const Cost edge_cost = EdgeCost(node, kNear);
    if (targets_ == Targets::kImbalances && edge_cost < kNever && link != kToEdge) {
      OfferTarget(kEdge, base + edge_cost - Mirror<kNear>(edge_potential_[kNear]), vertex);
    }
    ExpandMoves<kNear>(id, base);
  } else if (!node.Carries()) {
    Relax<kNear>(other_side, base + node.cost, vertex);
  } else if (link == kToEdge) {
    OfferTarget(kEdge, base - EdgeCost(node, kFar) - Mirror<kNear>(edge_potential_[kFar]), vertex);
  } else if (IsNode(link)) {
    Relax<kNear>(At(link, kNear), base - MoveCost(node, nodes_[link]), vertex);
  }
}

// Nodes that are here first: a target among them may make it needless to add others.
template <Side kNear>
void FlowSolver::ExpandMoves(NodeId id, Cost base) {
  constexpr int kStep = kNear == kOut ? 1 : -1;
  constexpr Side kFar = Other(kNear);
  const Node from = nodes_[id];
  const std::int64_t frame = from.frame + kStep;
  if (frame < nodes_.first_frame() || frame >= nodes_.end_frame()) return;
  absent_.clear();
  for (const Move& move : network_.moves) {
    const int column = from.column + kStep * move.columns;
    const int row = from.row + kStep * move.rows;
    if (!network_.Contains(column, row)) continue;
    const NodeId to = nodes_.Find(frame, column, row);
    if (to == kNoNode) {
      absent_.push_back(&move);
    } else if (to != from.link[kNear]) {
      Relax<kNear>(At(to, kFar), base + move.cost, At(id, kNear));
    }
  }
  for (const Move* move : absent_) {
    const int column = from.column + kStep * move->columns;
    const int row = from.row + kStep * move->rows;
    if (network_.obstacle[network_.Cell(column, row)] != 0) continue;
    const Cost potential = nodes_.PotentialOf(frame, column, row, kFar);
    if (base + move->cost - Mirror<kNear>(potential) >= target_distance_) continue;
    const NodeId to = nodes_.FindOrAdd(frame, column, row);
    Relax<kNear>(At(to, kFar), base + move->cost, At(id, kNear));
  }
}

/// `distance` is still without the potential of `to`.
template <Side kNear>
void FlowSolver::Relax(Vertex to, Cost distance, Vertex from) {
  Node& node = nodes_[NodeOf(to)];
  const Side side = SideOf(to);
  distance -= Mirror<kNear>(node.potential[side]);
  if (distance >= target_distance_) return;
  if (side != kNear && node.link[side] == kOpen) {
    OfferTarget(to, distance, from);
    return;
  }
  if (distance >= node.distance[side]) return;
  if (node.distance[side] == kUnreached) reached_.push_back(to);
  node.distance[side] = distance;
  node.parent[side] = from;
  queue_.push_back(Entry<kNear>(distance, to));
  std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
}

template <Side kNear>
FlowSolver::QueueEntry FlowSolver::Entry(Cost distance, Vertex vertex) const {
  const std::int32_t frame = nodes_[NodeOf(vertex)].frame;
  return {distance, kNear == kOut ? -frame : frame, vertex};
}

void FlowSolver::OfferTarget(Vertex target, Cost distance, Vertex from) {
  if (distance >= target_distance_) return;
  target_distance_ = distance;
  target_arc_ = {from, target};
}

FlowSolver::QueueEntry FlowSolver::PopNearest() {
  std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
  const QueueEntry nearest = queue_.back();
  queue_.pop_back();
  return nearest;
}

// New potentials, shifted so that only vertices nearer than the target change: y + min(d, D) - D
// instead of y + min(d, D). Only differences count, and so a local search stays local.
template <Side kNear>
void FlowSolver::UpdatePotentials() {
  for (const Vertex vertex : reached_) {
    const Cost nearer = DistanceOf(vertex) - target_distance_;
    if (nearer < 0) PotentialOf(vertex) += Mirror<kNear>(nearer);
  }
  ForgetLabels();
}

void FlowSolver::ForgetLabels() {
  for (const Vertex vertex : reached_) DistanceOf(vertex) = kUnreached;
  reached_.clear();
}

std::vector<FlowSolver::Arc> FlowSolver::PathToTarget() const {
  std::vector<Arc> arcs = {target_arc_};
  for (Vertex vertex = target_arc_.first; vertex != kEdge;) {
    const Vertex parent = nodes_[NodeOf(vertex)].parent[SideOf(vertex)];
    arcs.emplace_back(parent, vertex);
    vertex = parent;
  }
  return arcs;
}

void FlowSolver::PushFlowAlong(const std::vector<Arc>& arcs, Side near) {
  // Three rounds, so that no arc undoes what another has set: flow off the arcs between nodes, on
  // and off the nodes, on the arcs between nodes.
  for (const auto& [from, to] : arcs) {
    if (from == kEdge) {
      LinkOf(to) = kOpen;
    } else if (SideOf(from) != near && (to == kEdge || NodeOf(to) != NodeOf(from))) {
      LinkOf(from) = kOpen;
      if (to != kEdge) LinkOf(to) = kOpen;
    }
  }
  for (const auto& [from, to] : arcs) {
    if (from == kEdge || to == kEdge || NodeOf(from) != NodeOf(to)) continue;
    LinkOf(from) = LinkOf(to) = SideOf(from) == near ? kUnused : kOpen;
  }
  for (const auto& [from, to] : arcs) {
    if (from == kEdge || SideOf(from) != near) continue;
    if (to == kEdge) {
      LinkOf(from) = kToEdge;
    } else if (NodeOf(to) != NodeOf(from)) {
      LinkOf(from) = NodeOf(to);
      LinkOf(to) = NodeOf(from);
    }
  }
}

void FlowSolver::DropFrame() {
  nodes_.ForEach(nodes_.first_frame(), [this](NodeId id) {
    if (IsNode(nodes_[id].link[kOut])) nodes_[nodes_[id].link[kOut]].link[kIn] = kFinal;
  });
  nodes_.DropFrame();
}

Cost FlowSolver::LeastReducedCost() const {
  Cost least = kUnreached;
  // The node at a place, touched or not.
  const auto node_at = [this](std::int64_t frame, int column, int row) {
    const NodeId id = nodes_.Find(frame, column, row);
    if (id != kNoNode) return nodes_[id];
    Node node = {.frame = static_cast<std::int32_t>(frame),
                 .column = static_cast<std::int16_t>(column),
                 .row = static_cast<std::int16_t>(row),
                 .cost = nodes_.CostOf(frame, column, row)};
    for (const Side side : {kIn, kOut}) {
      node.potential[side] = nodes_.PotentialOf(frame, column, row, side);
    }
    return node;
  };
  const auto arc = [&least](bool carries, Cost cost, Cost from, Cost to) {
    const Cost reduced = cost + from - to;
    least = std::min(least, carries ? -reduced : reduced);
  };
  for (std::int64_t frame = nodes_.first_frame(); frame < nodes_.end_frame(); ++frame) {
    for (std::size_t cell = 0; cell < network_.cells(); ++cell) {
      if (network_.obstacle[cell] != 0) continue;
      const auto column = static_cast<int>(cell) % network_.columns;
      const auto row = static_cast<int>(cell) / network_.columns;
      const Node node = node_at(frame, column, row);
      arc(node.Carries(), node.cost, node.potential[kIn], node.potential[kOut]);
      if (const Cost cost = EdgeCost(node, kIn); cost < kNever) {
        arc(node.link[kIn] == kToEdge, cost, edge_potential_[kIn], node.potential[kIn]);
      }
      if (const Cost cost = EdgeCost(node, kOut); cost < kNever) {
        arc(node.link[kOut] == kToEdge, cost, node.potential[kOut], edge_potential_[kOut]);
      }
      if (frame + 1 == nodes_.end_frame()) continue;
      for (const Move& move : network_.moves) {
        const int to_column = column + move.columns;
        const int to_row = row + move.rows;
        if (!network_.Contains(to_column, to_row) ||
            network_.obstacle[network_.Cell(to_column, to_row)] != 0) {
          continue;
        }
        const NodeId to = nodes_.Find(frame + 1, to_column, to_row);
        arc(to != kNoNode && node.link[kOut] == to, move.cost, node.potential[kOut],
            node_at(frame + 1, to_column, to_row).potential[kIn]);
      }
    }
  }
  return least;
}

std::vector<LinkedPath> FlowSolver::Paths() const {
  std::vector<LinkedPath> paths;
  std::vector<std::pair<CellIndex, NodeId>> beginnings;
  const auto cell = [this](NodeId id) {
    return static_cast<CellIndex>(network_.Cell(nodes_[id].column, nodes_[id].row));
  };
  for (std::int64_t frame = nodes_.first_frame(); frame < nodes_.end_frame(); ++frame) {
    beginnings.clear();
    nodes_.ForEach(frame, [&](NodeId id) {
      if (nodes_[id].link[kIn] == kToEdge) beginnings.emplace_back(cell(id), id);
    });
    std::sort(beginnings.begin(), beginnings.end());
    for (const auto& [first_cell, first] : beginnings) {
      LinkedPath& path = paths.emplace_back();
      path.first_frame = frame;
      for (Link link = first; link != kToEdge; link = nodes_[link].link[kOut]) {
        path.cells.push_back(cell(link));
      }
    }
  }
  return paths;
}

Cost FlowSolver::FrameCost(std::int64_t frame) const {
  Cost total = 0;
  nodes_.ForEach(frame, [&](NodeId id) {
    const Node& node = nodes_[id];
    if (!node.Carries()) return;
    total += node.cost;
    if (node.link[kIn] == kToEdge) total += EdgeCost(node, kIn);
    const Link next = node.link[kOut];
    total += next == kToEdge ? EdgeCost(node, kOut) : MoveCost(node, nodes_[next]);
  });
  return total;
}

Cost FlowSolver::TotalCost() const {
  Cost total = 0;
  for (std::int64_t frame = nodes_.first_frame(); frame < nodes_.end_frame(); ++frame) {
    total += FrameCost(frame);
  }
  return total;
}

}  // namespace vantage::linking
