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

namespace vantage {
namespace {

/// A problem that owns its numbers.
struct Instance {
  int columns = 1;
  int rows = 1;
  int frames = 1;
  std::vector<float> probability;
  std::vector<std::uint8_t> access, obstacle;
  LinkingOptions options;

  int cells() const { return columns * rows; }
  LinkingProblem problem() const {
    return {.columns = columns,
            .rows = rows,
            .frames = frames,
            .probability = probability,
            .access = access,
            .obstacle = obstacle};
  }
  StreamGrid grid() const {
    return {.columns = columns, .rows = rows, .access = access, .obstacle = obstacle};
  }
  std::span<const float> Map(int frame) const {
    return std::span(probability)
        .subspan(static_cast<std::size_t>(frame * cells()), static_cast<std::size_t>(cells()));
  }
};

struct Limits {
  int side = 8;
  int frames = 12;
  int depth = 3;
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int Int(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
  }
  double Unit() { return static_cast<double>(engine_()) / 4294967296.0; }
  bool Chance(double p) { return Unit() < p; }

 private:
  std::mt19937 engine_;
};

float RandomProbability(Random& random, int style) {
  switch (style) {
    case 0:  // noise of every strength
      return static_cast<float>(random.Unit());
    case 1:  // as maps are: almost nothing, some sure, with costs at the clip
      return random.Chance(0.2) ? 1.0F : random.Chance(0.1) ? 0.7F : 0.0F;
    case 2:  // many ties
      return static_cast<float>(random.Int(1, 3)) / 4;
    default:  // rare and weak people
      return random.Chance(0.1) ? static_cast<float>(0.5 + random.Unit() / 2) : 0.01F;
  }
}

Instance RandomInstance(unsigned seed, const Limits& limits) {
  Random random(seed);
  Instance instance;
  instance.columns = random.Int(1, limits.side);
  instance.rows = random.Int(1, limits.side);
  instance.frames = random.Int(1, limits.frames);
  const int style = random.Int(0, 3);
  for (int i = 0; i < instance.cells() * instance.frames; ++i) {
    instance.probability.push_back(RandomProbability(random, style));
  }
  const double access = random.Chance(0.3) ? 0 : random.Unit();
  for (int i = 0; i < instance.cells(); ++i) instance.access.push_back(random.Chance(access));
  if (random.Chance(0.5)) {
    for (int i = 0; i < instance.cells(); ++i) instance.obstacle.push_back(random.Chance(0.2));
  }
  instance.options.depth = random.Int(0, limits.depth);
  const double birth[] = {0, 1, 5, 45, 20 * random.Unit()};
  instance.options.birth_cost = birth[random.Int(0, 4)];
  instance.options.clip = random.Chance(0.5) ? 1e-6 : 0.05;
  instance.options.movement_cost = random.Chance(0.5) ? 0 : 2 * random.Unit();
  instance.options.max_paths = random.Chance(0.7) ? 0 : random.Int(1, 3);
  return instance;
}

std::int64_t Units(double cost) { return std::llround(cost * 1048576.0); }

std::int64_t NodeUnits(const Instance& instance, int frame, int cell) {
  const double p = instance.probability[static_cast<std::size_t>(frame * instance.cells() + cell)];
  const double largest = std::log((1 - instance.options.clip) / instance.options.clip);
  return Units(std::clamp(-std::log(p / (1 - p)), -largest, largest));
}

bool Blocked(const Instance& instance, int cell) {
  return !instance.obstacle.empty() && instance.obstacle[static_cast<std::size_t>(cell)] != 0;
}

bool MayMove(const Instance& instance, int from, int to) {
  const int columns = std::abs(from % instance.columns - to % instance.columns);
  const int rows = std::abs(from / instance.columns - to / instance.columns);
  return std::max(columns, rows) <= instance.options.depth;
}

std::int64_t MoveUnits(const Instance& instance, int from, int to) {
  return Units(instance.options.movement_cost *
               std::hypot(from % instance.columns - to % instance.columns,
                          from / instance.columns - to / instance.columns));
}

/// Checks that the paths are legal and returns what they cost.
std::int64_t CheckPaths(const Instance& instance, const std::vector<LinkedPath>& paths) {
  std::int64_t cost = 0;
  std::set<std::pair<std::int64_t, CellIndex>> taken;
  std::pair<std::int64_t, CellIndex> previous(-1, -1);
  for (const LinkedPath& path : paths) {
    cost += Units(instance.options.birth_cost);
    EXPECT_FALSE(path.cells.empty());
    const std::pair begin(path.first_frame, path.cells.front());
    EXPECT_LT(previous, begin) << "not in order";
    previous = begin;
    const auto access = [&](CellIndex cell) {
      return instance.access[static_cast<std::size_t>(cell)] != 0;
    };
    EXPECT_TRUE(path.first_frame == 0 || access(path.cells.front()));
    const std::int64_t end = path.first_frame + std::ssize(path.cells);
    EXPECT_LE(end, instance.frames);
    EXPECT_TRUE(end == instance.frames || access(path.cells.back()));
    for (std::size_t i = 0; i < path.cells.size(); ++i) {
      const CellIndex cell = path.cells[i];
      const std::int64_t frame = path.first_frame + static_cast<std::int64_t>(i);
      EXPECT_TRUE(taken.emplace(frame, cell).second) << "two paths on one node";
      EXPECT_FALSE(Blocked(instance, cell));
      cost += NodeUnits(instance, static_cast<int>(frame), cell);
      if (i == 0) continue;
      EXPECT_TRUE(MayMove(instance, path.cells[i - 1], cell));
      cost += MoveUnits(instance, path.cells[i - 1], cell);
    }
  }
  return cost;
}

/// The optimum by trying every set of disjoint paths.
std::int64_t BruteForce(const Instance& instance) {
  struct Path {
    std::uint64_t nodes;
    std::int64_t cost;
  };
  std::vector<Path> all;
  const auto access = [&](int cell) {
    return instance.access[static_cast<std::size_t>(cell)] != 0;
  };
  const std::function<void(int, int, Path)> extend = [&](int frame, int cell, Path path) {
    if (Blocked(instance, cell)) return;
    path.nodes |= std::uint64_t{1} << (frame * instance.cells() + cell);
    path.cost += NodeUnits(instance, frame, cell);
    if (frame == instance.frames - 1 || access(cell)) all.push_back(path);
    if (frame == instance.frames - 1) return;
    for (int to = 0; to < instance.cells(); ++to) {
      if (!MayMove(instance, cell, to)) continue;
      extend(frame + 1, to, {path.nodes, path.cost + MoveUnits(instance, cell, to)});
    }
  };
  for (int frame = 0; frame < instance.frames; ++frame) {
    for (int cell = 0; cell < instance.cells(); ++cell) {
      if (frame == 0 || access(cell)) extend(frame, cell, {0, Units(instance.options.birth_cost)});
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

TEST(LinkerOracle, EqualsNetworkSimplexOnRandomProblems) {
  int with_paths = 0;
  int capped = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    const Instance instance = RandomInstance(seed, Limits{});
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
  EXPECT_GT(with_paths, 500);
  EXPECT_GT(capped, 100);
}

// The order of searches and the sweeps between them may not change the optimum: here nothing is
// near, and a sweep stands before every search, or only before some.
TEST(LinkerOracle, AnyEffortFindsTheOptimum) {
  for (unsigned seed = 1000; seed < 1300; ++seed) {
    SCOPED_TRACE(seed);
    Instance instance = RandomInstance(seed, Limits{});
    instance.options.max_paths = 0;
    const Result<LinkingResult> right = LinkPaths(instance.problem(), instance.options);
    ASSERT_TRUE(right) << right.error().message;
    const Result<linking::Network> network =
        linking::MakeNetwork(instance.grid(), instance.options);
    ASSERT_TRUE(network);
    for (const linking::FlowSolver::Effort effort :
         {linking::FlowSolver::Effort{.nearby = 1, .share_between_sweeps = 0},
          {.nearby = 0, .share_between_sweeps = 0.1},
          {.nearby = 5, .share_between_sweeps = 0.01}}) {
      linking::FlowSolver solver(*network, effort);
      for (int frame = 0; frame < instance.frames; ++frame) solver.AddFrame(instance.Map(frame));
      ASSERT_TRUE(solver.Settle({}));
      ASSERT_EQ(solver.TotalCost(), Units(right->report.cost));
      ASSERT_EQ(CheckPaths(instance, solver.Paths()), solver.TotalCost());
    }
  }
}

// Settled after every frame, the flow is the optimum of the frames so far.
TEST(LinkerOracle, FramesMayBeAddedToASettledFlow) {
  for (unsigned seed = 2000; seed < 2500; ++seed) {
    SCOPED_TRACE(seed);
    Instance instance = RandomInstance(seed, Limits{});
    instance.options.max_paths = 0;
    const Result<linking::Network> network =
        linking::MakeNetwork(instance.grid(), instance.options);
    ASSERT_TRUE(network);
    linking::FlowSolver solver(*network);
    Instance so_far = instance;
    for (so_far.frames = 1; so_far.frames <= instance.frames; ++so_far.frames) {
      solver.AddFrame(instance.Map(so_far.frames - 1));
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
