// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/node_store.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace vantage::linking {
namespace {

constexpr std::size_t kBlock = 16;  // cells that are looked at together

}  // namespace
NodeStore::NodeStore(const Network& network)
    : network_(network),
      tile_columns_(static_cast<std::size_t>((network.columns + kTileMask) >> kTileShift)),
      tiles_per_frame_(tile_columns_ *
                       static_cast<std::size_t>((network.rows + kTileMask) >> kTileShift)) {
  NewTile();
}

std::vector<NodeId> NodeStore::AddFrame(std::span<const float> probability) {
  const std::int64_t number = end_frame();
  Frame& frame = frames_.emplace_back();
  frame.probability = probability;
  frame.tiles.assign(tiles_per_frame_, kNoTile);
  std::vector<NodeId> people;
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
  const Frame& frame = frames_.front();
  free_.insert(free_.end(), frame.nodes.begin(), frame.nodes.end());
  std::copy_if(frame.tiles.begin(), frame.tiles.end(), std::back_inserter(free_tiles_),
               [](TileId tile) { return tile != kNoTile; });
  frames_.pop_front();
  ++first_frame_;
}

NodeId NodeStore::FindOrAdd(std::int64_t frame_number, int column, int row) {
  Frame& frame = At(frame_number);
  TileId& tile = frame.tiles[TilePlace(column, row)];
  if (tile == kNoTile) tile = NewTile();
  NodeId& id = tiles_[tile].nodes[PlaceInTile(column, row)];
  if (id != kNoNode) return id;
  id = NewNode();
  frame.nodes.push_back(id);
  Node& node = nodes_[id];
  node = Node{.frame = static_cast<std::int32_t>(frame_number),
              .column = static_cast<std::int16_t>(column),
              .row = static_cast<std::int16_t>(row),
              .cost = CostOf(frame_number, column, row)};
  for (const Side side : {kIn, kOut}) {
    node.potential[side] = PotentialOf(frame_number, column, row, side);
  }
  return id;
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

NodeStore::TileId NodeStore::NewTile() {
  if (free_tiles_.empty()) {
    free_tiles_.push_back(static_cast<TileId>(tiles_.size()));
    tiles_.emplace_back();
  }
  const TileId id = free_tiles_.back();
  free_tiles_.pop_back();
  std::fill(std::begin(tiles_[id].nodes), std::end(tiles_[id].nodes), kNoNode);
  return id;
}

std::int32_t NodeStore::CostOf(std::int64_t frame, int column, int row) const {
  const std::size_t cell = network_.Cell(column, row);
  const Frame& at = At(frame);
  return at.costs.empty() ? network_.node_cost(at.probability[cell]) : at.costs[cell];
}

Cost NodeStore::PotentialOf(std::int64_t frame_number, int column, int row, Side side) const {
  const Frame& frame = At(frame_number);
  if (frame.potentials.empty()) return 0;
  const auto potential =
      static_cast<Cost>(frame.potentials_sign * frame.potentials[network_.Padded(column, row)]);
  if (side == frame.potentials_side) return potential;
  const Cost cost = CostOf(frame_number, column, row);
  return side == kOut ? potential + cost : potential - cost;
}

// Maps have one value nearly everywhere: most blocks are done with one comparison a cell.
std::span<const std::int32_t> NodeStore::Costs(std::int64_t frame_number) {
  Frame& frame = At(frame_number);
  if (!frame.costs.empty()) return frame.costs;
  const std::span<const float> probability = frame.probability;
  frame.costs.resize(probability.size());
  float common = 0;
  std::int32_t common_cost = network_.node_cost(common);
  for (std::size_t block = 0; block < probability.size(); block += kBlock) {
    const std::size_t end = std::min(block + kBlock, probability.size());
    unsigned any = 0;
    for (std::size_t i = block; i < end; ++i) {
      any |= static_cast<unsigned>(probability[i] != common);
      frame.costs[i] = common_cost;
    }
    if (any == 0) continue;
    for (std::size_t i = block; i < end; ++i) {
      frame.costs[i] = probability[i] == common ? common_cost : network_.node_cost(probability[i]);
      // The value of two neighbours is the common one from there on.
      if (i > block && probability[i] == probability[i - 1]) {
        common = probability[i];
        common_cost = frame.costs[i];
      }
    }
  }
  return frame.costs;
}

void NodeStore::SetPotentials(std::int64_t frame, Side side, double sign,
                              std::vector<double> values) {
  At(frame).potentials = std::move(values);
  At(frame).potentials_sign = sign;
  At(frame).potentials_side = side;
}

void NodeStore::GetPotentials(std::int64_t frame_number, int column, int row, Side side,
                              std::span<double> values) {
  const std::span<const std::int32_t> costs =
      Costs(frame_number).subspan(network_.Cell(column, row), values.size());
  const Frame& frame = At(frame_number);
  if (frame.potentials.empty()) {
    std::fill(values.begin(), values.end(), 0.0);
    return;
  }
  const double* const from = frame.potentials.data() + network_.Padded(column, row);
  const double sign = frame.potentials_sign;
  const double cost_sign = side == frame.potentials_side ? 0 : side == kOut ? 1 : -1;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = sign * from[i] + cost_sign * costs[i];
}

}  // namespace vantage::linking
