// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/sweep.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace vantage::linking {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
double AsDouble(Cost label) { return label == kUnreached ? kFar : static_cast<double>(label); }
Cost AsCost(double label) { return label == kFar ? kUnreached : static_cast<Cost>(label); }

/// What its potential says.
template <Side kNear>
double OldLabel(const Node& node, Side side) {
  return static_cast<double>(kNear == kOut ? -node.potential[side] : node.potential[side]);
}

}  // namespace

Sweep::Sweep(const Network& network, NodeStore& nodes)
    : network_(network),
      nodes_(nodes),
      edge_(static_cast<std::size_t>(network.columns)),
      obstacles_(static_cast<std::size_t>(network.rows)),
      frames_(static_cast<std::size_t>(nodes.end_frame() - nodes.first_frame())),
      all_(static_cast<std::size_t>(network.rows), Stretch{0, network.columns}),
      todo_(all_.size()),
      fresh_(network.padded_cells(), kFar),
      most_(network.cells(), kFar) {
  for (const Move& move : network.moves) {
    moves_.push_back(
        {.offset = move.columns + move.rows * static_cast<std::ptrdiff_t>(network.padded_columns()),
         .cost = static_cast<double>(move.cost)});
  }
  for (int row = 0; row < network.rows; ++row) {
    for (int column = 0; column < network.columns; ++column) {
      const std::size_t cell = network.Cell(column, row);
      if (network.obstacle[cell] != 0) obstacles_[static_cast<std::size_t>(row)].push_back(column);
    }
  }
}

template <Side kNear>
void Sweep::SetPotentials(Targets targets, double reach, EdgePotentials& edge) {
  constexpr double kSign = kNear == kOut ? -1 : 1;  // of a label's potential
  constexpr Side kFarSide = Other(kNear);
  reach_ = reach;
  far_edge_ = kSign * static_cast<double>(edge[kFarSide]);
  near_edge_ = kSign * static_cast<double>(edge[kNear]);
  if (targets == Targets::kBeginnings) near_edge_ += reach;
  StartCarriers<kNear>();
  FirstPass<kNear>();
  while (FollowPaths<kNear>(targets)) {
    for (std::int64_t step = 0; step < frame_count(); ++step) {
      if (near_edge_fell_) {
        DoFrame<kNear>(step, all_);
      } else if (step > 0 && !At(FrameAt<kNear>(step - 1)).fell.empty()) {
        DoFrame<kNear>(step, ToDoAfter(At(FrameAt<kNear>(step - 1))));
      }
      if (step > 0) At(FrameAt<kNear>(step - 1)).fell.clear();
    }
    near_edge_fell_ = false;
  }
  for (std::int64_t step = 0; step < frame_count(); ++step) {
    const std::int64_t frame = FrameAt<kNear>(step);
    nodes_.SetPotentials(frame, kFarSide, kSign, std::move(At(frame).far));
    nodes_.ForEach(frame, [this](NodeId id) { SetPotentialsOf<kNear>(nodes_[id]); });
  }
  edge[kNear] = static_cast<Cost>(kSign * near_edge_);
}

template <Side kNear>
void Sweep::SetPotentialsOf(Node& node) {
  for (const Side side : {kIn, kOut}) {
    node.potential[side] = !node.Carries()
                               ? nodes_.PotentialOf(node.frame, node.column, node.row, side)
                           : kNear == kOut ? -node.distance[side]
                                           : node.distance[side];
    node.distance[side] = kUnreached;
  }
}

template <Side kNear>
void Sweep::StartCarriers() {
  constexpr Side kFarSide = Other(kNear);
  for (std::int64_t step = 0; step < frame_count(); ++step) {
    nodes_.ForEach(FrameAt<kNear>(step), [&](NodeId id) {
      Node& node = nodes_[id];
      if (!node.Carries()) return;
      const Link link = node.link[kFarSide];
      const double old = OldLabel<kNear>(node, kFarSide);
      double label = link == kOpen ? old : reach_ + old;
      if (link == kToEdge) {
        label = std::min(label, far_edge_ - static_cast<double>(EdgeCost(node, kFarSide)));
      }
      node.distance[kFarSide] = AsCost(label);
    });
  }
}

template <Side kNear>
void Sweep::FirstPass() {
  for (std::int64_t step = 0; step < frame_count(); ++step) DoFrame<kNear>(step, all_);
}

void Sweep::PassOnce() { FirstPass<kOut>(); }

std::span<const Sweep::Stretch> Sweep::ToDoAfter(const Frame& ahead) {
  std::fill(todo_.begin(), todo_.end(), Stretch{});
  const int depth = network_.depth;
  for (int row = 0; row < network_.rows; ++row) {
    const Stretch fell = ahead.fell[static_cast<std::size_t>(row)];
    if (fell.empty()) continue;
    const Stretch wide = {std::max(fell.begin - depth, 0),
                          std::min(fell.end + depth, network_.columns)};
    const int last = std::min(row + depth, network_.rows - 1);
    for (int to = std::max(row - depth, 0); to <= last; ++to) {
      todo_[static_cast<std::size_t>(to)].Add(wide);
    }
  }
  return todo_;
}

template <Side kNear>
void Sweep::DoFrame(std::int64_t step, std::span<const Stretch> todo) {
  constexpr Side kFarSide = Other(kNear);
  const std::int64_t number = FrameAt<kNear>(step);
  Frame& frame = At(number);
  const bool first = frame.far.empty();
  if (first) frame.far.assign(network_.padded_cells(), kFar);
  std::vector<double>& fresh = first ? frame.far : fresh_;
  SetMost<kNear>(number, todo);
  for (int row = 0; row < network_.rows; ++row) {
    const Stretch stretch = todo[static_cast<std::size_t>(row)];
    if (!stretch.empty()) DoStretch<kNear>(step, row, stretch, fresh.data());
  }
  nodes_.ForEach(number, [&](NodeId id) {
    Node& node = nodes_[id];
    const Stretch stretch = todo[static_cast<std::size_t>(node.row)];
    if (!node.Carries() || node.column < stretch.begin || node.column >= stretch.end) return;
    double& far = fresh[network_.Padded(node.column, node.row)];
    // Ahead, or back over the node itself if the flow in it is taken off.
    const double near = std::min(std::min(far, AsDouble(node.distance[kFarSide])) - node.cost,
                                 reach_ + OldLabel<kNear>(node, kNear));
    node.distance[kNear] = AsCost(near);
    far = AsDouble(node.distance[kFarSide]);
  });
  if (first) return;
  for (int row = 0; row < network_.rows; ++row) {
    const Stretch stretch = todo[static_cast<std::size_t>(row)];
    for (int column = stretch.begin; column < stretch.end; ++column) {
      const std::size_t place = network_.Padded(column, row);
      if (fresh[place] == frame.far[place]) continue;
      frame.far[place] = fresh[place];
      frame.fell.resize(all_.size());
      frame.fell[static_cast<std::size_t>(row)].Add({column, column + 1});
    }
  }
}

/// Labels on the far side as if no node carried flow.
template <Side kNear>
void Sweep::DoStretch(std::int64_t step, int row, Stretch stretch, double* out) {
  const auto begin = static_cast<std::size_t>(stretch.begin);
  const auto end = static_cast<std::size_t>(stretch.end);
  const std::vector<Cost>& edge_costs = kNear == kOut ? network_.exit_costs : network_.entry_costs;
  const Cost everywhere = kNear == kOut ? network_.exit_cost : network_.entry_cost;
  for (std::size_t i = begin; i < end; ++i) {
    const Cost cost = step == 0 ? everywhere : edge_costs[network_.Cell(0, row) + i];
    edge_[i] = cost == kNever ? kFar : near_edge_ + static_cast<double>(cost);
  }
  const std::int32_t* const costs =
      nodes_.Costs(FrameAt<kNear>(step)).data() + network_.Cell(0, row);
  const std::size_t place = network_.Padded(stretch.begin, row);
  const double* const ahead = step == 0 ? nullptr : At(FrameAt<kNear>(step - 1)).far.data() + place;
  StepRow(ahead, step == 0 ? std::span<const KernelMove>() : moves_, edge_.data() + begin,
          costs + begin, end - begin, most_.data() + network_.Cell(stretch.begin, row),
          out + place);
  double* const out_row = out + network_.Padded(0, row);
  for (const int i : obstacles_[static_cast<std::size_t>(row)]) out_row[i] = kFar;
}

// Never below the old labels: those of the edge, which keeps its own as a target does, allow no
// less where paths may begin.
template <Side kNear>
void Sweep::SetMost(std::int64_t frame, std::span<const Stretch> todo) {
  if (reach_ == kFar) return;
  constexpr Side kFarSide = Other(kNear);
  for (int row = 0; row < network_.rows; ++row) {
    const Stretch stretch = todo[static_cast<std::size_t>(row)];
    if (stretch.empty()) continue;
    const std::span<double> most = std::span(most_).subspan(
        network_.Cell(stretch.begin, row), static_cast<std::size_t>(stretch.end - stretch.begin));
    nodes_.GetPotentials(frame, stretch.begin, row, kFarSide, most);
    for (double& value : most) value = reach_ + (kNear == kOut ? -value : value);
  }
  nodes_.ForEach(frame, [&](NodeId id) {
    const Node& node = nodes_[id];
    most_[network_.Cell(node.column, node.row)] = reach_ + OldLabel<kNear>(node, kFarSide);
  });
}

Cost Sweep::EdgeCost(const Node& node, Side side) const {
  const std::size_t cell = network_.Cell(node.column, node.row);
  if (side == kIn) {
    return node.frame == nodes_.first_frame() ? network_.entry_cost : network_.entry_costs[cell];
  }
  return node.frame + 1 == nodes_.end_frame() ? network_.exit_cost : network_.exit_costs[cell];
}

template <Side kNear>
bool Sweep::FollowPaths(Targets targets) {
  constexpr Side kFarSide = Other(kNear);
  bool any_fell = false;
  for (std::int64_t step = frame_count() - 1; step >= 0; --step) {
    const std::int64_t frame = FrameAt<kNear>(step);
    nodes_.ForEach(frame, [&](NodeId id) {
      Node& node = nodes_[id];
      if (!node.Carries()) return;
      if (IsNode(node.link[kFarSide])) {
        const Node& before = nodes_[node.link[kFarSide]];
        const Cost move = network_.MoveCost(node.column - before.column, node.row - before.row);
        // The node before was done already, and is within reach of a target.
        const Cost distance = before.distance[kNear] - move;
        if (distance < node.distance[kFarSide]) {
          node.distance[kFarSide] = distance;
          node.distance[kNear] = std::min(node.distance[kNear], distance - node.cost);
          Frame& at = At(frame);
          at.far[network_.Padded(node.column, node.row)] = static_cast<double>(distance);
          at.fell.resize(all_.size());
          at.fell[static_cast<std::size_t>(node.row)].Add({node.column, node.column + 1});
          any_fell = true;
        }
      }
      if (targets == Targets::kBeginnings && node.link[kNear] == kToEdge) {
        const double edge = static_cast<double>(node.distance[kNear] - EdgeCost(node, kNear));
        if (edge < near_edge_) {
          near_edge_ = edge;
          near_edge_fell_ = any_fell = true;
        }
      }
    });
  }
  return any_fell;
}

template void Sweep::SetPotentials<kIn>(Targets, double, EdgePotentials&);
template void Sweep::SetPotentials<kOut>(Targets, double, EdgePotentials&);

}  // namespace vantage::linking
