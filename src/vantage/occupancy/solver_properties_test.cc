// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "vantage/occupancy/solver.h"
#include "vantage/occupancy/test_problems.h"

namespace vantage {
namespace {

using testing::Hall;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::OccupancyProblem;
using testing::Raised;
using testing::RandomNumbers;
using testing::RandomProblem;
using testing::Solve;

/// Each property for both evidences in both modes.
class SolverProperties : public ::testing::TestWithParam<std::tuple<Evidence, SolveMode>> {
 protected:
  OccupancyOptions Options() const {
    OccupancyOptions options;
    std::tie(options.evidence, options.mode) = GetParam();
    options.max_iterations = 1000;
    return options;
  }
  bool exact() const { return std::get<1>(GetParam()) == SolveMode::kExact; }

  OccupancyProblem AnyProblem() {
    OccupancyProblem problem = RandomProblem(random_);
    std::tie(problem.options.evidence, problem.options.mode) = GetParam();
    return problem;
  }

  /// Some people, and some noise in the masks.
  OccupancyProblem Scene(const Hall& hall, int people, double noise = 0.01) {
    OccupancyProblem problem{hall.Views(), hall.Silhouettes(hall.People(random_, people, 1)),
                             Options()};
    for (cv::Mat& mask : problem.masks) testing::AddBlobs(random_, noise, 4, mask);
    return problem;
  }

  RandomNumbers random_{31};
};

void ExpectNear(const std::vector<float>& q, const std::vector<float>& expected, double limit) {
  ASSERT_EQ(q.size(), expected.size());
  for (std::size_t i = 0; i < q.size(); ++i) ASSERT_NEAR(q[i], expected[i], limit) << i;
}

TEST_P(SolverProperties, OrderOfCamerasDoesNotMatter) {
  const Hall hall(5, {100, 80}, 0.5);
  for (int round = 0; round < 10; ++round) {
    const OccupancyProblem problem = Scene(hall, 6);
    OccupancyProblem other = problem;
    std::rotate(other.views.begin(), other.views.begin() + 2, other.views.end());
    std::rotate(other.masks.begin(), other.masks.begin() + 2, other.masks.end());
    const std::vector<float> q = Solve(problem);
    EXPECT_THAT(Raised(q), Not(IsEmpty()));
    ExpectNear(Solve(other), q, 1e-3);
  }
}

TEST_P(SolverProperties, OrderOfCellsDoesNotMatter) {
  const Hall hall(4, {100, 80}, 0.5);
  for (int round = 0; round < 10; ++round) {
    const OccupancyProblem problem = Scene(hall, 6);
    OccupancyProblem other = problem;
    std::vector<std::size_t> order(problem.views[0].rectangles.size());
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t i = order.size(); i-- > 1;) {
      std::swap(order[i], order[static_cast<std::size_t>(random_.Int(0, static_cast<int>(i)))]);
    }
    for (std::size_t c = 0; c < other.views.size(); ++c) {
      for (std::size_t i = 0; i < order.size(); ++i) {
        other.views[c].rectangles[i] = problem.views[c].rectangles[order[i]];
      }
    }
    const std::vector<float> q = Solve(problem);
    std::vector<float> expected;
    for (const std::size_t i : order) expected.push_back(q[i]);
    ExpectNear(Solve(other), expected, 1e-3);
  }
}

TEST_P(SolverProperties, CameraThatSeesNoCellChangesNothing) {
  for (int round = 0; round < 30; ++round) {
    OccupancyProblem problem = AnyProblem();
    const std::vector<float> q = Solve(problem);
    problem.views.push_back({{8, 8}, {8, 8}, std::vector<cv::Rect>(q.size())});
    problem.masks.push_back(cv::Mat(8, 8, CV_8UC1, cv::Scalar(255)));
    EXPECT_EQ(Solve(problem), q);
  }
}

TEST_P(SolverProperties, MissingPictureIsAsAMissingCamera) {
  const Hall hall(4, {100, 80}, 0.5);
  for (int round = 0; round < 5; ++round) {
    OccupancyProblem problem = Scene(hall, 5);
    OccupancyProblem without = problem;
    without.views.erase(without.views.begin() + 1);
    without.masks.erase(without.masks.begin() + 1);
    problem.masks[1] = cv::Mat();
    SolveReport report;
    const std::vector<float> q = Solve(problem, &report);
    EXPECT_EQ(report.cameras_left_out, 1);
    EXPECT_EQ(Solve(without, &report), q);
    EXPECT_EQ(report.cameras_left_out, 0);
  }
}

TEST_P(SolverProperties, WithoutAnyPictureTheAnswerIsThePrior) {
  OccupancyProblem problem = Scene(Hall(3, {60, 40}, 0.5), 3);
  for (cv::Mat& mask : problem.masks) mask = cv::Mat();
  SolveReport report;
  EXPECT_THAT(Solve(problem, &report),
              ::testing::Each(::testing::FloatEq(static_cast<float>(OccupancyOptions().prior))));
  EXPECT_EQ(report.cameras_left_out, 3);
  for (std::size_t i = 0; i < problem.views[0].rectangles.size(); ++i) {
    problem.priors.push_back(random_.Real(0.001, 0.5));
  }
  const std::vector<float> q = Solve(problem);
  for (std::size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(q[i], problem.priors[i], 1e-6);
}

TEST_P(SolverProperties, EmptySceneRaisesNoCellAboveThePrior) {
  for (int round = 0; round < 50; ++round) {
    OccupancyProblem problem = AnyProblem();
    problem.previous.clear();
    for (cv::Mat& mask : problem.masks) mask.setTo(0);
    const std::vector<float> q = Solve(problem);
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double prior = problem.priors.empty() ? problem.options.prior : problem.priors[i];
      ASSERT_LE(q[i], prior + 1e-6);
    }
  }
}

TEST_P(SolverProperties, TwiceTheResolutionGivesTheSameDetections) {
  const Hall hall(4, {100, 80}, 0.5);
  for (int round = 0; round < 10; ++round) {
    const OccupancyProblem problem = Scene(hall, 6);
    OccupancyProblem twice = problem;
    for (CameraView& view : twice.views) {
      view.mask_size = view.size = {200, 160};
      for (cv::Rect& r : view.rectangles) r = {2 * r.tl(), 2 * r.br()};
    }
    for (cv::Mat& mask : twice.masks) cv::resize(mask, mask, {200, 160}, 0, 0, cv::INTER_NEAREST);
    const std::vector<float> q = Solve(problem);
    ExpectNear(Solve(twice), q, 1e-3);
    // And so does the same scene seen by cameras of twice the resolution, whose masks are reduced.
    for (std::size_t c = 0; c < twice.views.size(); ++c) {
      twice.views[c].size = problem.views[c].size;
      twice.views[c].rectangles = problem.views[c].rectangles;
    }
    ExpectNear(Solve(twice), q, 1e-3);
  }
}

TEST_P(SolverProperties, CamerasOfTwiceTheResolutionFindTheSamePeople) {
  const Hall hall(4, {160, 120}, 0.5), sharp(4, {320, 240}, 0.5);
  for (int round = 0; round < 5; ++round) {
    std::vector<Eigen::Vector2d> people_m;
    for (const Eigen::Vector2d& person_m : hall.People(random_, 5, 1.5)) {
      people_m.push_back(hall.grid.Center(*hall.grid.CellAt(person_m)));
    }
    const std::vector<float> q = Solve({hall.Views(), hall.Silhouettes(people_m), Options()});
    const std::vector<float> other = Solve({sharp.Views(), sharp.Silhouettes(people_m), Options()});
    std::vector<std::size_t> expected;
    for (const Eigen::Vector2d& person_m : people_m) {
      expected.push_back(static_cast<std::size_t>(*hall.grid.CellAt(person_m)));
    }
    EXPECT_THAT(Raised(q), ::testing::UnorderedElementsAreArray(expected));
    EXPECT_EQ(Raised(q), Raised(other));
  }
}

TEST_P(SolverProperties, OneSilhouetteRaisesItsCellTheMostAlongTheLineOfSight) {
  const Hall hall(1, {160, 120}, 0.5);
  const Eigen::Vector2d camera_m = hall.cameras[0].center_m().head<2>();
  for (int round = 0; round < 20; ++round) {
    const Eigen::Vector2d person_m = hall.People(random_, 1, 1)[0];
    const CellIndex cell = *hall.grid.CellAt(person_m);
    const Eigen::Vector2d center_m = hall.grid.Center(cell);
    const std::vector<float> q = Solve({hall.Views(), hall.Silhouettes({center_m}), Options()});
    const Eigen::Vector2d sight = (center_m - camera_m).normalized();
    int on_line = 0;
    for (CellIndex other = 0; other < hall.grid.count(); ++other) {
      const Eigen::Vector2d to = hall.grid.Center(other) - camera_m;
      const double across_m = std::abs(to.x() * sight.y() - to.y() * sight.x());
      if (other == cell || across_m > 0.4) continue;
      ++on_line;
      EXPECT_LT(q[static_cast<std::size_t>(other)], q[static_cast<std::size_t>(cell)]);
    }
    EXPECT_GT(on_line, 2);
    EXPECT_GT(q[static_cast<std::size_t>(cell)], 0.5F);
  }
}

TEST_P(SolverProperties, MirroredSceneMirroredMap) {
  const Hall hall(4, {101, 80}, 0.5);
  for (int round = 0; round < 10; ++round) {
    OccupancyProblem problem = Scene(hall, 6);
    if (round % 2 == 0) {
      problem.views[0].informative = cv::Mat(80, 101, CV_8UC1, cv::Scalar(255));
      problem.views[0].informative(cv::Rect(20, 0, 9, 80)) = 0;
    }
    OccupancyProblem mirrored = problem;
    // The hall's mirror image about its middle line: columns from right to left, pictures too.
    const auto mirrored_cell = [&](std::size_t i) {
      const auto cell = static_cast<CellIndex>(i);
      return static_cast<std::size_t>(
          hall.grid.Index(hall.grid.columns - 1 - hall.grid.Column(cell), hall.grid.Row(cell)));
    };
    for (std::size_t c = 0; c < problem.views.size(); ++c) {
      mirrored.masks[c] = cv::Mat();  // a picture of its own
      cv::flip(problem.masks[c], mirrored.masks[c], 1);
      if (!problem.views[c].informative.empty()) {
        mirrored.views[c].informative = cv::Mat();
        cv::flip(problem.views[c].informative, mirrored.views[c].informative, 1);
      }
      for (std::size_t i = 0; i < problem.views[c].rectangles.size(); ++i) {
        cv::Rect r = problem.views[c].rectangles[i];
        if (!r.empty()) r.x = 101 - r.x - r.width;
        mirrored.views[c].rectangles[mirrored_cell(i)] = r;
      }
    }
    const std::vector<float> q = Solve(problem), other = Solve(mirrored);
    EXPECT_THAT(Raised(q), Not(IsEmpty()));
    for (std::size_t i = 0; i < q.size(); ++i) ASSERT_NEAR(other[mirrored_cell(i)], q[i], 1e-3);
  }
}

TEST_P(SolverProperties, CamerasMayHavePicturesOfDifferentSizes) {
  const Hall hall(4, {160, 120}, 0.5), small(4, {96, 72}, 0.5);
  const std::vector<Eigen::Vector2d> people_m = {hall.grid.Center(hall.grid.Index(4, 3)),
                                                 hall.grid.Center(hall.grid.Index(10, 8))};
  OccupancyProblem problem{hall.Views(), hall.Silhouettes(people_m), Options()};
  const std::vector<CameraView> views = small.Views();
  const std::vector<cv::Mat> masks = small.Silhouettes(people_m);
  for (const std::size_t c : {1U, 3U}) {
    problem.views[c] = views[c];
    problem.masks[c] = masks[c];
  }
  const auto cell = [&](int column, int row) {
    return static_cast<std::size_t>(hall.grid.Index(column, row));
  };
  EXPECT_THAT(Raised(Solve(problem)), ::testing::ElementsAre(cell(4, 3), cell(10, 8)));
}

TEST_P(SolverProperties, WhatTheMaskSaysInABlindPixelChangesNothing) {
  int blind_cameras = 0;
  for (int round = 0; round < 60; ++round) {
    OccupancyProblem problem = AnyProblem();
    const std::vector<float> q = Solve(problem);
    for (std::size_t c = 0; c < problem.views.size(); ++c) {
      const CameraView& view = problem.views[c];
      if (view.informative.empty() || problem.masks[c].empty()) continue;
      problem.masks[c].setTo(random_.Int(0, 255), view.informative == 0);
      ++blind_cameras;
    }
    EXPECT_EQ(Solve(problem), q);
  }
  EXPECT_GT(blind_cameras, 10);
}

TEST_P(SolverProperties, CellsOfWhichNobodySeesAPixelKeepTheirPrior) {
  const Hall hall(2, {100, 80}, 0.5);
  OccupancyProblem problem = Scene(hall, 5);
  problem.priors.assign(static_cast<std::size_t>(hall.grid.count()), 0.02);
  const std::size_t cell = Raised(Solve(problem)).front();
  for (CameraView& view : problem.views) {
    view.informative = cv::Mat(80, 100, CV_8UC1, cv::Scalar(255));
    if (!view.rectangles[cell].empty()) view.informative(view.rectangles[cell]) = 0;
  }
  EXPECT_NEAR(Solve(problem)[cell], 0.02, 1e-6);
  for (CameraView& view : problem.views) view.informative = 0;  // all blind
  EXPECT_THAT(Solve(problem), ::testing::Each(::testing::FloatNear(0.02F, 1e-6F)));
}

std::string NameOf(const ::testing::TestParamInfo<std::tuple<Evidence, SolveMode>>& info) {
  const auto [evidence, mode] = info.param;
  return std::string(evidence == Evidence::kPerson ? "Person" : "Picture") +
         (mode == SolveMode::kFast ? "Fast" : "Exact");
}

INSTANTIATE_TEST_SUITE_P(All, SolverProperties,
                         ::testing::Combine(::testing::Values(Evidence::kPerson,
                                                              Evidence::kPicture),
                                            ::testing::Values(SolveMode::kFast, SolveMode::kExact)),
                         NameOf);

}  // namespace
}  // namespace vantage
