// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/lemon_oracle.h"

// LEMON pushes nodes whose fields it sets only afterwards; g++ sees that under the sanitizers.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace vantage::testing {
namespace {

using Graph = lemon::SmartDigraph;

std::int64_t Units(double cost) { return std::llround(cost * 1048576.0); }

}  // namespace

LemonAnswer SolveWithLemon(const LinkingProblem& problem, const LinkingOptions& options) {
  struct Arc {
    Graph::Arc arc;
    std::int64_t capacity, cost;
  };
  Graph graph;
  std::vector<Arc> arcs;
  const auto add = [&](Graph::Node from, Graph::Node to, std::int64_t capacity, std::int64_t cost) {
    arcs.push_back({graph.addArc(from, to), capacity, cost});
  };
  const Graph::Node source = graph.addNode();
  const Graph::Node sink = graph.addNode();
  const int cells = problem.columns * problem.rows;
  const auto blocked = [&](int cell) {
    return !problem.obstacle.empty() && problem.obstacle[static_cast<std::size_t>(cell)] != 0;
  };
  const double largest = std::log((1 - options.clip) / options.clip);
  std::vector<Graph::Node> in, out;
  for (std::int64_t frame = 0; frame < problem.frames; ++frame) {
    for (int cell = 0; cell < cells; ++cell) {
      in.push_back(graph.addNode());
      out.push_back(graph.addNode());
      if (blocked(cell)) continue;
      const double p = problem.probability[static_cast<std::size_t>(frame * cells + cell)];
      add(in.back(), out.back(), 1, Units(std::clamp(-std::log(p / (1 - p)), -largest, largest)));
      const bool access = problem.access[static_cast<std::size_t>(cell)] != 0;
      if (access || frame == 0) add(source, in.back(), 1, 0);
      if (access || frame == problem.frames - 1) add(out.back(), sink, 1, 0);
    }
  }
  for (std::int64_t frame = 0; frame + 1 < problem.frames; ++frame) {
    for (int from = 0; from < cells; ++from) {
      const int column = from % problem.columns;
      const int row = from / problem.columns;
      for (int y = std::max(0, row - options.depth);
           y <= std::min(problem.rows - 1, row + options.depth); ++y) {
        for (int x = std::max(0, column - options.depth);
             x <= std::min(problem.columns - 1, column + options.depth); ++x) {
          const int to = x + y * problem.columns;
          if (blocked(from) || blocked(to)) continue;
          add(out[static_cast<std::size_t>(frame * cells + from)],
              in[static_cast<std::size_t>((frame + 1) * cells + to)], 1,
              Units(options.movement_cost * std::hypot(x - column, y - row)));
        }
      }
    }
  }
  const std::int64_t most_paths = options.max_paths > 0 ? options.max_paths : cells * 1000000LL;
  add(sink, source, most_paths, Units(options.birth_cost));

  Graph::ArcMap<std::int64_t> capacity(graph), cost(graph);
  for (const Arc& arc : arcs) {
    capacity[arc.arc] = arc.capacity;
    cost[arc.arc] = arc.cost;
  }
  lemon::NetworkSimplex<Graph, std::int64_t, std::int64_t> simplex(graph);
  simplex.upperMap(capacity).costMap(cost);
  if (simplex.run() != simplex.OPTIMAL) throw std::logic_error("LEMON found no optimum");
  return {.cost_units = simplex.totalCost<std::int64_t>(),
          .paths = simplex.flow(arcs.back().arc),
          .arcs = static_cast<std::int64_t>(arcs.size())};
}

}  // namespace vantage::testing
