// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/residual_network.h"

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace vantage::linking {
namespace {

constexpr Cost kUnreached = std::numeric_limits<Cost>::max();

tl::unexpected<Error> NoSolution(std::int64_t frame, CellIndex cell) {
  return Fail(
      "linking: the paths are not a solution of the problem at frame {}, cell {}; alternatives "
      "exist for the answer of LinkPaths to the same problem and options",
      frame, cell);
}

}  // namespace

Result<ResidualNetwork> ResidualNetwork::Create(const LinkingProblem& problem,
                                                const LinkingOptions& options,
                                                const std::vector<LinkedPath>& paths,
                                                std::int64_t first, std::int64_t last,
                                                const RunControl& control) {
  const std::int64_t cells = std::int64_t{problem.columns} * problem.rows;
  if (first < 0 || first > last || last >= problem.frames || cells < 1 ||
      std::ssize(problem.probability) != cells * problem.frames) {
    return Fail("linking: frames {} to {} are not in a problem of {} frames", first, last,
                problem.frames);
  }
  ResidualNetwork network;
  VANTAGE_ASSIGN_OR_RETURN(network.network_, MakeNetwork(GridOf(problem), options));
  network.cells_ = static_cast<Node>(cells);
  network.frames_ = last - first + 1;
  for (std::int64_t frame = first; frame <= last; ++frame) {
    const auto map = problem.probability.subspan(static_cast<std::size_t>(frame * cells),
                                                 static_cast<std::size_t>(cells));
    VANTAGE_RETURN_IF_ERROR(CheckFrame(network.network_, map, frame));
    for (const float p : map) network.node_cost_.push_back(network.network_.node_cost(p));
  }
  network.first_ = first;
  network.from_beginning_ = first == 0;
  network.to_end_ = last == problem.frames - 1;
  network.path_count_ = std::ssize(paths);
  network.may_add_ = options.max_paths == 0 || network.path_count_ < options.max_paths;
  VANTAGE_RETURN_IF_ERROR(network.Occupy(paths));
  VANTAGE_RETURN_IF_ERROR(network.FindPotentials(control));
  network.label_.assign(2 * std::size_t{network.vertex_count()}, {kUnreached, 0});
  return network;
}

bool ResidualNetwork::IsEntrance(Node node) const {
  return network_.obstacle[node % cells_] == 0 && EntryCost(node) < kNever;
}

Cost ResidualNetwork::EntryCost(Node node) const {
  return from_beginning_ && node < cells_ ? network_.entry_cost
                                          : network_.entry_costs[node % cells_];
}

Cost ResidualNetwork::ExitCost(Node node) const {
  return to_end_ && node >= node_count() - cells_ ? network_.exit_cost
                                                  : network_.exit_costs[node % cells_];
}

bool ResidualNetwork::IsExit(Node node) const {
  return network_.obstacle[node % cells_] == 0 && ExitCost(node) < kNever;
}

Status ResidualNetwork::Occupy(const std::vector<LinkedPath>& paths) {
  next_.assign(node_count(), kFree);
  previous_.assign(node_count(), kFree);
  for (const LinkedPath& path : paths) {
    const std::int64_t begin = std::max(path.first_frame, first_);
    const std::int64_t end = std::min(path.end_frame(), first_ + frames_);
    for (std::int64_t frame = begin; frame < end; ++frame) {
      VANTAGE_RETURN_IF_ERROR(OccupyStep(path, frame - path.first_frame));
    }
  }
  for (Node node = 0; node < node_count(); ++node) {
    if (IsEntrance(node)) entrances_.push_back(node);
    if (next_[node] == kEdge) lasts_.push_back(node);
  }
  return {};
}

Status ResidualNetwork::OccupyStep(const LinkedPath& path, std::int64_t step) {
  const std::int64_t frame = path.first_frame + step;
  const CellIndex cell = path.cells[static_cast<std::size_t>(step)];
  const auto cells = static_cast<CellIndex>(cells_);
  if (cell < 0 || cell >= cells) return NoSolution(frame, cell);
  const Node node = NodeAt(frame, cell);
  if (next_[node] != kFree || network_.obstacle[node % cells_] != 0) {
    return NoSolution(frame, cell);
  }
  const bool begins = step == 0;
  const bool ends = step + 1 == std::ssize(path.cells);
  if ((begins && !IsEntrance(node)) || (ends && !IsExit(node))) return NoSolution(frame, cell);
  previous_[node] = begins ? kEdge
                    : frame == first_
                        ? kBeyond
                        : NodeAt(frame - 1, path.cells[static_cast<std::size_t>(step - 1)]);
  next_[node] = kEdge;
  if (ends) return {};
  next_[node] = kBeyond;
  if (frame + 1 == first_ + frames_) return {};
  const CellIndex to = path.cells[static_cast<std::size_t>(step + 1)];
  if (to < 0 || to >= cells || MoveCost(cell, to) < 0) return NoSolution(frame + 1, to);
  next_[node] = NodeAt(frame + 1, to);
  return {};
}

Cost ResidualNetwork::MoveCost(CellIndex from, CellIndex to) const {
  const int columns = to % network_.columns - from % network_.columns;
  const int rows = to / network_.columns - from / network_.columns;
  const auto move = std::find_if(network_.moves.begin(), network_.moves.end(), [&](const Move& m) {
    return m.columns == columns && m.rows == rows;
  });
  return move == network_.moves.end() ? -1 : move->cost;
}

template <class Visit>
void ResidualNetwork::ForEachMove(Node node, const Visit& visit) const {
  const Node first_of_next = (node / cells_ + 1) * cells_;
  if (first_of_next == node_count()) return;
  const int column = static_cast<int>(node % cells_) % network_.columns;
  const int row = static_cast<int>(node % cells_) / network_.columns;
  for (const Move& move : network_.moves) {
    const int to_column = column + move.columns;
    const int to_row = row + move.rows;
    if (to_column < 0 || to_column >= network_.columns || to_row < 0 || to_row >= network_.rows) {
      continue;
    }
    const auto cell = static_cast<Node>(to_column + to_row * network_.columns);
    if (network_.obstacle[cell] == 0) visit(first_of_next + cell, move.cost);
  }
}

template <class Visit>
void ResidualNetwork::ForEachArc(Vertex vertex, const Visit& visit) const {
  if (vertex == source()) {
    for (const Node node : entrances_) {
      if (previous_[node] != kEdge) visit(In(node), EntryCost(node));
    }
    if (path_count_ > 0) visit(sink(), Cost{0});
    return;
  }
  if (vertex == sink()) {
    for (const Node node : lasts_) visit(Out(node), -ExitCost(node));
    if (may_add_) visit(source(), Cost{0});
    return;
  }
  const Node node = vertex / 2;
  const Cost cost = node_cost_[node];
  const Node previous = previous_[node];
  if (vertex == In(node)) {
    if (network_.obstacle[node % cells_] != 0) return;
    if (previous == kFree) {
      visit(Out(node), cost);
    } else if (previous == kEdge) {
      visit(source(), -EntryCost(node));
    } else if (previous != kBeyond) {
      visit(Out(previous), -MoveCost(static_cast<CellIndex>(previous % cells_),
                                     static_cast<CellIndex>(node % cells_)));
    }
    return;
  }
  if (previous != kFree) visit(In(node), -cost);
  if (IsExit(node) && next_[node] != kEdge) visit(sink(), ExitCost(node));
  if (network_.obstacle[node % cells_] != 0) return;
  ForEachMove(node, [&](Node to, Cost move_cost) {
    if (to != next_[node]) visit(In(to), move_cost);
  });
}

Cost ResidualNetwork::SumOfNegativeArcs() const {
  Cost sum = 0;
  for (Vertex vertex = 0; vertex < vertex_count(); ++vertex) {
    ForEachArc(vertex, [&](Vertex, Cost cost) { sum += std::min<Cost>(cost, 0); });
  }
  return sum;
}

/// Label correcting (section 5.4), begun from 0 everywhere: each potential becomes the length of
/// the shortest residual path that ends there, so most stay 0, and no reduced cost is negative.
Status ResidualNetwork::FindPotentials(const RunControl& control) {
  // Only a cycle of negative cost can bring a path below this.
  const Cost lowest = SumOfNegativeArcs();
  potential_.assign(vertex_count(), 0);
  std::vector<std::uint8_t> waits(vertex_count(), 1);
  std::deque<Vertex> queue;
  for (Vertex vertex = 0; vertex < vertex_count(); ++vertex) queue.push_back(vertex);
  bool optimal = true;
  for (std::int64_t count = 0; !queue.empty() && optimal; ++count) {
    if (count % 65536 == 0 && control.Stopped()) return Cancelled();
    const Vertex vertex = queue.front();
    queue.pop_front();
    waits[vertex] = 0;
    ForEachArc(vertex, [&](Vertex to, Cost cost) {
      if (Reduced(vertex, to, cost) >= 0) return;
      potential_[to] = potential_[vertex] + cost;
      optimal = optimal && potential_[to] >= lowest;
      if (waits[to] == 0) queue.push_back(to);
      waits[to] = 1;
    });
  }
  if (optimal) return {};
  return Fail(
      "linking: the paths are not an optimal solution; alternatives exist for the answer of "
      "LinkPaths to the same problem and options");
}

template <class Touches>
bool ResidualNetwork::Search(State start, State target, Cost bound, const Touches& touches) {
  for (const State state : reached_) label_[state].distance = kUnreached;
  reached_.clear();
  using Entry = std::pair<Cost, State>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto reach = [&](State state, Cost distance, State parent) {
    Label& label = label_[state];
    if (distance >= label.distance || distance >= bound) return;
    if (label.distance == kUnreached) reached_.push_back(state);
    label = {distance, parent};
    queue.emplace(distance, state);
  };
  reach(start, 0, start);
  while (!queue.empty()) {
    const Cost distance = queue.top().first;
    const State state = queue.top().second;
    queue.pop();
    if (state == target) return true;
    if (distance > label_[state].distance) continue;
    const State layer = state / vertex_count();
    const Vertex vertex = state % vertex_count();
    ForEachArc(vertex, [&](Vertex to, Cost cost) {
      // No further path takes the arc that takes one away.
      if (vertex == source() && to == sink() && target == sink()) return;
      const State to_layer = layer != 0 || touches(to) ? 1 : 0;
      reach(to + to_layer * vertex_count(), distance + Reduced(vertex, to, cost), state);
    });
  }
  return false;
}

std::optional<Cost> ResidualNetwork::MarginOfMove(Node from, Node to, Cost bound) {
  const Cost move_cost =
      MoveCost(static_cast<CellIndex>(from % cells_), static_cast<CellIndex>(to % cells_));
  const Cost reversed = Reduced(In(to), Out(from), -move_cost);
  const auto never = [](Vertex) { return false; };
  if (!Search(Out(from), In(to), bound - reversed, never)) return std::nullopt;
  return label_[In(to)].distance + reversed;
}

std::optional<ResidualNetwork::Walk> ResidualNetwork::OneMorePath() {
  if (!Search(source(), sink(), kUnreached, [](Vertex) { return false; })) return std::nullopt;
  Walk walk;
  walk.cost = label_[sink()].distance - potential_[source()] + potential_[sink()];
  State state = label_[sink()].parent;
  walk.first_frame = walk.last_frame = FrameOf(state);
  for (; state != source(); state = label_[state].parent) {
    walk.first_frame = std::min(walk.first_frame, FrameOf(state));
    walk.last_frame = std::max(walk.last_frame, FrameOf(state));
  }
  return walk;
}

std::optional<Cost> ResidualNetwork::CycleThroughEdgeAndFrames(std::int64_t first,
                                                               std::int64_t last, Cost bound) {
  const auto touches = [&](Vertex vertex) {
    return vertex < source() && FrameOf(vertex) >= first && FrameOf(vertex) <= last;
  };
  std::optional<Cost> shortest;
  for (const Vertex edge : {source(), sink()}) {
    const State again = edge + vertex_count();
    if (!Search(edge, again, bound, touches)) continue;
    shortest = bound = label_[again].distance;
  }
  return shortest;
}

}  // namespace vantage::linking
