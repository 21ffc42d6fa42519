// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/sweep.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace vantage::linking {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr std::size_t kBlock = 16;

double AsDouble(Cost distance) {
  return distance == kUnreached ? kFar : static_cast<double>(distance);
}

/// The value that most of a list have, if more than half do (Boyer and Moore's vote).
float CommonValue(std::span<const float> values) {
  float candidate = 0;
  std::int64_t votes = 0;
  for (const float value : values) {
    if (votes == 0) candidate = value;
    votes += value == candidate ? 1 : -1;
  }
  return candidate;
}

}  // namespace

Sweep::Sweep(const Network& network, NodeStore& nodes)
    : network_(network),
      nodes_(nodes),
      depth_(network.depth),
      stride_(network.columns + 2 * network.depth),
      padded_far_(static_cast<std::size_t>(stride_) *
                      static_cast<std::size_t>(network.rows + 2 * network.depth),
                  kFar),
      near_(padded_far_.size(), kFar) {
  for (const Move& move : network.moves) {
    moves_.push_back(
        {.offset = move.columns + move.rows * stride_, .cost = static_cast<double>(move.cost)});
  }
  for (int row = 0; row < network.rows; ++row) {
    for (int column = 0; column < network.columns; ++column) {
      const std::size_t cell = network.Cell(column, row);
      if (network.access[cell] != 0) access_.push_back(Padded(column, row));
      if (network.obstacle[cell] != 0) obstacles_.push_back(cell);
    }
  }
  if (frames() > 0) common_ = CommonValue(nodes.Probability(nodes.first_frame()));
  common_cost_ = network.node_cost(common_);
  cost_.assign(network.cells(), common_cost_);
  fresh_.resize(network.cells());
  far_.resize(static_cast<std::size_t>(frames()));
  fell_.resize(far_.size(), 0);
}

template <Side kNear>
Cost Sweep::SetPotentials(Targets targets) {
  StartCarriers<kNear>(targets);
  FirstPass<kNear>();
  while (FollowPaths<kNear>(targets)) {
    for (std::int64_t step = 0; step < frames(); ++step) {
      const bool fell_ahead = step > 0 && Fell(FrameAt<kNear>(step - 1));
      if (fell_ahead || near_edge_fell_) DoFrame<kNear>(step);
      if (step > 0) Fell(FrameAt<kNear>(step - 1)) = 0;
    }
    near_edge_fell_ = false;
  }
  for (std::int64_t step = 0; step < frames(); ++step) {
    const std::int64_t frame = FrameAt<kNear>(step);
    nodes_.SetPotentials(frame, Other(kNear), kNear == kOut ? -1 : 1, std::move(Far(frame)));
    nodes_.ForEach(frame, [this](NodeId id) { SetPotentialsOf<kNear>(nodes_[id]); });
  }
  return static_cast<Cost>(near_edge_);
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
void Sweep::StartCarriers(Targets targets) {
  constexpr Side kFarSide = Other(kNear);
  const Cost edge_cost = kFarSide == kOut ? network_.exit_cost : network_.entry_cost;
  near_edge_ = targets == Targets::kImbalances ? 0 : kFar;
  for (std::int64_t step = 0; step < frames(); ++step) {
    nodes_.ForEach(FrameAt<kNear>(step), [&](NodeId id) {
      Node& node = nodes_[id];
      node.distance[kNear] = kUnreached;
      node.distance[kFarSide] = node.link[kFarSide] == kOpen     ? 0
                                : node.link[kFarSide] == kToEdge ? -edge_cost
                                                                 : kUnreached;
    });
  }
}

template <Side kNear>
void Sweep::FirstPass() {
  for (std::int64_t step = 0; step < frames(); ++step) DoFrame<kNear>(step);
}

template <Side kNear>
void Sweep::DoFrame(std::int64_t step) {
  constexpr Side kFarSide = Other(kNear);
  const std::int64_t frame = FrameAt<kNear>(step);
  const auto columns = static_cast<std::size_t>(network_.columns);
  const auto rows = static_cast<std::size_t>(network_.rows);
  const std::size_t begin = Padded(0, 0);
  const std::size_t end = Padded(network_.columns, network_.rows - 1);
  const double edge =
      near_edge_ + static_cast<double>(kNear == kOut ? network_.exit_cost : network_.entry_cost);
  if (step == 0) {
    std::fill(near_.begin(), near_.end(), edge);
  } else {
    const std::vector<double>& ahead = Far(FrameAt<kNear>(step - 1));
    for (std::size_t row = 0; row < rows; ++row) {
      std::copy_n(
          ahead.begin() + static_cast<std::ptrdiff_t>(row * columns), columns,
          padded_far_.begin() + static_cast<std::ptrdiff_t>(Padded(0, static_cast<int>(row))));
    }
    StepOverMoves(padded_far_.data() + begin, moves_, end - begin, near_.data() + begin);
    for (const std::size_t place : access_) near_[place] = std::min(near_[place], edge);
  }
  SetCosts(nodes_.Probability(frame));
  for (std::size_t row = 0; row < rows; ++row) {
    const double* const near = near_.data() + Padded(0, static_cast<int>(row));
    const double* const cost = cost_.data() + row * columns;
    double* const out = fresh_.data() + row * columns;
    for (std::size_t column = 0; column < columns; ++column)
      out[column] = near[column] + cost[column];
  }
  for (const std::size_t cell : obstacles_) fresh_[cell] = kFar;
  nodes_.ForEach(frame, [&](NodeId id) {
    Node& node = nodes_[id];
    if (!node.Carries()) return;
    // Back over the node itself, if the flow in it is taken off.
    const double near = std::min(near_[Padded(node.column, node.row)],
                                 AsDouble(node.distance[kFarSide]) - node.cost);
    node.distance[kNear] = near == kFar ? kUnreached : static_cast<Cost>(near);
    fresh_[network_.Cell(node.column, node.row)] = AsDouble(node.distance[kFarSide]);
  });
  std::vector<double>& far = Far(frame);
  if (far.empty()) {
    far = fresh_;
  } else if (far != fresh_) {
    far.swap(fresh_);
    Fell(frame) = 1;
  }
}

template <Side kNear>
bool Sweep::FollowPaths(Targets targets) {
  constexpr Side kFarSide = Other(kNear);
  const Cost edge_cost = kNear == kOut ? network_.exit_cost : network_.entry_cost;
  bool any_fell = false;
  for (std::int64_t step = frames() - 1; step >= 0; --step) {
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
          Far(frame)[network_.Cell(node.column, node.row)] = static_cast<double>(distance);
          Fell(frame) = 1;
          any_fell = true;
        }
      }
      if (targets == Targets::kBeginnings && node.link[kNear] == kToEdge) {
        const double edge = static_cast<double>(node.distance[kNear] - edge_cost);
        if (edge < near_edge_) {
          near_edge_ = edge;
          near_edge_fell_ = any_fell = true;
        }
      }
    });
  }
  return any_fell;
}

void Sweep::SetCosts(std::span<const float> probability) {
  for (const std::size_t cell : uncommon_) cost_[cell] = common_cost_;
  uncommon_.clear();
  for (std::size_t block = 0; block < probability.size(); block += kBlock) {
    const std::size_t end = std::min(block + kBlock, probability.size());
    unsigned any = 0;
    for (std::size_t i = block; i < end; ++i)
      any |= static_cast<unsigned>(probability[i] != common_);
    if (any == 0) continue;
    for (std::size_t i = block; i < end; ++i) {
      if (probability[i] == common_) continue;
      cost_[i] = network_.node_cost(probability[i]);
      uncommon_.push_back(i);
    }
  }
}

template Cost Sweep::SetPotentials<kIn>(Targets targets);
template Cost Sweep::SetPotentials<kOut>(Targets targets);

}  // namespace vantage::linking
