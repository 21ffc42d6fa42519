// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/cell_states.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "vantage/occupancy/test_problems.h"

namespace vantage {
namespace {

using internal::CellStates;
using internal::Convergence;
using testing::OccupancyProblem;

TEST(CellStates, BeginAtThePriorAndMoveByTheStep) {
  OccupancyOptions options;
  options.damping = Damping::kFixed;
  options.smoothing = 0.75;
  CellStates states(options, {0.01, 0.5});
  ASSERT_EQ(states.size(), 2U);
  EXPECT_DOUBLE_EQ(states.absence(0), 0.99);
  EXPECT_DOUBLE_EQ(states.absence(1), 0.5);
  // A score of 0 asks for the prior, where the cells are.
  EXPECT_NEAR(states.Step(0, 0), 0, 1e-15);
  const double asked = 1 / (1 + std::exp(2.0));
  EXPECT_NEAR(states.Step(1, 2), 0.25 * (0.5 - asked), 1e-15);
  EXPECT_NEAR(states.absence(1), 0.75 * 0.5 + 0.25 * asked, 1e-15);
}

TEST(CellStates, StepsGrowOnTheWayAndShrinkAfterATurn) {
  OccupancyOptions options;
  options.smoothing = 0.8;
  CellStates states(options, {0.5});
  // The share of the way to what is asked for, which is 0 or 1 here.
  const auto step = [&](bool present) {
    const double way = present ? states.absence(0) : 1 - states.absence(0);
    return states.Step(0, present ? 1000 : -1000) / way;
  };
  EXPECT_NEAR(step(true), 0.2, 1e-9);
  EXPECT_NEAR(step(true), 0.22, 1e-9);
  EXPECT_NEAR(step(true), 0.242, 1e-9);
  EXPECT_NEAR(step(false), 0.121, 1e-9);
  EXPECT_NEAR(step(true), 0.0605, 1e-9);
  for (int i = 0; i < 20; ++i) step(i % 2 == 0);
  EXPECT_NEAR(step(true), 0.02, 0.01) << "never stands still";
  double last = 0;
  for (int i = 0; i < 60 && states.absence(0) > 1e-3; ++i) last = step(true);
  EXPECT_LE(last, 0.6 + 1e-9) << "never goes all the way";
}

TEST(CellStates, AbsenceStaysAboveItsMinimum) {
  for (const Damping damping : {Damping::kAdaptive, Damping::kFixed}) {
    OccupancyOptions options;
    options.damping = damping;
    options.smoothing = 0;
    CellStates states(options, {0.01});
    for (int i = 0; i < 200; ++i) states.Step(0, 1e6);
    EXPECT_EQ(states.absence(0), CellStates::kMinAbsence);
    for (int i = 0; i < 2000; ++i) states.Step(0, -1e6);
    EXPECT_NEAR(states.absence(0), 1, 1e-4);
  }
}

TEST(CellStates, StartAtAPresenceButNotBelowThePrior) {
  CellStates states({}, {0.1, 0.1, 0.1});
  states.StartAt(0, 0.7);
  states.StartAt(1, 0.01);
  states.StartAt(2, 1);
  EXPECT_DOUBLE_EQ(states.absence(0), 0.3);
  EXPECT_DOUBLE_EQ(states.absence(1), 0.9);
  EXPECT_EQ(states.absence(2), CellStates::kMinAbsence);
}

TEST(Convergence, NeedsStableIterationsInARow) {
  OccupancyOptions options;
  options.tolerance = 0.1;
  options.stable_iterations = 2;
  Convergence convergence(options);
  convergence.Add(0.05);
  convergence.Add(0.1);  // not below
  convergence.Add(0.05);
  EXPECT_FALSE(convergence.reached());
  convergence.Add(0.09);
  EXPECT_TRUE(convergence.reached());
}

/// A grid finer than the pixels: ten cells that four cameras see in the same rectangle, which is
/// foreground.
OccupancyProblem TenCellsInOneRectangle() {
  const CameraView view{{16, 24}, {16, 24}, std::vector<cv::Rect>(10, cv::Rect(5, 4, 6, 16))};
  cv::Mat mask(24, 16, CV_8UC1, cv::Scalar(0));
  mask(view.rectangles[0]) = 255;
  OccupancyProblem problem{std::vector(4, view), std::vector(4, mask), {}};
  problem.options.mode = SolveMode::kExact;
  problem.options.max_iterations = 10000;
  return problem;
}

/// The largest change of a cell in one more evaluation without any damping.
double LargestChange(const OccupancyProblem& problem, const std::vector<float>& q) {
  std::vector<double> n;
  for (const float presence : q) n.push_back(1 - static_cast<double>(presence));
  const std::vector<double> asked = testing::PlainEvaluation(problem, n);
  double change = 0;
  for (std::size_t i = 0; i < n.size(); ++i) change = std::max(change, std::abs(asked[i] - n[i]));
  return change;
}

TEST(AdaptiveDamping, ConvergesWherePlainIterationSwingsForEver) {
  OccupancyProblem problem = TenCellsInOneRectangle();
  SolveReport report;
  for (const Evidence evidence : {Evidence::kPerson, Evidence::kPicture}) {
    problem.options.evidence = evidence;
    // All ten cells rise together and explain the rectangle ten times over; then all give way.
    problem.options.damping = Damping::kFixed;
    for (const double smoothing : {0.0, 0.5, 0.8}) {
      problem.options.smoothing = smoothing;
      Solve(problem, &report);
      EXPECT_FALSE(report.converged) << smoothing;
      EXPECT_EQ(report.iterations, 10000) << smoothing;
      EXPECT_GT(report.last_change, 0.03) << smoothing;
    }
    problem.options.damping = Damping::kAdaptive;
    for (const SolveMode mode : {SolveMode::kFast, SolveMode::kExact}) {
      problem.options.mode = mode;
      const std::vector<float> q = Solve(problem, &report);
      EXPECT_TRUE(report.converged);
      EXPECT_LT(report.iterations, 20);
      EXPECT_LT(LargestChange(problem, q), 1e-2);
      // Somebody is there, nobody knows in which cell.
      EXPECT_THAT(q, ::testing::Each(::testing::FloatNear(q[0], 1e-4F)));
      EXPECT_GT(1 - std::pow(1 - q[0], 10), 0.9);
    }
  }
}

TEST(AdaptiveDamping, ConvergesToFixedPointsInScenes) {
  const testing::Hall hall(6, {120, 90}, 0.25);
  testing::RandomNumbers random(5);
  constexpr int kScenes = 30;
  int fixed_points = 0;
  for (int round = 0; round < kScenes; ++round) {
    OccupancyProblem problem{hall.Views(), hall.Silhouettes(hall.People(random, 8, 0.6)), {}};
    for (cv::Mat& mask : problem.masks) testing::AddBlobs(random, 0.03, 10, mask);
    problem.options.mode = SolveMode::kExact;
    problem.options.tolerance = 1e-5;
    problem.options.max_iterations = 1000;
    SolveReport report;
    const std::vector<float> q = Solve(problem, &report);
    EXPECT_TRUE(report.converged) << round;
    EXPECT_THAT(testing::Raised(q), ::testing::SizeIs(::testing::Ge(4U)));
    fixed_points += LargestChange(problem, q) < 1e-2;
  }
  EXPECT_EQ(fixed_points, kScenes);
}

}  // namespace
}  // namespace vantage
