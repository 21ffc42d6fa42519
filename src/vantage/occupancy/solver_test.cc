// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/solver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "vantage/base/parallel.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;

struct Problem {
  std::vector<CameraView> views;
  std::vector<cv::Mat> masks;
  OccupancyOptions options;
};

/// Section 3 as printed, one loop each: products over rectangles pixel by pixel, sums over the
/// pixels of a rectangle. Masks at the views' size.
std::vector<double> PlainSolve(const Problem& problem) {
  const OccupancyOptions& o = problem.options;
  const std::size_t cells = problem.views.front().rectangles.size();
  std::vector<double> n(cells, 1 - o.prior);
  const auto log_likelihood = [&](double x) { return -x * x / (2 * o.variance); };
  int stable = 0;
  for (int iteration = 0; iteration < o.max_iterations && stable < o.stable_iterations;
       ++iteration) {
    std::vector<double> score(cells, 0);
    for (std::size_t c = 0; c < problem.views.size(); ++c) {
      if (problem.masks[c].empty()) continue;
      const CameraView& view = problem.views[c];
      cv::Mat_<double> m(view.size.height, view.size.width, 1.0), b;
      problem.masks[c].convertTo(b, CV_64F, 1.0 / 255);
      for (std::size_t i = 0; i < cells; ++i) {
        if (!view.rectangles[i].empty() && n[i] <= o.ignored) m(view.rectangles[i]) *= n[i];
      }
      const cv::Mat_<double> mb = m.mul(b);
      const double image = static_cast<double>(m.total());
      const double s = image * (1 + o.noise) - cv::sum(m)[0];
      const double d = s + 2 * cv::sum(mb)[0] - cv::sum(b)[0];
      for (std::size_t i = 0; i < cells; ++i) {
        if (view.rectangles[i].empty()) continue;
        const double l = 1 - 1 / n[i];
        const double sum_m = cv::sum(m(view.rectangles[i]))[0];
        const double sum_mb = cv::sum(mb(view.rectangles[i]))[0];
        score[i] += log_likelihood((d + sum_m - 2 * sum_mb) / (s + sum_m)) -
                    log_likelihood((d + l * (sum_m - 2 * sum_mb)) / (s + l * sum_m));
      }
    }
    double change = 0;
    for (std::size_t i = 0; i < cells; ++i) {
      const double old = n[i];
      n[i] = o.smoothing * old +
             (1 - o.smoothing) / (1 + std::exp(std::log(o.prior / (1 - o.prior)) + score[i]));
      change = std::max(change, std::abs(n[i] - old));
    }
    stable = change < o.tolerance ? stable + 1 : 0;
  }
  std::vector<double> q(cells);
  for (std::size_t i = 0; i < cells; ++i) q[i] = 1 - n[i];
  return q;
}

class RandomProblems {
 public:
  explicit RandomProblems(unsigned seed) : random_(seed) {}

  int Int(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double Real(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  /// Masks hold the rectangles of some cells and some noise; some are soft, some cameras have none,
  /// some rectangles are not visible.
  Problem Next() {
    Problem problem;
    const int cameras = Int(1, 4), cells = Int(1, 40);
    std::vector<bool> occupied(static_cast<std::size_t>(cells));
    for (auto&& cell : occupied) cell = Real(0, 1) < 0.1;
    for (int c = 0; c < cameras; ++c) {
      const ImageSize size{Int(3, 40), Int(3, 30)};
      CameraView view{size, size, {}};
      cv::Mat mask(size.height, size.width, CV_8UC1, cv::Scalar(0));
      const bool soft = Int(0, 2) == 0;
      for (std::size_t i = 0; i < occupied.size(); ++i) {
        cv::Rect r(Int(0, size.width - 1), Int(0, size.height - 1), 0, 0);
        r.width = Int(1, std::min(size.width - r.x, 12));
        r.height = Int(1, std::min(size.height - r.y, 20));
        if (Int(0, 5) == 0) r = cv::Rect();
        view.rectangles.push_back(r);
        if (occupied[i] && !r.empty()) mask(r) = soft ? Int(100, 255) : 255;
      }
      for (int k = Int(0, 20); k > 0; --k) {
        mask.at<std::uint8_t>(Int(0, size.height - 1), Int(0, size.width - 1)) =
            static_cast<std::uint8_t>(soft ? Int(0, 255) : 255 * Int(0, 1));
      }
      problem.views.push_back(view);
      problem.masks.push_back(Int(0, 7) == 0 ? cv::Mat() : mask);
    }
    problem.options.prior = Real(0.005, 0.1);
    problem.options.variance = std::pow(10, Real(-3, -1));
    problem.options.ignored = Int(0, 1) == 0 ? 1.0 : 0.995;
    problem.options.max_iterations = Int(1, 100);
    return problem;
  }

 private:
  std::mt19937 random_;
};

std::vector<float> Solve(const Problem& problem) {
  const OccupancySolver solver = *OccupancySolver::Create(problem.views, problem.options);
  std::vector<float> q(solver.cell_count());
  EXPECT_TRUE(solver.Solve(problem.masks, q));
  return q;
}

TEST(OccupancySolver, AgreesWithThePlainFormulas) {
  RandomProblems problems(20250301);
  int raised = 0;
  for (int round = 0; round < 300; ++round) {
    const Problem problem = problems.Next();
    const std::vector<double> expected = PlainSolve(problem);
    const std::vector<float> q = Solve(problem);
    for (std::size_t i = 0; i < q.size(); ++i) {
      ASSERT_NEAR(q[i], expected[i], 1e-6) << "round " << round << ", cell " << i;
      raised += q[i] > 0.5F;
    }
  }
  EXPECT_GT(raised, 200);  // the problems are not trivial
}

TEST(OccupancySolver, ReducesMasksByExactAreaAverages) {
  const ImageSize size{40, 24};
  cv::Mat mask(size.height, size.width, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(9, 6, 9, 11)) = 240;  // averages of 16 pixels are whole numbers
  CameraView view{size, {10, 6}, {cv::Rect(2, 1, 2, 3), cv::Rect(6, 2, 2, 3)}};
  Problem problem{{view}, {mask}, {}};
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
  const std::vector<float> q = Solve(problem);
  const std::vector<float> expected = Solve({{small}, {average}, {}});
  EXPECT_GT(q[0], 0.5F);
  for (std::size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(q[i], expected[i], 1e-5);
}

TEST(OccupancySolver, CellThatExplainsTheMaskIsOccupied) {
  CameraView view{{60, 40}, {60, 40}, {}};
  for (int x = 0; x + 10 <= 60; x += 5) view.rectangles.push_back(cv::Rect(x, 10, 10, 20));
  cv::Mat mask(40, 60, CV_8UC1, cv::Scalar(0));
  mask(view.rectangles[4]) = 255;
  const OccupancySolver solver = *OccupancySolver::Create({view}, {});
  std::vector<float> q(solver.cell_count());
  const std::vector<cv::Mat> masks = {mask};
  const SolveReport report = *solver.Solve(masks, q);
  EXPECT_TRUE(report.converged);
  EXPECT_LT(report.last_change, 1e-4);
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (i == 4) {
      EXPECT_GT(q[i], 0.99);
    } else {
      EXPECT_LT(q[i], 0.02);
    }
  }
}

TEST(OccupancySolver, EmptySceneRaisesNoCell) {
  RandomProblems problems(11);
  for (int round = 0; round < 20; ++round) {
    Problem problem = problems.Next();
    for (cv::Mat& mask : problem.masks) mask.setTo(0);
    for (const float q : Solve(problem)) EXPECT_LE(q, problem.options.prior + 1e-6);
  }
}

TEST(OccupancySolver, WithoutAnyMaskTheAnswerIsThePrior) {
  RandomProblems problems(12);
  Problem problem = problems.Next();
  for (cv::Mat& mask : problem.masks) mask = cv::Mat();
  for (const float q : Solve(problem))
    EXPECT_FLOAT_EQ(q, static_cast<float>(problem.options.prior));
}

TEST(OccupancySolver, OrderOfCamerasAndCellsDoesNotMatter) {
  RandomProblems problems(13);
  for (int round = 0; round < 20; ++round) {
    const Problem problem = problems.Next();
    Problem reversed = problem;
    std::reverse(reversed.views.begin(), reversed.views.end());
    std::reverse(reversed.masks.begin(), reversed.masks.end());
    for (CameraView& view : reversed.views) {
      std::reverse(view.rectangles.begin(), view.rectangles.end());
    }
    const std::vector<float> q = Solve(problem);
    std::vector<float> other = Solve(reversed);
    std::reverse(other.begin(), other.end());
    for (std::size_t i = 0; i < q.size(); ++i) ASSERT_NEAR(q[i], other[i], 1e-5);
  }
}

TEST(OccupancySolver, CameraThatSeesNoCellChangesNothing) {
  RandomProblems problems(14);
  Problem problem = problems.Next();
  const std::vector<float> q = Solve(problem);
  CameraView blind{{8, 8}, {8, 8}, std::vector<cv::Rect>(q.size())};
  problem.views.push_back(blind);
  problem.masks.push_back(cv::Mat(8, 8, CV_8UC1, cv::Scalar(255)));
  EXPECT_EQ(Solve(problem), q);
}

TEST(OccupancySolver, FramesInParallelGiveTheSameBits) {
  RandomProblems problems(15);
  const Problem problem = problems.Next();
  const OccupancySolver solver = *OccupancySolver::Create(problem.views, problem.options);
  const std::vector<float> expected = Solve(problem);
  std::vector<std::vector<float>> q(64, std::vector<float>(solver.cell_count()));
  ParallelFor(4, 64, [&](std::int64_t i) {
    EXPECT_TRUE(solver.Solve(problem.masks, q[static_cast<std::size_t>(i)]));
  });
  EXPECT_THAT(q, ::testing::Each(expected));
}

TEST(OccupancySolver, ExtremeOptionsStayFinite) {
  RandomProblems problems(16);
  for (int round = 0; round < 50; ++round) {
    Problem problem = problems.Next();
    problem.options.variance = 1e-7;
    problem.options.smoothing = 0;
    problem.options.ignored = 0.9;
    problem.options.noise = 1e-6;
    for (const float q : Solve(problem)) {
      EXPECT_GE(q, 0);
      EXPECT_LE(q, 1);
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
  OccupancyOptions certain;
  certain.prior = 1;
  EXPECT_THAT(MessageOf(OccupancySolver::Create({view}, certain)),
              HasSubstr("occupancy.prior is 1"));
}

TEST(OccupancySolver, RefusesMasksThatDoNotFit) {
  const CameraView view{{8, 6}, {8, 6}, {cv::Rect(0, 0, 8, 6)}};
  const OccupancySolver solver = *OccupancySolver::Create({view}, {});
  std::vector<float> q(1), wrong(2);
  const std::vector<cv::Mat> good = {cv::Mat::zeros(6, 8, CV_8UC1)};
  const std::vector<cv::Mat> size = {cv::Mat::zeros(8, 6, CV_8UC1)};
  const std::vector<cv::Mat> type = {cv::Mat::zeros(6, 8, CV_8UC3)};
  EXPECT_TRUE(solver.Solve(good, q));
  EXPECT_THAT(MessageOf(solver.Solve(size, q)), HasSubstr("mask of camera 0 is 6 x 8 px"));
  EXPECT_THAT(MessageOf(solver.Solve(type, q)), HasSubstr("3 channels"));
  EXPECT_THAT(MessageOf(solver.Solve({}, q)), HasSubstr("0 masks are given for 1 cameras"));
  EXPECT_THAT(MessageOf(solver.Solve(good, wrong)), HasSubstr("room for 2 cells"));
}

}  // namespace
}  // namespace vantage
