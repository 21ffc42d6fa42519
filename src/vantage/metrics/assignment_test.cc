// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/assignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <utility>

namespace vantage {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// (-pairs, cost): smaller is better.
using Score = std::pair<int, double>;

Score BestByTryingAll(const CostMatrix& cost, std::size_t row, std::set<std::size_t>& taken) {
  if (row == cost.rows) return {0, 0};
  Score best = BestByTryingAll(cost, row + 1, taken);
  for (std::size_t column = 0; column < cost.columns; ++column) {
    if (!std::isfinite(cost(row, column)) || taken.contains(column)) continue;
    taken.insert(column);
    Score score = BestByTryingAll(cost, row + 1, taken);
    taken.erase(column);
    best = std::min(best, Score(score.first - 1, score.second + cost(row, column)));
  }
  return best;
}

TEST(Assignment, EqualsTryingAll) {
  std::mt19937 engine(7);
  for (int trial = 0; trial < 2000; ++trial) {
    CostMatrix cost(engine() % 6, engine() % 6);
    const unsigned forbidden = engine() % 11;
    for (double& value : cost.values) {
      // Whole numbers: sums are exact and ties are many.
      if (engine() % 10 >= forbidden) value = engine() % 8;
    }
    const std::vector<int> column_of = Assign(cost);
    ASSERT_EQ(column_of.size(), cost.rows);
    Score score(0, 0);
    std::set<int> used;
    for (std::size_t row = 0; row < cost.rows; ++row) {
      if (column_of[row] < 0) continue;
      ASSERT_TRUE(used.insert(column_of[row]).second) << "a column is joined twice";
      score.first -= 1;
      score.second += cost(row, static_cast<std::size_t>(column_of[row]));
    }
    std::set<std::size_t> taken;
    ASSERT_EQ(score, BestByTryingAll(cost, 0, taken)) << trial;
  }
}

TEST(Assignment, MorePairsGoBeforeLessCost) {
  CostMatrix cost(2, 2);
  cost(0, 0) = 0;
  cost(0, 1) = 100;
  cost(1, 0) = 100;
  EXPECT_THAT(Assign(cost), ElementsAre(1, 0));
}

TEST(Assignment, NothingToJoin) {
  EXPECT_THAT(Assign(CostMatrix(0, 3)), IsEmpty());
  EXPECT_THAT(Assign(CostMatrix(2, 0)), ElementsAre(-1, -1));
  EXPECT_THAT(Assign(CostMatrix(2, 2)), ElementsAre(-1, -1));
}

}  // namespace
}  // namespace vantage
