// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/lemon_flow_oracle.h"

// LEMON pushes nodes whose fields it sets only afterwards; g++ sees that under the sanitizers.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

#include <lemon/capacity_scaling.h>
#include <lemon/cost_scaling.h>
#include <lemon/network_simplex.h>
#include <lemon/static_graph.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace vantage::testing {
namespace {

// The fastest that LEMON offers: a static graph, and flow in 32 bits. Costs of long paths need 64.
using Graph = lemon::StaticDigraph;
using Flow = int;
using Cost = std::int64_t;

Cost Units(double cost) { return std::llround(cost * 1048576.0); }

struct Network {
  Graph graph;
  std::vector<Cost> costs;  // by arc
  Flow most_paths = 0;      // capacity of the last arc; the others have 1
};

class NetworkBuilder {
 public:
  explicit NetworkBuilder(const PlainLinkingProblem& problem)
      : problem_(problem), cells_(problem.columns * problem.rows) {}

  void Build(Network& network) {
    const auto nodes = static_cast<int>(cells_ * problem_.frames);
    source_ = 2 * nodes;
    sink_ = source_ + 1;
    const auto width = static_cast<std::size_t>(2 * problem_.depth + 1);
    arcs_.reserve(static_cast<std::size_t>(nodes) * (width * width + 1));
    costs_.reserve(arcs_.capacity());
    for (std::int64_t frame = 0; frame < problem_.frames; ++frame) {
      for (int cell = 0; cell < cells_; ++cell) AddNode(frame, cell);
    }
    for (std::int64_t frame = 0; frame < problem_.frames; ++frame) {
      for (int cell = 0; cell < cells_; ++cell) {
        if (!Blocked(cell) && MayEnd(cell, frame == 0)) {
          Add(source_, In(frame, cell), EndCost(cell, frame == 0));
        }
      }
    }
    Add(sink_, source_, Units(problem_.birth_cost));
    // The arcs came in the order of their sources, as a static graph asks.
    network.graph.build(sink_ + 1, arcs_.begin(), arcs_.end());
    network.costs = std::move(costs_);
    network.most_paths =
        problem_.max_paths > 0 ? problem_.max_paths : std::numeric_limits<Flow>::max() / 4;
  }

 private:
  int In(std::int64_t frame, int cell) const {
    return static_cast<int>(2 * (frame * cells_ + cell));
  }
  int Out(std::int64_t frame, int cell) const { return In(frame, cell) + 1; }
  bool Blocked(int cell) const {
    return problem_.obstacle != nullptr && problem_.obstacle[cell] != 0;
  }
  void Add(int from, int to, Cost cost) {
    arcs_.emplace_back(from, to);
    costs_.push_back(cost);
  }

  void AddNode(std::int64_t frame, int cell) {
    if (Blocked(cell)) return;
    const double largest = std::log((1 - problem_.clip) / problem_.clip);
    const double p = problem_.probability[frame * cells_ + cell];
    Add(In(frame, cell), Out(frame, cell),
        Units(std::clamp(-std::log(p / (1 - p)), -largest, largest)));
    const bool last = frame == problem_.frames - 1;
    if (!last) {
      const int column = cell % problem_.columns, row = cell / problem_.columns;
      for (int y = std::max(0, row - problem_.depth);
           y <= std::min(problem_.rows - 1, row + problem_.depth); ++y) {
        for (int x = std::max(0, column - problem_.depth);
             x <= std::min(problem_.columns - 1, column + problem_.depth); ++x) {
          const int to = x + y * problem_.columns;
          if (Blocked(to)) continue;
          Add(Out(frame, cell), In(frame + 1, to),
              Units(problem_.movement_cost * std::hypot(x - column, y - row)));
        }
      }
    }
    if (MayEnd(cell, last)) Add(Out(frame, cell), sink_, EndCost(cell, last));
  }
  /// Whether a path may begin or end there, and what that costs besides its birth.
  bool MayEnd(int cell, bool everywhere) const {
    return everywhere || problem_.access[cell] != 0 || problem_.inside_cost >= 0;
  }
  std::int64_t EndCost(int cell, bool everywhere) const {
    return everywhere || problem_.access[cell] != 0 ? 0 : Units(problem_.inside_cost);
  }

  const PlainLinkingProblem& problem_;
  const int cells_;
  int source_ = 0, sink_ = 0;
  std::vector<std::pair<int, int>> arcs_;
  std::vector<Cost> costs_;
};

/// A map of LEMON that is computed when it is read.
template <class ValueType, class Function>
struct ArcFunction {
  using Key = Graph::Arc;
  using Value = ValueType;
  Value operator[](const Key& arc) const { return function(Graph::id(arc)); }
  Function function;
};
template <class Value, class Function>
ArcFunction<Value, Function> MapOf(Function function) {
  return {function};
}

template <class Algorithm>
LemonAnswer Solve(const PlainLinkingProblem& problem) {
  Network network;
  NetworkBuilder(problem).Build(network);
  const int last = network.graph.arcNum() - 1;
  Algorithm algorithm(network.graph);
  algorithm.upperMap(MapOf<Flow>([&](int arc) { return arc == last ? network.most_paths : 1; }))
      .costMap(MapOf<Cost>([&](int arc) { return network.costs[static_cast<std::size_t>(arc)]; }));
  if (algorithm.run() != Algorithm::OPTIMAL) throw std::logic_error("LEMON found no optimum");
  return {algorithm.template totalCost<std::int64_t>(), algorithm.flow(Graph::arc(last)),
          std::int64_t{last} + 1};
}

}  // namespace

LemonAnswer SolveWithLemon(const PlainLinkingProblem& problem, LemonAlgorithm algorithm) {
  switch (algorithm) {
    case LemonAlgorithm::kCapacityScaling:
      return Solve<lemon::CapacityScaling<Graph, Flow, Cost>>(problem);
    case LemonAlgorithm::kCostScaling:
      return Solve<lemon::CostScaling<Graph, Flow, Cost>>(problem);
    case LemonAlgorithm::kNetworkSimplex:
      break;
  }
  return Solve<lemon::NetworkSimplex<Graph, Flow, Cost>>(problem);
}

}  // namespace vantage::testing
