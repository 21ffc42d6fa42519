// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/alternatives.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "vantage/base/test_support.h"
#include "vantage/linking/node_cost.h"
#include "vantage/linking/test_instances.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::Instance;
using testing::MessageOf;
using testing::Random;

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Small enough to enumerate all its solutions.
Instance TinyInstance(unsigned seed, int side, int frames) {
  Random random(seed);
  Instance instance;
  instance.columns = random.Int(1, side);
  instance.rows = random.Int(1, side);
  instance.frames = random.Int(1, frames);
  const bool ties = random.Chance(0.3);
  for (int i = 0; i < instance.cells() * instance.frames; ++i) {
    const double p = ties ? random.Int(1, 3) / 4.0 : random.Unit();
    instance.probability.push_back(static_cast<float>(p));
  }
  const double access = random.Chance(0.3) ? 0 : 0.7 * random.Unit();
  for (int i = 0; i < instance.cells(); ++i) {
    instance.access.push_back(random.Chance(access));
    instance.obstacle.push_back(random.Chance(0.1));
  }
  instance.options.depth = random.Int(0, 2);
  instance.options.birth_cost = random.Chance(0.3) ? 0 : 2 * random.Unit();
  instance.options.clip = 0.05;
  instance.options.movement_cost = random.Chance(0.5) ? 0 : random.Unit();
  instance.options.max_paths = random.Chance(0.7) ? 0 : random.Int(1, 2);
  if (random.Chance(0.1)) instance.options.inside_cost = 2 * random.Unit();
  return instance;
}

// What follows a node of a solution, or one of these.
constexpr int kFree = -1;
constexpr int kEnd = -2;

/// A set of disjoint paths: what follows each node (cell + frame * cells), and where paths begin.
struct Solution {
  std::vector<int> next;
  std::vector<std::uint8_t> begins;
  std::int64_t paths = 0;
  double cost = 0;
};

/// Calls `visit` for every set of disjoint paths.
class Enumeration {
 public:
  Enumeration(const Instance& instance, std::function<void(const Solution&)> visit)
      : instance_(instance), visit_(std::move(visit)) {
    const auto nodes = static_cast<std::size_t>(instance.cells() * instance.frames);
    solution_.next.assign(nodes, kFree);
    solution_.begins.assign(nodes, 0);
  }

  /// Decides on the node: no path begins there, or one does.
  void Run(int node = 0) {
    if (node == std::ssize(solution_.next)) return visit_(solution_);
    Run(node + 1);
    const std::optional<double> entry = EndCost(node, 0);
    if (Taken(node) || !entry) return;
    const auto index = static_cast<std::size_t>(node);
    solution_.begins[index] = 1;
    ++solution_.paths;
    solution_.cost += instance_.options.birth_cost + *entry;
    Continue(node, node + 1);
    solution_.cost -= instance_.options.birth_cost + *entry;
    --solution_.paths;
    solution_.begins[index] = 0;
  }

 private:
  bool Taken(int node) const {
    return solution_.next[static_cast<std::size_t>(node)] != kFree ||
           instance_.obstacle[static_cast<std::size_t>(node % instance_.cells())] != 0;
  }
  /// What it costs to begin or end there; none: it cannot be.
  std::optional<double> EndCost(int node, int free_frame) const {
    const bool access = instance_.access[static_cast<std::size_t>(node % instance_.cells())] != 0;
    return access || node / instance_.cells() == free_frame ? 0 : instance_.options.inside_cost;
  }

  /// A path has come to `node`; the next one may begin at `then` or after.
  void Continue(int node, int then) {
    const double before = solution_.cost;
    const double largest = std::log((1 - instance_.options.clip) / instance_.options.clip);
    const double p = instance_.probability[static_cast<std::size_t>(node)];
    const double here = before + std::clamp(-std::log(p / (1 - p)), -largest, largest);
    int& next = solution_.next[static_cast<std::size_t>(node)];
    if (const std::optional<double> exit = EndCost(node, instance_.frames - 1)) {
      next = kEnd;
      solution_.cost = here + *exit;
      Run(then);
    }
    const int frame = node / instance_.cells();
    const int from = node % instance_.cells();
    for (int to = 0; frame + 1 < instance_.frames && to < instance_.cells(); ++to) {
      const int columns = to % instance_.columns - from % instance_.columns;
      const int rows = to / instance_.columns - from / instance_.columns;
      const int follower = (frame + 1) * instance_.cells() + to;
      if (std::max(std::abs(columns), std::abs(rows)) > *instance_.options.depth) continue;
      if (Taken(follower)) continue;
      next = follower;
      solution_.cost = here + instance_.options.movement_cost /
                                  std::max(*instance_.options.depth, 1) * std::hypot(columns, rows);
      Continue(follower, then);
    }
    next = kFree;
    solution_.cost = before;
  }

  const Instance& instance_;
  std::function<void(const Solution&)> visit_;
  Solution solution_;
};

Solution AsSolution(const Instance& instance, const LinkingResult& result) {
  Solution solution;
  const auto nodes = static_cast<std::size_t>(instance.cells() * instance.frames);
  solution.next.assign(nodes, kFree);
  solution.begins.assign(nodes, 0);
  for (const LinkedPath& path : result.paths) {
    const auto at = [&](std::size_t step) {
      return static_cast<int>(path.first_frame + static_cast<std::int64_t>(step)) *
                 instance.cells() +
             path.cells[step];
    };
    solution.begins[static_cast<std::size_t>(at(0))] = 1;
    for (std::size_t i = 0; i < path.cells.size(); ++i) {
      solution.next[static_cast<std::size_t>(at(i))] = i + 1 < path.cells.size() ? at(i + 1) : kEnd;
    }
  }
  solution.paths = std::ssize(result.paths);
  solution.cost = result.report.cost;
  return solution;
}

/// True when the solutions have other nodes, moves, begins or ends that touch the frames
/// [first, last].
bool DifferIn(const Instance& instance, const Solution& a, const Solution& b, std::int64_t first,
              std::int64_t last) {
  for (std::size_t node = 0; node < a.next.size(); ++node) {
    const std::int64_t frame = static_cast<std::int64_t>(node) / instance.cells();
    if (frame >= first && frame <= last) {
      if (a.next[node] != b.next[node] || a.begins[node] != b.begins[node]) return true;
    }
    // Moves into the first of these frames.
    if (frame + 1 >= first && frame + 1 <= last && a.next[node] != b.next[node]) {
      if (a.next[node] >= 0 || b.next[node] >= 0) return true;
    }
  }
  return false;
}

/// True when they are equal wherever frames outside [first, last] take part.
bool EqualOutside(const Instance& instance, const Solution& a, const Solution& b,
                  std::int64_t first, std::int64_t last) {
  return (first == 0 || !DifferIn(instance, a, b, 0, first - 1)) &&
         (last == instance.frames - 1 || !DifferIn(instance, a, b, last + 1, instance.frames - 1));
}

struct Expected {
  double next_best = kNone;
  double further = kNone;
  std::map<std::pair<int, int>, double> margins;  // by used move, without infinite ones
};

Expected ByEnumeration(const Instance& instance, const LinkingResult& optimum,
                       const Stretch& stretch) {
  const Solution best = AsSolution(instance, optimum);
  const std::int64_t first = std::max<std::int64_t>(0, stretch.first_frame - stretch.margin_frames);
  const std::int64_t last =
      std::min<std::int64_t>(instance.frames - 1, stretch.last_frame + stretch.margin_frames);
  const std::int64_t most = instance.options.max_paths;
  Expected expected;
  Enumeration enumeration(instance, [&](const Solution& solution) {
    if (!EqualOutside(instance, best, solution, first, last)) return;
    const double more = solution.cost - best.cost;
    if (solution.paths == best.paths + 1) expected.further = std::min(expected.further, more);
    if (most > 0 && solution.paths > most) return;
    if (DifferIn(instance, best, solution, stretch.first_frame, stretch.last_frame)) {
      expected.next_best = std::min(expected.next_best, more);
    }
    for (std::size_t node = 0; node < best.next.size(); ++node) {
      if (best.next[node] < 0 || solution.next[node] == best.next[node]) continue;
      const std::pair move(static_cast<int>(node), best.next[node]);
      const auto found = expected.margins.emplace(move, more).first;
      found->second = std::min(found->second, more);
    }
  });
  enumeration.Run();
  return expected;
}

void ExpectSame(const std::optional<double>& found, double expected) {
  ASSERT_EQ(found.has_value(), expected < kNone);
  if (found) {
    ASSERT_NEAR(*found, expected, 1e-4);
  }
}

TEST(Alternatives, EqualEnumerationOnTinyProblems) {
  int weak_steps = 0, further = 0, capped = 0, with_margin = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    const Instance instance = TinyInstance(seed, 2, seed % 3 == 0 ? 4 : 3);
    const auto optimum = LinkPaths(instance.problem(), instance.options);
    ASSERT_TRUE(optimum) << optimum.error().message;
    Random random(seed + 10000);
    Stretch stretch;
    stretch.first_frame = random.Int(0, instance.frames - 1);
    stretch.last_frame = random.Int(static_cast<int>(stretch.first_frame), instance.frames - 1);
    stretch.margin_frames = random.Chance(0.5) ? 1000 : random.Int(0, 1);
    const auto found =
        FindAlternatives(instance.problem(), instance.options, optimum->paths, stretch);
    ASSERT_TRUE(found) << found.error().message;
    const Expected expected = ByEnumeration(instance, *optimum, stretch);
    ExpectSame(found->next_best, expected.next_best);
    ExpectSame(found->further ? std::optional(found->further->missing) : std::nullopt,
               expected.further);
    for (const PathInStretch& part : found->paths) {
      const LinkedPath& path = optimum->paths[part.path];
      double lowest = kNone;
      for (std::size_t i = 0; i + 1 < path.cells.size(); ++i) {
        const std::int64_t frame = path.first_frame + static_cast<std::int64_t>(i);
        if (frame + 1 < stretch.first_frame || frame > stretch.last_frame) continue;
        const int from = static_cast<int>(frame) * instance.cells() + path.cells[i];
        const int to = static_cast<int>(frame + 1) * instance.cells() + path.cells[i + 1];
        const auto margin = expected.margins.find({from, to});
        if (margin == expected.margins.end()) continue;
        lowest = std::min(lowest, margin->second);
        if (part.weakest && part.weakest->frame == frame) {
          ASSERT_NEAR(part.weakest->margin, margin->second, 1e-4);
          ASSERT_EQ(part.weakest->from, path.cells[i]);
          ASSERT_EQ(part.weakest->to, path.cells[i + 1]);
        }
      }
      ExpectSame(part.weakest ? std::optional(part.weakest->margin) : std::nullopt, lowest);
      weak_steps += part.weakest ? 1 : 0;
    }
    further += found->further ? 1 : 0;
    capped += found->further && found->further->missing < 0 ? 1 : 0;
    with_margin += stretch.margin_frames == 1 ? 1 : 0;
  }
  // The problems are worth solving.
  EXPECT_GT(weak_steps, 100);
  EXPECT_GT(further, 200);
  EXPECT_GT(capped, 5);
  EXPECT_GT(with_margin, 50);
}

/// One person in a corridor of 5 cells for 6 frames, cell 2, with a second thought beside.
Instance Corridor() {
  Instance instance;
  instance.columns = 5;
  instance.frames = 6;
  instance.probability.assign(30, 0.01F);
  for (std::size_t frame = 0; frame < 6; ++frame) instance.probability[frame * 5 + 2] = 0.999F;
  instance.probability[3 * 5 + 3] = 0.9F;
  instance.access.assign(5, 0);
  instance.obstacle.assign(5, 0);
  instance.options = {.depth = 1, .birth_cost = 20, .movement_cost = 0};
  return instance;
}

TEST(Alternatives, TellWhereAPathIsWeak) {
  const Instance instance = Corridor();
  const auto optimum = LinkPaths(instance.problem(), instance.options);
  ASSERT_EQ(optimum->paths.size(), 1U);
  const auto found = FindAlternatives(instance.problem(), instance.options, optimum->paths,
                                      {.first_frame = 1, .last_frame = 4, .margin_frames = 10});
  ASSERT_EQ(MessageOf(found), "");
  ASSERT_EQ(found->paths.size(), 1U);
  const PathInStretch& path = found->paths[0];
  EXPECT_EQ(path.first_frame, 1);
  EXPECT_EQ(path.cells, (std::vector<CellIndex>{2, 2, 2, 2}));
  EXPECT_NEAR(path.cost, -4 * std::log(999.0), 1e-3);
  // Over cell 3 at frame 3 costs log 999 - log 9 more.
  ASSERT_TRUE(path.weakest);
  EXPECT_EQ(path.weakest->frame, 2);
  EXPECT_EQ(path.weakest->from, 2);
  EXPECT_EQ(path.weakest->to, 2);
  EXPECT_NEAR(path.weakest->margin, std::log(999.0 / 9), 1e-3);
  EXPECT_NEAR(*found->next_best, path.weakest->margin, 1e-6);
  // A second path: birth, five cells of 0.01 and the one of 0.9.
  ASSERT_TRUE(found->further);
  EXPECT_NEAR(found->further->missing, 20 + 5 * std::log(99.0) - std::log(9.0), 1e-3);
  EXPECT_EQ(found->further->first_frame, 0);
  EXPECT_EQ(found->further->last_frame, 5);
}

TEST(Alternatives, WhatLiesOutsideTheMarginIsFixed) {
  const Instance instance = Corridor();
  const auto optimum = LinkPaths(instance.problem(), instance.options);
  // From frame 3 alone, nothing can change: what comes before and after is fixed.
  const auto one = FindAlternatives(instance.problem(), instance.options, optimum->paths,
                                    {.first_frame = 3, .last_frame = 3, .margin_frames = 0});
  ASSERT_EQ(MessageOf(one), "");
  EXPECT_EQ(one->next_best, std::nullopt);
  EXPECT_FALSE(one->paths.at(0).weakest);
  EXPECT_FALSE(one->further);
  const auto three = FindAlternatives(instance.problem(), instance.options, optimum->paths,
                                      {.first_frame = 3, .last_frame = 3, .margin_frames = 1});
  EXPECT_NEAR(three->next_best.value(), std::log(999.0 / 9), 1e-3);
}

TEST(Alternatives, ATieCostsNothing) {
  Instance instance = Corridor();
  instance.probability[3 * 5 + 3] = 0.999F;
  const auto optimum = LinkPaths(instance.problem(), instance.options);
  const auto found = FindAlternatives(instance.problem(), instance.options, optimum->paths,
                                      {.first_frame = 0, .last_frame = 5, .margin_frames = 0});
  EXPECT_EQ(found->next_best, 0);
  EXPECT_EQ(found->paths.at(0).weakest->margin, 0);
}

TEST(Alternatives, HoldOnAGridOfUsualSize) {
  Random random(5);
  Instance instance;
  instance.columns = 30;
  instance.rows = 20;
  instance.frames = 30;
  for (int i = 0; i < instance.cells() * instance.frames; ++i) {
    instance.probability.push_back(random.Chance(0.02) ? 0.95F : 0.01F);
  }
  instance.obstacle.assign(600, 0);
  for (int cell = 0; cell < 600; ++cell) {
    instance.access.push_back(cell % 30 == 0 || cell % 30 == 29 || cell < 30 || cell >= 570);
  }
  instance.options = {.depth = 2, .birth_cost = 5, .movement_cost = 0.2};
  const auto optimum = LinkPaths(instance.problem(), instance.options);
  ASSERT_GT(optimum->paths.size(), 3U);
  double cost = 0;
  double lowest = kNone;
  const auto found = FindAlternatives(instance.problem(), instance.options, optimum->paths,
                                      {.first_frame = 0, .last_frame = 29, .margin_frames = 0});
  ASSERT_EQ(MessageOf(found), "");
  ASSERT_EQ(found->paths.size(), optimum->paths.size());
  for (const PathInStretch& path : found->paths) {
    cost += path.cost;
    if (!path.weakest) continue;
    EXPECT_GE(path.weakest->margin, 0);
    lowest = std::min(lowest, path.weakest->margin);
  }
  EXPECT_NEAR(cost, optimum->report.cost, 1e-3);
  EXPECT_LE(found->next_best.value(), lowest);
  EXPECT_GE(found->further.value().missing, found->next_best.value());
}

TEST(Alternatives, RefuseWhatIsNoOptimum) {
  const Instance instance = Corridor();
  const auto optimum = LinkPaths(instance.problem(), instance.options);
  const auto message = [&](const LinkingResult& result, const Stretch& stretch) {
    return MessageOf(FindAlternatives(instance.problem(), instance.options, result.paths, stretch));
  };
  const Stretch all = {.first_frame = 0, .last_frame = 5};
  EXPECT_THAT(message(*optimum, {.first_frame = 0, .last_frame = 6}), HasSubstr("frame 0 to 6"));
  EXPECT_THAT(message(*optimum, {.first_frame = -1, .last_frame = 3}), HasSubstr("stretch"));
  EXPECT_THAT(message(*optimum, {.first_frame = 3, .last_frame = 2}), HasSubstr("stretch"));
  EXPECT_THAT(message(*optimum, {.first_frame = 3, .last_frame = 3, .margin_frames = -1}),
              HasSubstr("stretch"));
  EXPECT_THAT(message({}, all), HasSubstr("not an optimal solution"));
  LinkingResult other = *optimum;
  other.paths[0].cells[2] = 1;
  EXPECT_THAT(message(other, all), HasSubstr("not an optimal solution"));
  other.paths[0].cells[2] = 4;
  EXPECT_THAT(message(other, all), HasSubstr("not a solution"));
  other.paths[0].cells[2] = 5;
  EXPECT_THAT(message(other, all), HasSubstr("not a solution"));
  other = *optimum;
  other.paths.push_back(other.paths[0]);
  EXPECT_THAT(message(other, all), HasSubstr("not a solution"));
  other = *optimum;
  other.paths[0].cells.pop_back();
  EXPECT_THAT(message(other, all), HasSubstr("not a solution"));
}

}  // namespace
}  // namespace vantage
