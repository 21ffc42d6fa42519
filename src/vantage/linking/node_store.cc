// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/node_store.h"

#include <algorithm>
#include <utility>

namespace vantage::linking {
namespace {

constexpr std::size_t kSmallestTable = 64;
// Cells of neighbouring rows come to lie apart, those of a row beside each other.
constexpr std::size_t kRowStride = 21;

}  // namespace

NodeStore::NodeStore(const Network& network) : network_(network) {}

std::vector<NodeId> NodeStore::AddFrame(std::span<const float> probability) {
  const std::int64_t number = end_frame();
  Frame& frame = frames_.emplace_back();
  frame.probability = probability;
  frame.table.resize(kSmallestTable);
  std::vector<NodeId> people;
  constexpr std::size_t kBlock = 64;
  for (std::size_t block = 0; block < probability.size(); block += kBlock) {
    const std::size_t end = std::min(block + kBlock, probability.size());
    unsigned any = 0;
    for (std::size_t i = block; i < end; ++i) any |= static_cast<unsigned>(probability[i] > 0.5F);
    if (any == 0) continue;
    for (std::size_t i = block; i < end; ++i) {
      if (!(probability[i] > 0.5F) || network_.obstacle[i] != 0) continue;
      const auto cell = static_cast<int>(i);
      if (network_.node_cost(probability[i]) >= 0) continue;  // rounded to 0
      people.push_back(FindOrAdd(number, cell % network_.columns, cell / network_.columns));
    }
  }
  return people;
}

void NodeStore::DropFrame() {
  ForEach(first_frame_, [this](NodeId node) { free_.push_back(node); });
  frames_.pop_front();
  ++first_frame_;
}

std::size_t NodeStore::Slot(const std::vector<Entry>& table, std::uint32_t cell, int column,
                            int row) {
  const std::size_t mask = table.size() - 1;
  std::size_t slot =
      (static_cast<std::size_t>(column) + kRowStride * static_cast<std::size_t>(row)) & mask;
  while (table[slot].node != kNoNode && table[slot].cell != cell) slot = (slot + 1) & mask;
  return slot;
}

NodeId NodeStore::Find(std::int64_t frame, int column, int row) const {
  const std::vector<Entry>& table = At(frame).table;
  return table[Slot(table, static_cast<std::uint32_t>(network_.Cell(column, row)), column, row)]
      .node;
}

NodeId NodeStore::FindOrAdd(std::int64_t frame_number, int column, int row) {
  Frame& frame = At(frame_number);
  const auto cell = static_cast<std::uint32_t>(network_.Cell(column, row));
  std::size_t slot = Slot(frame.table, cell, column, row);
  if (frame.table[slot].node != kNoNode) return frame.table[slot].node;
  if (2 * ++frame.count > frame.table.size()) {
    Grow(frame);
    slot = Slot(frame.table, cell, column, row);
  }
  const NodeId id = NewNode();
  Node& node = nodes_[id];
  node = Node{.frame = static_cast<std::int32_t>(frame_number),
              .column = static_cast<std::int16_t>(column),
              .row = static_cast<std::int16_t>(row),
              .cost = CostOf(frame_number, column, row)};
  for (const Side side : {kIn, kOut}) {
    node.potential[side] = PotentialOf(frame_number, column, row, side);
  }
  frame.table[slot] = {cell, id};
  return id;
}

void NodeStore::Grow(Frame& frame) const {
  std::vector<Entry> table(2 * frame.table.size());
  for (const Entry& entry : frame.table) {
    if (entry.node == kNoNode) continue;
    const auto cell = static_cast<int>(entry.cell);
    table[Slot(table, entry.cell, cell % network_.columns, cell / network_.columns)] = entry;
  }
  frame.table = std::move(table);
}

NodeId NodeStore::NewNode() {
  if (!free_.empty()) {
    const NodeId id = free_.back();
    free_.pop_back();
    return id;
  }
  nodes_.emplace_back();
  return static_cast<NodeId>(nodes_.size() - 1);
}

std::int32_t NodeStore::CostOf(std::int64_t frame, int column, int row) const {
  return network_.node_cost(At(frame).probability[network_.Cell(column, row)]);
}

Cost NodeStore::PotentialOf(std::int64_t frame_number, int column, int row, Side side) const {
  const Frame& frame = At(frame_number);
  if (frame.potentials.empty()) return 0;
  const auto potential = static_cast<Cost>(frame.potentials[network_.Cell(column, row)]);
  if (side == frame.potentials_side) return potential;
  const Cost cost = CostOf(frame_number, column, row);
  return side == kOut ? potential + cost : potential - cost;
}

void NodeStore::SetPotentials(std::int64_t frame, Side side, std::vector<double> potentials) {
  At(frame).potentials = std::move(potentials);
  At(frame).potentials_side = side;
}

}  // namespace vantage::linking
