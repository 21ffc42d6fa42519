// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/fast_solver.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

#include "vantage/background/test_targets.h"
#include "vantage/occupancy/fast_kernel.h"
#include "vantage/occupancy/test_problems.h"

namespace vantage {
namespace {

using testing::Hall;
using testing::OccupancyProblem;
using testing::Raised;
using testing::RandomNumbers;
using testing::Solve;

/// What one run of columns goes into, and what comes out of it.
struct KernelCase {
  using Floats = hwy::AlignedFreeUniquePtr<float[]>;

  KernelCase(RandomNumbers& random, int row_count) : rows(row_count) {
    for (Floats* floats : {&difference, &first, &second, &sum_first, &sum_second}) {
      *floats = hwy::AllocateAligned<float>(Size());
      std::fill_n(floats->get(), Size(), 0.0F);
    }
    for (std::size_t i = 0; i < Size() - internal::kColumns; ++i) {
      first[i] = static_cast<float>(random.Real(-0.4, 1));
      second[i] = static_cast<float>(random.Real(0, 1));
    }
    // Rectangles begin and end, with absences down to the fast mode's smallest.
    for (int k = 0; k < 3 * row_count; ++k) {
      const auto x = static_cast<std::size_t>(random.Int(0, internal::kColumns - 1));
      const int top = random.Int(0, row_count - 1), bottom = random.Int(top + 1, row_count);
      const auto log_n = static_cast<float>(std::log(std::pow(10, random.Real(-4, 0))) / 3);
      difference[At(top) + x] += log_n;
      difference[At(bottom) + x] -= log_n;
    }
    // One column in which rounding has left a product above 1.
    for (int row = 0; row <= row_count; ++row) difference[At(row) + 5] = row == 0 ? 0.01F : 0;
  }

  static std::size_t At(int row) { return static_cast<std::size_t>(row * internal::kColumns); }
  std::size_t Size() const { return At(rows + 1); }
  internal::CoverRun Run(bool both) {
    return {rows,
            difference.get(),
            first.get(),
            both ? second.get() : nullptr,
            sum_first.get(),
            both ? sum_second.get() : nullptr};
  }

  int rows;
  Floats difference, first, second, sum_first, sum_second;
};

TEST(FastKernel, SumsAsAPlainLoopOnEveryTarget) {
  testing::HighwayTargets targets;
  ASSERT_GE(targets.size(), 2U);
  for (std::size_t target = 0; target < targets.size(); ++target) {
    targets.Choose(target);
    RandomNumbers random(3);
    for (const int rows : {1, 2, 7, 40, 300}) {
      for (const bool both : {false, true}) {
        KernelCase c(random, rows);
        std::vector<double> log_m(c.Size()), sums(c.Size(), 0.0), other_sums(c.Size(), 0.0);
        for (std::size_t i = 0; i + internal::kColumns < c.Size(); ++i) {
          const double above = i < internal::kColumns ? 0 : log_m[i - internal::kColumns];
          log_m[i] = above + static_cast<double>(c.difference[i]);
          const double m = std::min(std::exp(log_m[i]), 1.0);
          const std::size_t below = i + internal::kColumns;
          sums[below] = sums[i] + m * static_cast<double>(c.first[i]);
          other_sums[below] = other_sums[i] + m * static_cast<double>(c.second[i]);
        }
        internal::SumCovered(c.Run(both));
        for (std::size_t i = 0; i < c.Size(); ++i) {
          const double limit = 2e-5 * rows;
          ASSERT_NEAR(static_cast<double>(c.sum_first[i]), sums[i], limit) << "target " << target;
          ASSERT_NEAR(static_cast<double>(c.sum_second[i]), both ? other_sums[i] : 0, limit);
          ASSERT_EQ(c.difference[i], 0) << "is ready for the next iteration";
        }
      }
    }
  }
}

TEST(FastKernel, AddsAndSumsPiecesAsPlainLoopsOnEveryTarget) {
  constexpr int kRows = 30;
  testing::HighwayTargets targets;
  RandomNumbers random(6);
  KernelCase c(random, kRows);
  std::vector<internal::CoverPiece> pieces;
  std::vector<float> values;
  for (std::uint8_t left = 0; left < internal::kColumns; ++left) {
    for (auto right = static_cast<std::uint8_t>(left + 1); right <= internal::kColumns; ++right) {
      const int top = random.Int(0, kRows - 1), bottom = random.Int(top + 1, kRows);
      pieces.push_back({static_cast<std::uint32_t>(KernelCase::At(top)),
                        static_cast<std::uint32_t>(KernelCase::At(bottom)), left, right});
      values.push_back(random.Chance(0.2) ? 0 : static_cast<float>(random.Real(-5, 0)));
    }
  }
  std::vector<double> difference(c.Size(), 0.0), gains;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    double gain = 0;
    for (std::size_t x = pieces[i].left; x < pieces[i].right; ++x) {
      difference[pieces[i].top + x] += static_cast<double>(values[i]);
      difference[pieces[i].bottom + x] -= static_cast<double>(values[i]);
      gain += static_cast<double>(c.first[pieces[i].bottom + x] - c.first[pieces[i].top + x]);
    }
    gains.push_back(gain);
  }
  for (std::size_t target = 0; target < targets.size(); ++target) {
    targets.Choose(target);
    std::fill_n(c.difference.get(), c.Size(), 0.0F);
    internal::AddPieces(pieces, values.data(), c.difference.get());
    for (std::size_t i = 0; i < c.Size(); ++i) ASSERT_NEAR(c.difference[i], difference[i], 1e-4);
    std::vector<float> sums(pieces.size());
    internal::SumPieces(pieces, c.first.get(), sums.data());
    for (std::size_t i = 0; i < sums.size(); ++i) ASSERT_NEAR(sums[i], gains[i], 1e-5);
  }
}

TEST(FastKernel, TargetsAgreeToRounding) {
  testing::HighwayTargets targets;
  RandomNumbers random(4);
  const Hall hall(4, {160, 120}, 0.25);
  OccupancyProblem problem{hall.Views(), hall.Silhouettes(hall.People(random, 5, 0.8)), {}};
  targets.ChooseBest();
  const std::vector<float> best = Solve(problem);
  for (std::size_t target = 0; target < targets.size(); ++target) {
    targets.Choose(target);
    const std::vector<float> q = Solve(problem);
    for (std::size_t i = 0; i < q.size(); ++i) ASSERT_NEAR(q[i], best[i], 1e-3);
    EXPECT_EQ(Raised(q), Raised(best));
  }
}

/// How the maps of the two modes differ over many problems.
struct Comparison {
  int problems = 0, cells = 0, raised = 0;
  int raised_in_one = 0;  // above one half in one of the two modes only
  int lost = 0;           // by how many the two modes' numbers of cells above one half differ
  int far = 0;            // differ by more than 0.05
};

/// People anywhere in a hall that 1 to 6 cameras see, silhouettes with some noise; some
/// reduced, blind in a part, missing, continuous or with priors.
OccupancyProblem PlausibleProblem(RandomNumbers& random, double most_noise) {
  const ImageSize size{random.Int(60, 160), random.Int(50, 120)};
  Hall hall(random.Int(1, 6), size, random.Chance(0.5) ? 0.25 : 0.5);
  const std::vector<cv::Mat> masks = hall.Silhouettes(hall.People(random, random.Int(0, 8), 0.6));
  OccupancyProblem problem;
  problem.views = hall.Views(random.Chance(0.3) ? Visibility::kContinuous : Visibility::kCentre);
  const double noise = random.Chance(0.3) ? 0 : random.Real(0, most_noise);
  for (std::size_t c = 0; c < masks.size(); ++c) {
    problem.masks.push_back(masks[c]);
    testing::AddBlobs(random, noise, random.Int(2, 15), problem.masks[c]);
    if (random.Chance(0.2)) {
      CameraView& view = problem.views[c];
      view.informative = cv::Mat(size.height, size.width, CV_8UC1, cv::Scalar(255));
      view.informative(cv::Rect(random.Int(0, size.width - 11), 0, 10, size.height)) = 0;
    }
    if (random.Chance(0.05)) problem.masks[c] = cv::Mat();
  }
  if (random.Chance(0.3)) {
    for (CellIndex i = 0; i < hall.grid.count(); ++i) {
      problem.priors.push_back(random.Real(0.005, 0.05));
    }
  }
  problem.options.max_iterations = 1000;
  return problem;
}

Comparison Compare(Evidence evidence, double most_noise) {
  RandomNumbers random(21);
  Comparison result;
  for (; result.problems < 150; ++result.problems) {
    OccupancyProblem problem = PlausibleProblem(random, most_noise);
    problem.options.evidence = evidence;
    problem.options.mode = SolveMode::kExact;
    const std::vector<float> exact = Solve(problem);
    problem.options.mode = SolveMode::kFast;
    const std::vector<float> fast = Solve(problem);
    for (std::size_t i = 0; i < fast.size(); ++i) {
      EXPECT_GE(fast[i], 0);
      EXPECT_LE(fast[i], 1);
      ++result.cells;
      result.raised += exact[i] > 0.5F;
      result.raised_in_one += (exact[i] > 0.5F) != (fast[i] > 0.5F);
      result.far += !(std::abs(exact[i] - fast[i]) < 0.05F);
    }
    result.lost += static_cast<int>(std::abs(std::ssize(Raised(exact)) - std::ssize(Raised(fast))));
  }
  ::testing::Test::RecordProperty(
      "comparison",
      fmt::format("{} cells, {} raised, {} in one only, {} differ by 0.05, {} lost", result.cells,
                  result.raised, result.raised_in_one, result.far, result.lost));
  return result;
}

// Where the modes differ, a person between two cells is in the one or the other: both are fixed
// points.
TEST(FastSolver, RaisesTheCellsOfTheExactModeByPersons) {
  const Comparison c = Compare(Evidence::kPerson, 0.1);
  EXPECT_GT(c.raised, 4 * c.problems);
  EXPECT_LE(c.raised_in_one, 0.03 * c.raised);
  EXPECT_LE(c.lost, 0.005 * c.raised);
  EXPECT_LE(c.far, 0.001 * c.cells);
}

// This evidence also raises cells that are mostly background, for covering more makes the share of
// what is explained wrongly smaller where there is much noise. The fast mode leaves them out, so
// that the modes are compared on clean silhouettes.
TEST(FastSolver, RaisesTheCellsOfTheExactModeByPictures) {
  const Comparison c = Compare(Evidence::kPicture, 0);
  EXPECT_GT(c.raised, 3 * c.problems);
  EXPECT_LE(c.raised_in_one, 0.1 * c.raised);
  EXPECT_LE(c.lost, 0.02 * c.raised);
  EXPECT_LE(c.far, 0.002 * c.cells);
}

TEST(FastSolver, StaysBetweenZeroAndOneOnAnyProblem) {
  RandomNumbers random(23);
  for (int round = 0; round < 500; ++round) {
    OccupancyProblem problem = testing::RandomProblem(random);
    problem.options.mode = SolveMode::kFast;
    SolveReport report;
    const std::vector<float> q = Solve(problem, &report);
    ASSERT_TRUE(std::isfinite(report.last_change));
    for (const float value : q) {
      ASSERT_GE(value, 0) << "round " << round;
      ASSERT_LE(value, 1) << "round " << round;
    }
  }
}

TEST(FastSolver, LooksAtAllCellsThatForegroundCanRaiseAtASmallBackgroundCost) {
  const CameraView view{{40, 40}, {40, 40}, {cv::Rect(10, 5, 10, 30)}};
  cv::Mat mask(40, 40, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(10, 5, 2, 30)) = 255;  // a fifth of the rectangle
  for (const SolveMode mode : {SolveMode::kFast, SolveMode::kExact}) {
    EXPECT_LT(Solve({{view}, {mask}, {.mode = mode, .background_cost = 0.35}})[0], 0.01F);
    EXPECT_GT(Solve({{view}, {mask}, {.mode = mode, .background_cost = 0.05}})[0], 0.5F);
    EXPECT_GT(Solve({{view}, {mask}, {.mode = mode, .background_cost = 0}})[0], 0.5F);
  }
}

TEST(FastSolver, LooksAtTheInformativePartOfARectangle) {
  // Four fifths of the person are behind a post; what can be seen of her is foreground.
  CameraView view{{40, 40}, {40, 40}, {cv::Rect(10, 5, 10, 30), cv::Rect(12, 5, 8, 30)}};
  view.informative = cv::Mat(40, 40, CV_8UC1, cv::Scalar(255));
  view.informative(cv::Rect(12, 0, 8, 40)) = 0;
  cv::Mat mask(40, 40, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(10, 5, 2, 30)) = 255;
  const std::vector<float> fast = Solve({{view}, {mask}, {}});
  const std::vector<float> exact = Solve({{view}, {mask}, {.mode = SolveMode::kExact}});
  EXPECT_GT(fast[0], 0.9F);
  EXPECT_NEAR(fast[0], exact[0], 1e-3);
  // The other is wholly behind it: nothing is known of that cell.
  const auto prior = static_cast<float>(OccupancyOptions().prior);
  EXPECT_FLOAT_EQ(fast[1], prior);
  EXPECT_FLOAT_EQ(exact[1], prior);
}

}  // namespace
}  // namespace vantage
