// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/flow_solver.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace vantage::linking {
namespace {

constexpr Cost kUnreached = std::numeric_limits<Cost>::max();
constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kExpansionsBetweenStopChecks = 1 << 14;

}  // namespace

FlowSolver::FlowSolver(const LayeredGraph& graph, const Effort& effort)
    : graph_(graph),
      effort_(effort),
      link_(std::size_t{2} * graph.node_count(), kUnused),
      potential_(std::size_t{2} * graph.node_count(), 0),
      label_(std::size_t{2} * graph.node_count(), Label{kUnreached, kEdge}) {
  for (Node node = 0; node < graph_.node_count(); ++node) {
    const bool blocked = graph_.obstacle[node % graph_.cells] != 0;
    const Link link = blocked ? kBlocked : graph_.node_cost[node] < 0 ? kOpen : kUnused;
    link_[At(node, kIn)] = link_[At(node, kOut)] = link;
  }
}

bool FlowSolver::Solve(const RunControl& control) {
  return SettleAll<kOut>(control) && SettleAll<kIn>(control);
}

template <FlowSolver::Side kNear>
bool FlowSolver::SettleAll(const RunControl& control) {
  const std::int64_t frames_before = kNear == kOut ? 0 : graph_.frames;
  std::vector<Vertex> waiting;
  for (Node node = 0; node < graph_.node_count(); ++node) {
    if (node % graph_.cells == 0) {
      control.Report(frames_before + node / graph_.cells, 2 * graph_.frames);
    }
    const QueueEntry start(0, At(node, kNear));
    if (link_[start.second] != kOpen) continue;
    const Outcome outcome = Search<kNear>(std::span(&start, 1), effort_.nearby, control);
    if (outcome == Outcome::kStopped) return false;
    if (outcome == Outcome::kGaveUp) waiting.push_back(start.second);
  }
  expansions_ = 0;
  const auto between_sweeps =
      static_cast<std::int64_t>(effort_.share_between_sweeps * graph_.node_count());
  for (std::size_t i = 0; i < waiting.size(); ++i) {
    if (expansions_ >= between_sweeps &&
        !Spread<Other(kNear)>(std::ssize(waiting) - static_cast<std::int64_t>(i), control)) {
      return false;
    }
    const QueueEntry start(0, waiting[i]);
    if (Search<kNear>(std::span(&start, 1), kUnlimited, control) == Outcome::kStopped) return false;
  }
  control.Report(frames_before + graph_.frames, 2 * graph_.frames);
  return true;
}

bool FlowSolver::KeepAtMost(std::int64_t count, const RunControl& control) {
  targets_ = Targets::kBeginnings;
  std::vector<Vertex> ends;
  for (Node node = 0; node < graph_.node_count(); ++node) {
    if (link_[At(node, kOut)] == kToEdge) ends.push_back(At(node, kOut));
  }
  std::vector<QueueEntry> starts;
  while (std::ssize(ends) > count) {
    starts.clear();
    for (const Vertex end : ends) {
      starts.emplace_back(edge_potential_[kOut] - graph_.exit_cost - potential_[end], end);
    }
    if (Search<kOut>(starts, kUnlimited, control) == Outcome::kStopped) return false;
    // The search began at the edge's end of paths, at distance 0 (see UpdatePotentials).
    edge_potential_[kOut] -= target_distance_;
    // Only the path's first vertex has stopped being an end.
    std::erase_if(ends, [&](Vertex end) { return link_[end] != kToEdge; });
  }
  return true;
}

// Dijkstra's algorithm on reduced costs from the vertices labelled so far. Reduced costs are at
// least 0, so a target is final as soon as nothing nearer is left in the queue, and vertices no
// nearer than the best target so far need no label: neither the path nor the new potentials depend
// on them.
template <FlowSolver::Side kNear>
FlowSolver::Outcome FlowSolver::Search(std::span<const QueueEntry> starts,
                                       std::int64_t most_expansions, const RunControl& control) {
  target_distance_ = kUnreached;
  for (const auto& [distance, vertex] : starts) {
    label_[vertex] = {distance, kEdge};
    reached_.push_back(vertex);
  }
  queue_.assign(starts.begin(), starts.end());
  std::make_heap(queue_.begin(), queue_.end(), std::greater<>());
  std::int64_t expansions = 0;
  while (!queue_.empty() && queue_.front().first < target_distance_) {
    if (expansions == most_expansions) {
      ForgetLabels();
      return Outcome::kGaveUp;
    }
    const auto [distance, vertex] = PopNearest();
    if (distance > label_[vertex].distance) continue;  // a nearer way was found meanwhile
    Expand<kNear>(vertex, distance);
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

template <FlowSolver::Side kNear>
bool FlowSolver::Spread(std::int64_t imbalances, const RunControl& control) {
  constexpr Side kFar = Other(kNear);
  targets_ = Targets::kNone;
  target_distance_ = kUnreached;
  StartSpread<kNear>();
  std::make_heap(queue_.begin(), queue_.end(), std::greater<>());
  for (std::int64_t expansions = 1; imbalances > 0; ++expansions) {
    const auto [distance, vertex] = PopNearest();
    if (distance > label_[vertex].distance) continue;
    if (SideOf(vertex) == kFar && link_[vertex] == kOpen && --imbalances == 0) {
      target_distance_ = distance;
      break;
    }
    Expand<kNear>(vertex, distance);
    if (expansions % kExpansionsBetweenStopChecks == 0 && control.Stopped()) return false;
  }
  // The edge itself is at distance 0.
  const Cost edge_change = Mirror<kNear>(-target_distance_);
  edge_potential_[kIn] += edge_change;
  edge_potential_[kOut] += edge_change;
  UpdatePotentials<kNear>();
  targets_ = Targets::kImbalances;
  expansions_ = 0;
  return true;
}

template <FlowSolver::Side kNear>
void FlowSolver::StartSpread() {
  constexpr Side kFar = Other(kNear);
  const Cost far_edge_cost = kFar == kOut ? graph_.exit_cost : graph_.entry_cost;
  const Cost near_edge_cost = kNear == kOut ? graph_.exit_cost : graph_.entry_cost;
  const Cost edge = Mirror<kNear>(edge_potential_[kNear]);
  queue_.clear();
  const auto start = [&](Vertex vertex, Cost distance) {
    label_[vertex] = {distance, kEdge};
    reached_.push_back(vertex);
    queue_.emplace_back(distance, vertex);
  };
  for (Node node = 0; node < graph_.node_count(); ++node) {
    const Vertex near = At(node, kNear);
    const Vertex far = At(node, kFar);
    if (link_[near] == kBlocked) continue;
    if (link_[near] == kOpen) {
      start(near, 0);
    } else if (link_[near] == kToEdge) {
      start(near, edge - near_edge_cost - Mirror<kNear>(potential_[near]));
    }
    const bool at_edge = kFar == kOut ? graph_.IsExit(node) : graph_.IsEntrance(node);
    if (at_edge && link_[far] != kToEdge) {
      start(far, edge + far_edge_cost - Mirror<kNear>(potential_[far]));
    }
  }
}

template <FlowSolver::Side kNear>
void FlowSolver::Expand(Vertex vertex, Cost distance) {
  constexpr Side kFar = Other(kNear);
  const Node node = NodeOf(vertex);
  const Cost base = distance + Mirror<kNear>(potential_[vertex]);
  const Vertex other_side = At(node, Other(SideOf(vertex)));
  if (SideOf(vertex) == kNear) {
    if (Carries(node)) Relax<kNear>(other_side, base - graph_.node_cost[node], vertex);
    const bool at_edge = kNear == kOut ? graph_.IsExit(node) : graph_.IsEntrance(node);
    if (targets_ == Targets::kImbalances && at_edge && link_[vertex] != kToEdge) {
      const Cost edge_cost = kNear == kOut ? graph_.exit_cost : graph_.entry_cost;
      OfferTarget(kEdge, base + edge_cost - Mirror<kNear>(edge_potential_[kNear]), vertex);
    }
    ExpandMoves<kNear>(node, base);
  } else if (!Carries(node)) {
    Relax<kNear>(other_side, base + graph_.node_cost[node], vertex);
  } else if (link_[vertex] == kToEdge) {
    if (targets_ == Targets::kNone) return;
    const Cost edge_cost = kFar == kOut ? graph_.exit_cost : graph_.entry_cost;
    OfferTarget(kEdge, base - edge_cost - Mirror<kNear>(edge_potential_[kFar]), vertex);
  } else if (link_[vertex] != kOpen) {
    const Move& move = graph_.moves[static_cast<std::size_t>(link_[vertex])];
    Relax<kNear>(At(Follow(node, kFar), kNear), base - move.cost, vertex);
  }
}

template <FlowSolver::Side kNear>
void FlowSolver::ExpandMoves(Node node, Cost base) {
  constexpr int kStep = kNear == kOut ? 1 : -1;
  if (kNear == kOut ? node >= graph_.node_count() - graph_.cells : node < graph_.cells) return;
  const Vertex from = At(node, kNear);
  const auto cell = static_cast<int>(node % graph_.cells);
  const int column = cell % graph_.columns;
  const int row = cell / graph_.columns;
  const std::int64_t below = std::int64_t{node} + kStep * std::int64_t{graph_.cells};
  for (std::size_t number = 0; number < graph_.moves.size(); ++number) {
    const Move& move = graph_.moves[number];
    const int to_column = column + kStep * move.columns;
    const int to_row = row + kStep * move.rows;
    if (to_column < 0 || to_column >= graph_.columns || to_row < 0 || to_row >= graph_.rows) {
      continue;
    }
    const auto to = At(static_cast<Node>(below + kStep * move.offset), Other(kNear));
    if (link_[to] == kBlocked || link_[from] == static_cast<Link>(number)) continue;
    Relax<kNear>(to, base + move.cost, from);
  }
}

/// `distance` is still without the potential of `to`.
template <FlowSolver::Side kNear>
void FlowSolver::Relax(Vertex to, Cost distance, Vertex from) {
  distance -= Mirror<kNear>(potential_[to]);
  if (distance >= target_distance_) return;
  if (targets_ != Targets::kNone && SideOf(to) != kNear && link_[to] == kOpen) {
    OfferTarget(to, distance, from);
    return;
  }
  Label& label = label_[to];
  if (distance >= label.distance) return;
  if (label.distance == kUnreached) reached_.push_back(to);
  label = {distance, from};
  queue_.emplace_back(distance, to);
  std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
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
template <FlowSolver::Side kNear>
void FlowSolver::UpdatePotentials() {
  for (const Vertex vertex : reached_) {
    if (label_[vertex].distance < target_distance_) {
      potential_[vertex] += Mirror<kNear>(label_[vertex].distance - target_distance_);
    }
  }
  ForgetLabels();
}

void FlowSolver::ForgetLabels() {
  for (const Vertex vertex : reached_) label_[vertex] = {kUnreached, kEdge};
  reached_.clear();
}

std::vector<FlowSolver::Arc> FlowSolver::PathToTarget() const {
  std::vector<Arc> arcs = {target_arc_};
  for (Vertex vertex = target_arc_.first; vertex != kEdge; vertex = label_[vertex].parent) {
    arcs.emplace_back(label_[vertex].parent, vertex);
  }
  return arcs;
}

void FlowSolver::PushFlowAlong(const std::vector<Arc>& arcs, Side near) {
  // Three rounds, so that no arc undoes what another has set: flow off the arcs between nodes, on
  // and off the nodes, on the arcs between nodes.
  for (const auto& [from, to] : arcs) {
    if (from == kEdge) {
      link_[to] = kOpen;
    } else if (SideOf(from) != near && (to == kEdge || NodeOf(to) != NodeOf(from))) {
      link_[from] = kOpen;
      if (to != kEdge) link_[to] = kOpen;
    }
  }
  for (const auto& [from, to] : arcs) {
    if (from == kEdge || to == kEdge || NodeOf(from) != NodeOf(to)) continue;
    link_[from] = link_[to] = SideOf(from) == near ? kUnused : kOpen;
  }
  for (const auto& [from, to] : arcs) {
    if (from == kEdge || SideOf(from) != near) continue;
    if (to == kEdge) {
      link_[from] = kToEdge;
    } else if (NodeOf(to) != NodeOf(from)) {
      link_[from] = link_[to] =
          LinkBetween(NodeOf(near == kOut ? from : to), NodeOf(near == kOut ? to : from));
    }
  }
}

FlowSolver::Link FlowSolver::LinkBetween(Node earlier, Node later) const {
  const auto earlier_cell = static_cast<int>(earlier % graph_.cells);
  const auto later_cell = static_cast<int>(later % graph_.cells);
  const int columns = later_cell % graph_.columns - earlier_cell % graph_.columns;
  const int rows = later_cell / graph_.columns - earlier_cell / graph_.columns;
  const auto move =
      std::find_if(graph_.moves.begin(), graph_.moves.end(), [&](const Move& candidate) {
        return candidate.columns == columns && candidate.rows == rows;
      });
  return static_cast<Link>(move - graph_.moves.begin());
}

Node FlowSolver::Follow(Node node, Side side) const {
  const Move& move = graph_.moves[static_cast<std::size_t>(link_[At(node, side)])];
  const std::int64_t step = std::int64_t{graph_.cells} + move.offset;
  return static_cast<Node>(node + (side == kOut ? step : -step));
}

std::vector<LinkedPath> FlowSolver::Paths() const {
  std::vector<LinkedPath> paths;
  for (Node first = 0; first < graph_.node_count(); ++first) {
    if (link_[At(first, kIn)] != kToEdge) continue;
    LinkedPath& path = paths.emplace_back();
    path.first_frame = first / graph_.cells;
    Node node = first;
    path.cells.push_back(static_cast<CellIndex>(node % graph_.cells));
    while (link_[At(node, kOut)] != kToEdge) {
      node = Follow(node, kOut);
      path.cells.push_back(static_cast<CellIndex>(node % graph_.cells));
    }
  }
  return paths;
}

Cost FlowSolver::TotalCost() const {
  Cost total = 0;
  for (Node node = 0; node < graph_.node_count(); ++node) {
    if (!Carries(node)) continue;
    total += graph_.node_cost[node];
    if (link_[At(node, kIn)] == kToEdge) total += graph_.entry_cost;
    const Link next = link_[At(node, kOut)];
    total += next == kToEdge ? graph_.exit_cost : graph_.moves[static_cast<std::size_t>(next)].cost;
  }
  return total;
}

}  // namespace vantage::linking
