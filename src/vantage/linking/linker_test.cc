// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/linker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "vantage/base/test_support.h"
#include "vantage/linking/node_cost.h"

namespace vantage {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A corridor of cells in one row, people coming and going at its two ends.
class Corridor {
 public:
  Corridor(int cells, int frames)
      : cells_(cells),
        frames_(frames),
        probability_(static_cast<std::size_t>(cells * frames), 0.01F),
        access_(static_cast<std::size_t>(cells), 0),
        obstacle_(static_cast<std::size_t>(cells), 0) {
    if (cells > 0) access_.front() = access_.back() = 1;
  }
  void Set(int frame, int cell, float probability) {
    probability_[static_cast<std::size_t>(frame * cells_ + cell)] = probability;
  }
  void Block(int cell) { obstacle_[static_cast<std::size_t>(cell)] = 1; }
  void NoAccess() { std::fill(access_.begin(), access_.end(), std::uint8_t{0}); }
  LinkingProblem problem() const {
    return {.columns = cells_,
            .rows = 1,
            .frames = frames_,
            .probability = probability_,
            .access = access_,
            .obstacle = obstacle_};
  }

 private:
  int cells_, frames_;
  std::vector<float> probability_;
  std::vector<std::uint8_t> access_, obstacle_;
};

LinkingResult Link(const LinkingProblem& problem, const LinkingOptions& options) {
  Result<LinkingResult> result = LinkPaths(problem, options);
  EXPECT_TRUE(result) << testing::MessageOf(result);
  return result ? *result : LinkingResult{};
}

TEST(Linker, FollowsOnePersonThroughAGap) {
  Corridor corridor(5, 5);
  for (const int frame : {0, 1, 3, 4}) corridor.Set(frame, frame, 0.99F);
  const LinkingResult result =
      Link(corridor.problem(), {.depth = 1, .birth_cost = 5, .movement_cost = 0});
  ASSERT_THAT(result.paths, SizeIs(1));
  EXPECT_EQ(result.paths[0].first_frame, 0);
  EXPECT_THAT(result.paths[0].cells, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_NEAR(result.report.cost, 5 - 3 * std::log(99), 1e-4);  // four seen, one missed
  EXPECT_EQ(result.report.paths, 1);
  EXPECT_EQ(result.report.nodes, 25);
}

TEST(Linker, FindsNobodyWherePathsDoNotPay) {
  Corridor corridor(3, 2);
  corridor.Set(0, 1, 0.99F);
  EXPECT_THAT(Link(corridor.problem(), {.depth = 1, .birth_cost = 5}).paths, IsEmpty());
  EXPECT_EQ(Link(corridor.problem(), {.depth = 1, .birth_cost = 5}).report.cost, 0);
}

TEST(Linker, PeopleAppearInTheMiddleOnlyInTheFirstFrame) {
  Corridor corridor(9, 6);
  corridor.NoAccess();
  for (int frame = 2; frame < 4; ++frame) corridor.Set(frame, 4, 0.999F);
  // Two sightings earn 13.8; two frames before and two after cost 4.6 each.
  EXPECT_THAT(Link(corridor.problem(), {.depth = 1, .birth_cost = 0}).paths, IsEmpty());
  for (int frame = 0; frame < 2; ++frame) corridor.Set(frame, 4, 0.999F);
  const LinkingResult result = Link(corridor.problem(), {.depth = 1, .birth_cost = 0});
  ASSERT_THAT(result.paths, SizeIs(1));
  EXPECT_THAT(result.paths[0].cells, SizeIs(6));
}

TEST(Linker, CapKeepsTheBestPaths) {
  Corridor corridor(7, 4);
  for (int frame = 0; frame < 4; ++frame) {
    corridor.Set(frame, 1, 0.9F);
    corridor.Set(frame, 3, 0.99F);
    corridor.Set(frame, 5, 0.95F);
  }
  LinkingOptions options{.depth = 0, .birth_cost = 1};
  EXPECT_THAT(Link(corridor.problem(), options).paths, SizeIs(3));
  options.max_paths = 2;
  const LinkingResult result = Link(corridor.problem(), options);
  ASSERT_THAT(result.paths, SizeIs(2));
  EXPECT_THAT(result.paths[0].cells, ElementsAre(3, 3, 3, 3));
  EXPECT_THAT(result.paths[1].cells, ElementsAre(5, 5, 5, 5));
}

TEST(Linker, WalksAroundObstacles) {
  Corridor corridor(3, 3);
  for (int frame = 0; frame < 3; ++frame) corridor.Set(frame, frame, 0.999F);
  const LinkingOptions options{.depth = 1, .birth_cost = 1, .movement_cost = 2};
  EXPECT_THAT(Link(corridor.problem(), options).paths, SizeIs(1));
  corridor.Block(1);
  const LinkingResult result = Link(corridor.problem(), options);
  for (const LinkedPath& path : result.paths) {
    EXPECT_THAT(path.cells, ::testing::Not(::testing::Contains(1)));
  }
}

TEST(Linker, MovementCostStraightensTies) {
  // Everything is equally likely: only the movement cost decides.
  Corridor corridor(4, 6);
  for (int frame = 0; frame < 6; ++frame) {
    for (int cell = 0; cell < 4; ++cell) corridor.Set(frame, cell, 0.9F);
  }
  const LinkingResult result =
      Link(corridor.problem(), {.depth = 2, .birth_cost = 1, .movement_cost = 0.2});
  ASSERT_THAT(result.paths, SizeIs(4));
  for (const LinkedPath& path : result.paths) {
    EXPECT_THAT(path.cells, ::testing::Each(path.cells.front()));
  }
}

TEST(Linker, SmallestSizes) {
  EXPECT_THAT(Link(Corridor(3, 0).problem(), {.depth = 1}).paths, IsEmpty());
  Corridor one(1, 1);
  EXPECT_THAT(Link(one.problem(), {.depth = 1, .birth_cost = 1}).paths, IsEmpty());
  one.Set(0, 0, 1.0F);
  const LinkingResult result = Link(one.problem(), {.depth = 1, .birth_cost = 1});
  ASSERT_THAT(result.paths, SizeIs(1));
  EXPECT_THAT(result.paths[0].cells, ElementsAre(0));
  EXPECT_NEAR(result.report.cost, 1 - std::log((1 - 1e-6) / 1e-6), 1e-6);
}

TEST(Linker, CostsAreClippedOnBothSides) {
  const linking::NodeCost cost(1e-6);
  const double largest = std::log((1 - 1e-6) / 1e-6);
  EXPECT_EQ(cost(0.0F), linking::ToUnits(largest));
  EXPECT_EQ(cost(1.0F), -linking::ToUnits(largest));
  EXPECT_EQ(cost(1e-7F), linking::ToUnits(largest));
  EXPECT_EQ(cost(0.5F), 0);
  EXPECT_EQ(cost(0.75F), linking::ToUnits(-std::log(3.0)));
  // The library's logarithm, at most a rounding of the unit apart, over many floats.
  for (float p = 1e-6F; p < 1; p *= 1.001F) {
    const double right = std::log((1 - static_cast<double>(p)) / static_cast<double>(p));
    ASSERT_NEAR(cost(p) / linking::kUnitsPerCost, right, 0.5001 / linking::kUnitsPerCost);
  }
  const linking::NodeCost tiny_clip(1e-300);
  EXPECT_EQ(tiny_clip(1.0F), -tiny_clip(0.0F));
  EXPECT_NEAR(tiny_clip(0.0F) / linking::kUnitsPerCost, 300 * std::log(10.0), 1e-5);
}

TEST(Linker, PeopleMoveAtMostAsFastAsAllowed) {
  // Three cells a frame: 3 x 0.5 m x 10 frames per second = 15 m/s.
  Corridor corridor(8, 2);
  corridor.Set(0, 1, 0.99F);
  corridor.Set(1, 4, 0.99F);
  corridor.NoAccess();
  LinkingProblem problem = corridor.problem();
  problem.cell_m = 0.5;
  problem.frames_per_second = 10;
  const auto cost = [&](double speed_mps) {
    return Link(problem, {.max_speed_mps = speed_mps, .birth_cost = 1, .movement_cost = 2})
        .report.cost;
  };
  EXPECT_NEAR(cost(15), 1 - 2 * std::log(99) + 2, 1e-4) << "all of the movement cost";
  EXPECT_NEAR(cost(30), 1 - 2 * std::log(99) + 1, 1e-4) << "half";
  EXPECT_NEAR(cost(75), 1 - 2 * std::log(99) + 0.4, 1e-4) << "more than 10 cells";
  EXPECT_EQ(cost(14.9), 0);
  // However slow, people may go to the next cell at some time.
  corridor.Set(1, 2, 0.99F);
  EXPECT_NEAR(cost(2.5), 1 - 2 * std::log(99) + 4, 1e-4);
  // Nor do speeds beside 0 overflow.
  EXPECT_EQ(cost(1e-300), 0);
  EXPECT_NEAR(
      Link(problem, {.max_speed_mps = 1e-320, .birth_cost = 1, .movement_cost = 0}).report.cost,
      1 - 2 * std::log(99), 1e-4);
}

/// Somebody in cell 4 and then in cell 6.
Corridor JumpOfTwoCells() {
  Corridor corridor(9, 2);
  corridor.Set(0, 4, 0.99F);
  corridor.Set(1, 6, 0.99F);
  corridor.NoAccess();
  return corridor;
}

TEST(Linker, TheDefaultIsASpeedAndNeedsCellsAndFrameRate) {
  // Two cells in one frame, 20 frames per second: 7 m/s in cells of 0.175 m.
  const Corridor corridor = JumpOfTwoCells();
  LinkingProblem problem = corridor.problem();
  problem.frames_per_second = 20;
  const auto paths = [&](double cell_m) {
    problem.cell_m = cell_m;
    return Link(problem, {.birth_cost = 1, .movement_cost = 0}).paths.size();
  };
  EXPECT_EQ(paths(0.174), 1U);
  EXPECT_EQ(paths(0.176), 0U);

  const auto message = [&](double cell_m, double frames_per_second) {
    problem.cell_m = cell_m;
    problem.frames_per_second = frames_per_second;
    return testing::MessageOf(LinkPaths(problem, {}));
  };
  EXPECT_EQ(message(0.3, 20), "");
  for (const double wrong : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(message(0.3, wrong), HasSubstr("linking.max_speed needs the size of cells"));
    EXPECT_THAT(message(wrong, 20), HasSubstr("give linking.depth in its place"));
  }
}

TEST(Linker, DepthTakesThePlaceOfMaxSpeed) {
  const Corridor corridor = JumpOfTwoCells();
  LinkingProblem problem = corridor.problem();
  problem.cell_m = 0.5;
  problem.frames_per_second = 10;
  for (const double max_speed_mps : {0.01, 1.0, 1000.0}) {
    const auto paths = [&](int depth) {
      const LinkingOptions options{
          .max_speed_mps = max_speed_mps, .depth = depth, .birth_cost = 1, .movement_cost = 0};
      return Link(problem, options).paths.size();
    };
    EXPECT_EQ(paths(0), 0U) << max_speed_mps;
    EXPECT_EQ(paths(1), 0U) << max_speed_mps;
    EXPECT_EQ(paths(2), 1U) << max_speed_mps;
  }
}

TEST(Linker, RefusesWhatIsNotAProblem) {
  const auto message = [](const LinkingProblem& problem, const LinkingOptions& options) {
    return testing::MessageOf(LinkPaths(problem, options));
  };
  Corridor corridor(3, 2);
  EXPECT_THAT(message(corridor.problem(), {.depth = -1}), HasSubstr("linking.depth is -1"));
  EXPECT_THAT(message(corridor.problem(), {.clip = 0.5}), HasSubstr("linking.clip is 0.5"));
  EXPECT_THAT(message(corridor.problem(), {.birth_cost = -1}), HasSubstr("linking.birth_cost"));

  LinkingProblem wrong = corridor.problem();
  wrong.frames = 3;
  EXPECT_THAT(message(wrong, {.depth = 1}), HasSubstr("probability has 6 values; it must have 9"));
  wrong = corridor.problem();
  wrong.access = {};
  EXPECT_THAT(message(wrong, {.depth = 1}), HasSubstr("access has 0 values; it must have 3"));
  wrong = corridor.problem();
  wrong.columns = 0;
  EXPECT_THAT(message(wrong, {.depth = 1}), HasSubstr("at least 1 x 1"));
  wrong.columns = wrong.rows = std::numeric_limits<int>::max();
  wrong.frames = std::numeric_limits<std::int64_t>::max();
  EXPECT_THAT(message(wrong, {.depth = 1}), HasSubstr("at most 32767 on a side"));

  corridor.Set(1, 2, std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(message(corridor.problem(), {.depth = 1}), HasSubstr("cell 2 in frame 1 is nan"));
  corridor.Set(1, 2, 1.5F);
  EXPECT_THAT(message(corridor.problem(), {.depth = 1}), HasSubstr("cell 2 in frame 1 is 1.5"));
}

TEST(Linker, StopsWhenAsked) {
  Corridor corridor(3, 3);
  corridor.Set(0, 1, 1.0F);
  const std::atomic<bool> stop{true};
  RunControl control;
  control.stop = &stop;
  EXPECT_THAT(testing::MessageOf(LinkPaths(corridor.problem(), {.depth = 1}, control)),
              HasSubstr("interrupted"));
}

TEST(Linker, ReportsProgressUpToTheEnd) {
  Corridor corridor(3, 4);
  corridor.Set(0, 1, 1.0F);
  std::int64_t last = -1;
  RunControl control;
  control.progress = [&](std::int64_t done, std::int64_t total) {
    EXPECT_LE(last, done);
    EXPECT_LE(done, total);
    last = done == total ? total : done;
  };
  ASSERT_TRUE(LinkPaths(corridor.problem(), {.depth = 1}, control));
  EXPECT_EQ(last, 8);
}

}  // namespace
}  // namespace vantage
