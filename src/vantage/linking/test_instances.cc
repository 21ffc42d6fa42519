// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/test_instances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>

namespace vantage::testing {
namespace {

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

}  // namespace

LinkingProblem Instance::problem() const {
  return {.columns = columns,
          .rows = rows,
          .frames = frames,
          .probability = probability,
          .access = access,
          .obstacle = obstacle};
}

StreamGrid Instance::grid() const {
  return {.columns = columns, .rows = rows, .access = access, .obstacle = obstacle};
}

std::span<const float> Instance::Map(int frame) const {
  return std::span(probability)
      .subspan(static_cast<std::size_t>(frame * cells()), static_cast<std::size_t>(cells()));
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
  if (random.Chance(0.4)) instance.options.inside_cost = 10 * random.Unit();
  return instance;
}

std::int64_t Units(double cost) { return std::llround(cost * 1048576.0); }

std::int64_t NodeUnits(const Instance& instance, int frame, int cell) {
  const double p = instance.probability[static_cast<std::size_t>(frame * instance.cells() + cell)];
  const double largest = std::log((1 - instance.options.clip) / instance.options.clip);
  return Units(std::clamp(-std::log(p / (1 - p)), -largest, largest));
}

bool Access(const Instance& instance, int cell) {
  return instance.access[static_cast<std::size_t>(cell)] != 0;
}

std::optional<std::int64_t> EdgeUnits(const Instance& instance, int cell, bool free_frame) {
  if (free_frame || Access(instance, cell)) return 0;
  if (!instance.options.inside_cost) return std::nullopt;
  return Units(*instance.options.inside_cost);
}

bool Blocked(const Instance& instance, int cell) {
  return !instance.obstacle.empty() && instance.obstacle[static_cast<std::size_t>(cell)] != 0;
}

bool MayMove(const Instance& instance, int from, int to) {
  const int columns = std::abs(from % instance.columns - to % instance.columns);
  const int rows = std::abs(from / instance.columns - to / instance.columns);
  return std::max(columns, rows) <= *instance.options.depth;
}

std::int64_t MoveUnits(const Instance& instance, int from, int to) {
  return Units(instance.options.movement_cost / std::max(*instance.options.depth, 1) *
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
    const auto entry = EdgeUnits(instance, path.cells.front(), path.first_frame == 0);
    const std::int64_t end = path.end_frame();
    EXPECT_LE(end, instance.frames);
    const auto exit = EdgeUnits(instance, path.cells.back(), end == instance.frames);
    EXPECT_TRUE(entry && exit);
    cost += entry.value_or(0) + exit.value_or(0);
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

}  // namespace vantage::testing
