// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/solver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "vantage/base/parallel.h"
#include "vantage/base/test_support.h"
#include "vantage/occupancy/test_problems.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;
using testing::OccupancyProblem;
using testing::RandomNumbers;
using testing::RandomProblem;
using testing::Solve;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(OccupancySolver, ExactModeAgreesWithThePlainFormulas) {
  RandomNumbers random(20250301);
  constexpr int kProblems = 400;
  int raised = 0, far = 0, cells = 0;
  for (int round = 0; round < kProblems; ++round) {
    const OccupancyProblem problem = RandomProblem(random);
    const std::vector<double> expected = testing::PlainSolve(problem);
    const std::vector<float> q = Solve(problem);
    ASSERT_EQ(q.size(), expected.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      ASSERT_NEAR(q[i], expected[i], 1e-4) << "round " << round << ", cell " << i;
      far += !(std::abs(static_cast<double>(q[i]) - expected[i]) < 1e-6);
      raised += q[i] > 0.5F;
      ++cells;
    }
  }
  RecordProperty("cells", cells);
  RecordProperty("cells_above_half", raised);
  RecordProperty("cells_that_differ_by_1e-6", far);
  EXPECT_GT(raised, kProblems);  // the problems are not trivial
  EXPECT_LE(far, cells / 1000);
}

TEST(OccupancySolver, ReducesMasksByExactAreaAverages) {
  const ImageSize size{40, 24};
  cv::Mat mask(size.height, size.width, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(9, 6, 9, 11)) = 240;  // averages of 16 pixels are whole numbers
  CameraView view{size, {10, 6}, {cv::Rect(2, 1, 2, 3), cv::Rect(6, 2, 2, 3)}};
  // The same with the average taken by hand.
  cv::Mat average(6, 10, CV_8UC1);
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 10; ++x) {
      average.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>(std::lround(cv::mean(mask(cv::Rect(4 * x, 4 * y, 4, 4)))[0]));
    }
  }
  CameraView small = view;
  small.mask_size = small.size;
  for (const SolveMode mode : {SolveMode::kFast, SolveMode::kExact}) {
    const OccupancyOptions options{.mode = mode};
    const std::vector<float> q = Solve({{view}, {mask}, options});
    const std::vector<float> expected = Solve({{small}, {average}, options});
    EXPECT_GT(q[0], 0.5F);
    for (std::size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(q[i], expected[i], 1e-5);
  }
}

TEST(OccupancySolver, CellThatExplainsTheMaskIsOccupied) {
  CameraView view{{60, 40}, {60, 40}, {}};
  for (int x = 0; x + 10 <= 60; x += 5) view.rectangles.push_back(cv::Rect(x, 10, 10, 20));
  cv::Mat mask(40, 60, CV_8UC1, cv::Scalar(0));
  mask(view.rectangles[4]) = 255;
  for (const OccupancyOptions& options : {OccupancyOptions(), OriginalPomOptions()}) {
    SolveReport report;
    const std::vector<float> q = Solve({{view}, {mask}, options}, &report);
    EXPECT_TRUE(report.converged);
    EXPECT_LT(report.last_change, options.tolerance);
    EXPECT_GT(report.iterations, options.stable_iterations);
    for (std::size_t i = 0; i < q.size(); ++i) {
      if (i == 4) {
        EXPECT_GT(q[i], 0.99);
      } else {
        EXPECT_LT(q[i], 0.02);
      }
    }
  }
}

TEST(OccupancySolver, ReportsCellsIteratedAndIterations) {
  CameraView view{{60, 40}, {60, 40}, {}};
  for (int x = 0; x + 10 <= 60; x += 10) view.rectangles.push_back(cv::Rect(x, 10, 10, 20));
  cv::Mat mask(40, 60, CV_8UC1, cv::Scalar(0));
  mask(view.rectangles[4]) = 255;
  OccupancyProblem problem{{view}, {mask}, {}};
  problem.options.max_iterations = 2;
  SolveReport report;
  Solve(problem, &report);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 2);
  EXPECT_GT(report.last_change, 0.01);
  EXPECT_EQ(report.cells_iterated, 1) << "of six, one has foreground";
  problem.options.mode = SolveMode::kExact;
  Solve(problem, &report);
  EXPECT_EQ(report.cells_iterated, 6);
}

TEST(OccupancySolver, BeginsAgainAtAConvergedMapAndStaysThere) {
  const testing::Hall hall(4, {160, 120}, 0.25);
  RandomNumbers random(8);
  for (int round = 0; round < 8; ++round) {
    OccupancyProblem problem{hall.Views(), hall.Silhouettes(hall.People(random, 5, 0.8)), {}};
    for (cv::Mat& mask : problem.masks) testing::AddBlobs(random, 0.05, 12, mask);
    problem.options.mode = round % 2 == 0 ? SolveMode::kFast : SolveMode::kExact;
    problem.options.max_iterations = 2000;
    SolveReport cold, warm;
    const std::vector<float> q = Solve(problem, &cold);
    ASSERT_TRUE(cold.converged);
    EXPECT_THAT(testing::Raised(q), ::testing::Not(::testing::IsEmpty()));
    problem.previous = q;
    const std::vector<float> again = Solve(problem, &warm);
    EXPECT_TRUE(warm.converged);
    EXPECT_LT(warm.iterations, 0.75 * cold.iterations) << "round " << round;
    for (std::size_t i = 0; i < q.size(); ++i) {
      ASSERT_NEAR(q[i], again[i], 0.05) << "round " << round << ", cell " << i;
    }
    EXPECT_EQ(testing::Raised(q), testing::Raised(again));
  }
}

TEST(OccupancySolver, BeginsAtThePriorAtLeast) {
  // From a map that is certain of nobody, a person is found as from the prior.
  CameraView view{{20, 30}, {20, 30}, {cv::Rect(5, 5, 8, 20)}};
  cv::Mat mask(30, 20, CV_8UC1, cv::Scalar(0));
  mask(view.rectangles[0]) = 255;
  OccupancyProblem problem{{view}, {mask}, {}};
  const std::vector<float> q = Solve(problem);
  problem.previous = {0};
  EXPECT_EQ(Solve(problem), q);
  EXPECT_GT(q[0], 0.99);
}

TEST(OccupancySolver, FramesInParallelGiveTheSameBits) {
  RandomNumbers random(15);
  for (const SolveMode mode : {SolveMode::kFast, SolveMode::kExact}) {
    OccupancyProblem problem = RandomProblem(random);
    problem.options.mode = mode;
    const OccupancySolver solver =
        *OccupancySolver::Create(problem.views, problem.options, problem.priors);
    const std::vector<float> expected = Solve(problem);
    std::vector<std::vector<float>> q(64, std::vector<float>(solver.cell_count()));
    ParallelFor(4, 64, [&](std::int64_t i) {
      EXPECT_TRUE(solver.Solve(problem.masks, q[static_cast<std::size_t>(i)], problem.previous));
    });
    EXPECT_THAT(q, ::testing::Each(expected));
  }
}

TEST(OccupancySolver, ExtremeOptionsStayFinite) {
  RandomNumbers random(16);
  for (int round = 0; round < 200; ++round) {
    OccupancyProblem problem = RandomProblem(random);
    problem.options.mode = round % 2 == 0 ? SolveMode::kFast : SolveMode::kExact;
    problem.options.variance = 1e-7;
    problem.options.smoothing = 0;
    problem.options.ignored = round % 3 == 0 ? 1 : 0.9;
    problem.options.noise = 1e-6;
    problem.options.worth = 1000;
    problem.options.background_cost = round % 5 == 0 ? 10 : 0;
    if (!problem.priors.empty()) problem.priors[0] = round % 7 == 0 ? 1e-300 : 1 - 1e-16;
    for (const float q : Solve(problem)) {
      ASSERT_GE(q, 0) << "round " << round;
      ASSERT_LE(q, 1) << "round " << round;
    }
  }
}

TEST(OccupancySolver, RefusesViewsThatDoNotFit) {
  const CameraView view{{8, 6}, {8, 6}, {cv::Rect(0, 0, 8, 6)}};
  EXPECT_THAT(MessageOf(OccupancySolver::Create({}, {})), HasSubstr("no camera"));
  EXPECT_THAT(MessageOf(OccupancySolver::Create({CameraView{{8, 6}, {8, 6}, {}}}, {})),
              HasSubstr("0 cells"));
  CameraView outside = view;
  outside.rectangles[0] = cv::Rect(4, 0, 5, 6);
  EXPECT_THAT(MessageOf(OccupancySolver::Create({view, outside}, {})),
              HasSubstr("the rectangle of cell 0 leaves the 8 x 6 px picture of camera 1"));
  CameraView longer = view;
  longer.rectangles.resize(2);
  EXPECT_THAT(MessageOf(OccupancySolver::Create({view, longer}, {})), HasSubstr("camera 1 has 2"));
  CameraView no_size = view;
  no_size.mask_size = {0, 6};
  EXPECT_THAT(MessageOf(OccupancySolver::Create({view, no_size}, {})),
              HasSubstr("camera 1 is 0 x 6 px"));
  for (const float weight : {-0.1F, 1.1F, std::numeric_limits<float>::quiet_NaN()}) {
    CameraView weighted = view;
    weighted.weights = {weight};
    EXPECT_THAT(MessageOf(OccupancySolver::Create({weighted}, {})),
                HasSubstr("must be between 0 and 1"));
  }
  CameraView weights = view;
  weights.weights = {1, 1};
  EXPECT_THAT(MessageOf(OccupancySolver::Create({weights}, {})),
              HasSubstr("camera 0 has weights for 2 of its 1 cells"));
}

TEST(OccupancySolver, RefusesInformativePixelsThatDoNotFit) {
  CameraView view{{8, 6}, {4, 3}, {cv::Rect(0, 0, 4, 3)}};
  view.informative = cv::Mat::ones(6, 8, CV_8UC1);
  EXPECT_TRUE(OccupancySolver::Create({view}, {}));
  for (const cv::Mat& informative :
       {cv::Mat(cv::Mat::ones(3, 4, CV_8UC1)), cv::Mat(cv::Mat::ones(6, 8, CV_8UC3)),
        cv::Mat(cv::Mat::ones(6, 8, CV_32FC1))}) {
    view.informative = informative;
    EXPECT_THAT(MessageOf(OccupancySolver::Create({view}, {})),
                HasSubstr("they must be as its masks, 8 x 6 with one channel of 1 byte"));
  }
}

TEST(OccupancySolver, RefusesPriorsAndOptionsOutOfRange) {
  const CameraView view{{8, 6}, {8, 6}, {cv::Rect(0, 0, 8, 6)}};
  for (const double prior : {0.0, 1.0, -0.5, 2.0, kNaN}) {
    EXPECT_THAT(MessageOf(OccupancySolver::Create({view}, {}, {prior})),
                HasSubstr("it must be above 0 and below 1"));
  }
  EXPECT_THAT(MessageOf(OccupancySolver::Create({view}, {}, {0.1, 0.1})),
              HasSubstr("priors for 2 cells; the grid has 1"));
  const auto refused = [&](const OccupancyOptions& options) {
    return MessageOf(OccupancySolver::Create({view}, options));
  };
  for (const double bad : {kNaN, -1.0, 1e9}) {
    EXPECT_THAT(refused({.prior = bad}), HasSubstr("occupancy.prior is"));
    EXPECT_THAT(refused({.worth = bad}), HasSubstr("occupancy.worth is"));
    EXPECT_THAT(refused({.background_cost = bad}), HasSubstr("occupancy.background_cost is"));
    EXPECT_THAT(refused({.variance = bad}), HasSubstr("occupancy.variance is"));
    EXPECT_THAT(refused({.noise = bad}), HasSubstr("occupancy.noise is"));
    EXPECT_THAT(refused({.smoothing = bad}), HasSubstr("occupancy.smoothing is"));
    EXPECT_THAT(refused({.tolerance = bad}), HasSubstr("occupancy.tolerance is"));
    EXPECT_THAT(refused({.ignored = bad}), HasSubstr("occupancy.ignored is"));
    EXPECT_THAT(refused({.reduction = bad}), HasSubstr("occupancy.reduction is"));
  }
  EXPECT_THAT(refused({.smoothing = 1}), HasSubstr("occupancy.smoothing is 1"));
  EXPECT_THAT(refused({.worth = 0}), HasSubstr("occupancy.worth is 0"));
  EXPECT_THAT(refused({.max_iterations = 0}), HasSubstr("occupancy.max_iterations is 0"));
  EXPECT_THAT(refused({.stable_iterations = 0}), HasSubstr("occupancy.stable_iterations is 0"));
  EXPECT_EQ(refused({.prior = 1e-6, .worth = 1000, .background_cost = 0, .smoothing = 0}), "");
}

TEST(OccupancySolver, RefusesMasksAndMapsThatDoNotFit) {
  const CameraView view{{8, 6}, {8, 6}, {cv::Rect(0, 0, 8, 6)}};
  const OccupancySolver solver = *OccupancySolver::Create({view}, {});
  std::vector<float> q(1), wrong(2);
  const std::vector<cv::Mat> good = {cv::Mat::zeros(6, 8, CV_8UC1)};
  const std::vector<cv::Mat> size = {cv::Mat::zeros(8, 6, CV_8UC1)};
  const std::vector<cv::Mat> type = {cv::Mat::zeros(6, 8, CV_8UC3)};
  EXPECT_TRUE(solver.Solve(good, q));
  EXPECT_TRUE(solver.Solve(good, q, std::vector<float>{0.5F}));
  EXPECT_THAT(MessageOf(solver.Solve(size, q)), HasSubstr("mask of camera 0 is 6 x 8 px"));
  EXPECT_THAT(MessageOf(solver.Solve(type, q)), HasSubstr("3 channels"));
  EXPECT_THAT(MessageOf(solver.Solve({}, q)), HasSubstr("0 masks are given for 1 cameras"));
  EXPECT_THAT(MessageOf(solver.Solve(good, wrong)), HasSubstr("room for 2 cells"));
  EXPECT_THAT(MessageOf(solver.Solve(good, q, wrong)),
              HasSubstr("the map to begin at has 2 cells; the grid has 1"));
  for (const float presence : {-0.1F, 1.5F, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_THAT(MessageOf(solver.Solve(good, q, std::vector<float>{presence})),
                HasSubstr("a cell of the map to begin at is"));
  }
}

}  // namespace
}  // namespace vantage
