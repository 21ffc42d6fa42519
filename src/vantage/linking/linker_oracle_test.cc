// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "vantage/linking/flow_solver.h"
#include "vantage/linking/lemon_oracle.h"
#include "vantage/linking/linker.h"
#include "vantage/linking/network.h"
#include "vantage/linking/test_instances.h"

namespace vantage {
namespace {

using testing::Blocked;
using testing::CheckPaths;
using testing::EdgeUnits;
using testing::Instance;
using testing::MayMove;
using testing::MoveUnits;
using testing::NodeUnits;
using testing::RandomInstance;
using testing::Units;

/// The optimum by trying every set of disjoint paths.
std::int64_t BruteForce(const Instance& instance) {
  struct Path {
    std::uint64_t nodes;
    std::int64_t cost;
  };
  std::vector<Path> all;
  const std::function<void(int, int, Path)> extend = [&](int frame, int cell, Path path) {
    if (Blocked(instance, cell)) return;
    path.nodes |= std::uint64_t{1} << (frame * instance.cells() + cell);
    path.cost += NodeUnits(instance, frame, cell);
    if (const auto exit = EdgeUnits(instance, cell, frame == instance.frames - 1)) {
      all.push_back({path.nodes, path.cost + *exit});
    }
    if (frame == instance.frames - 1) return;
    for (int to = 0; to < instance.cells(); ++to) {
      if (!MayMove(instance, cell, to)) continue;
      extend(frame + 1, to, {path.nodes, path.cost + MoveUnits(instance, cell, to)});
    }
  };
  for (int frame = 0; frame < instance.frames; ++frame) {
    for (int cell = 0; cell < instance.cells(); ++cell) {
      if (const auto entry = EdgeUnits(instance, cell, frame == 0)) {
        extend(frame, cell, {0, *entry + Units(instance.options.birth_cost)});
      }
    }
  }
  const int most =
      instance.options.max_paths > 0 ? instance.options.max_paths : std::numeric_limits<int>::max();
  const std::function<std::int64_t(std::size_t, std::uint64_t, int)> best =
      [&](std::size_t first, std::uint64_t taken, int left) {
        std::int64_t lowest = 0;
        for (std::size_t i = first; i < all.size() && left > 0; ++i) {
          if ((all[i].nodes & taken) != 0) continue;
          lowest = std::min(lowest, all[i].cost + best(i + 1, taken | all[i].nodes, left - 1));
        }
        return lowest;
      };
  return best(0, 0, most);
}

// Ten thousand problems in parts that may run side by side; grids up to 12 x 12, up to 30 frames.
class LinkerOracleParts : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(OfTen, LinkerOracleParts, ::testing::Range(0U, 10U));

TEST_P(LinkerOracleParts, EqualsNetworkSimplexOnRandomProblems) {
  constexpr unsigned problems = 1000;
  unsigned with_paths = 0;
  unsigned capped = 0;
  for (unsigned i = 0; i < problems; ++i) {
    const unsigned seed = GetParam() * problems + i;
    SCOPED_TRACE(seed);
    const Instance instance = RandomInstance(seed, {.side = 12, .frames = 30, .depth = 3});
    const Result<LinkingResult> result = LinkPaths(instance.problem(), instance.options);
    ASSERT_TRUE(result) << result.error().message;
    const testing::LemonAnswer right =
        testing::SolveWithLemon(instance.problem(), instance.options);
    ASSERT_EQ(Units(result->report.cost), right.cost_units);
    ASSERT_EQ(CheckPaths(instance, result->paths), right.cost_units);
    ASSERT_EQ(result->report.paths, std::ssize(result->paths));
    with_paths += result->paths.empty() ? 0 : 1;
    if (instance.options.max_paths > 0) {
      ASSERT_LE(std::ssize(result->paths), instance.options.max_paths);
      LinkingOptions uncapped = instance.options;
      uncapped.max_paths = 0;
      const Result<LinkingResult> all = LinkPaths(instance.problem(), uncapped);
      capped += all->paths.size() > result->paths.size() ? 1 : 0;
    }
  }
  // The problems are worth solving.
  EXPECT_GT(with_paths, problems / 2);
  EXPECT_GT(capped, problems / 10);
}

// The order of searches and the sweeps between them may not change the optimum: here nothing is
// near, and a sweep stands before every search, or only before some.
TEST(LinkerOracle, AnyEffortFindsTheOptimum) {
  for (unsigned seed = 1000; seed < 1300; ++seed) {
    SCOPED_TRACE(seed);
    Instance instance = RandomInstance(seed);
    instance.options.max_paths = 0;
    const Result<LinkingResult> right = LinkPaths(instance.problem(), instance.options);
    ASSERT_TRUE(right) << right.error().message;
    const Result<linking::Network> network =
        linking::MakeNetwork(instance.grid(), instance.options);
    ASSERT_TRUE(network);
    for (const linking::SearchEffort& effort :
         {linking::SearchEffort{.reach = 0, .nearby = 5},
          {.reach = 1, .nearby = 0, .share_between_sweeps = 0},
          {.reach = 5, .nearby = 2, .share_between_sweeps = 0.02},
          {.reach = 1000, .nearby = 5, .share_between_sweeps = 0}}) {
      linking::FlowSolver solver(*network, effort);
      for (int frame = 0; frame < instance.frames; ++frame) solver.AddFrame(instance.Map(frame));
      ASSERT_TRUE(solver.Settle({}));
      ASSERT_GE(solver.LeastReducedCost(), 0);
      ASSERT_EQ(solver.TotalCost(), Units(right->report.cost));
      ASSERT_EQ(CheckPaths(instance, solver.Paths()), solver.TotalCost());
    }
  }
}

// Settled after every frame, the flow is the optimum of the frames so far.
TEST(LinkerOracle, FramesMayBeAddedToASettledFlow) {
  for (unsigned seed = 2000; seed < 2500; ++seed) {
    SCOPED_TRACE(seed);
    Instance instance = RandomInstance(seed);
    instance.options.max_paths = 0;
    const Result<linking::Network> network =
        linking::MakeNetwork(instance.grid(), instance.options);
    ASSERT_TRUE(network);
    linking::FlowSolver solver(*network, linking::kNoSweeps);
    Instance so_far = instance;
    for (so_far.frames = 1; so_far.frames <= instance.frames; ++so_far.frames) {
      solver.AddFrame(instance.Map(so_far.frames - 1));
      ASSERT_GE(solver.LeastReducedCost(), 0);
      ASSERT_TRUE(solver.Settle({}));
      so_far.probability.assign(instance.probability.begin(),
                                instance.probability.begin() + so_far.frames * instance.cells());
      const Result<LinkingResult> right = LinkPaths(so_far.problem(), so_far.options);
      ASSERT_TRUE(right) << right.error().message;
      ASSERT_EQ(solver.TotalCost(), Units(right->report.cost)) << so_far.frames << " frames";
      ASSERT_EQ(CheckPaths(so_far, solver.Paths()), solver.TotalCost());
    }
  }
}

TEST(LinkerOracle, EqualsBruteForceOnTinyProblems) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    const Instance instance = RandomInstance(seed, {.side = 2, .frames = 3, .depth = 1});
    const Result<LinkingResult> result = LinkPaths(instance.problem(), instance.options);
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(Units(result->report.cost), BruteForce(instance));
    ASSERT_EQ(CheckPaths(instance, result->paths), Units(result->report.cost));
  }
}

}  // namespace
}  // namespace vantage
