// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/peaks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vantage/base/test_support.h"
#include "vantage/occupancy/solver.h"
#include "vantage/occupancy/test_problems.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;

constexpr GroundGrid kGrid{-1, 2, 0.5, 8, 6};

std::vector<float> Map(std::initializer_list<std::pair<CellIndex, float>> cells) {
  std::vector<float> q(static_cast<std::size_t>(kGrid.count()), 0.0F);
  for (const auto& [cell, value] : cells) q[static_cast<std::size_t>(cell)] = value;
  return q;
}

TEST(FindPeaks, CentreOfALonelyCell) {
  const auto peaks = FindPeaks(kGrid, Map({{kGrid.Index(3, 2), 0.8F}}), {});
  ASSERT_EQ(MessageOf(peaks), "");
  ASSERT_EQ(peaks->size(), 1U);
  EXPECT_EQ((*peaks)[0].cell, kGrid.Index(3, 2));
  EXPECT_EQ((*peaks)[0].probability, 0.8F);
  EXPECT_TRUE((*peaks)[0].position_m.isApprox(Eigen::Vector2d(0.75, 3.25)));
}

TEST(FindPeaks, StrongestFirstAndAtLeastTheDistanceApart) {
  const std::vector<float> q = Map({{kGrid.Index(1, 1), 0.9F},
                                    {kGrid.Index(3, 1), 0.95F},
                                    {kGrid.Index(6, 4), 0.6F},
                                    {kGrid.Index(0, 5), 0.49F}});
  const auto cells = [&](double distance_m) {
    std::vector<CellIndex> result;
    const std::vector<Peak> peaks = *FindPeaks(kGrid, q, {.distance_m = distance_m});
    for (const Peak& peak : peaks) result.push_back(peak.cell);
    return result;
  };
  using ::testing::ElementsAre;
  EXPECT_THAT(cells(1.0), ElementsAre(kGrid.Index(3, 1), kGrid.Index(1, 1), kGrid.Index(6, 4)));
  EXPECT_THAT(cells(1.01), ElementsAre(kGrid.Index(3, 1), kGrid.Index(6, 4)));
  EXPECT_THAT(cells(100), ElementsAre(kGrid.Index(3, 1)));
}

TEST(FindPeaks, SlopeIsNoPeakAndRefinementLeansToTheStrongerSide) {
  const std::vector<float> q = Map({{kGrid.Index(3, 2), 1.0F}, {kGrid.Index(4, 2), 0.6F}});
  const auto refined = *FindPeaks(kGrid, q, {.distance_m = 0});
  ASSERT_EQ(refined.size(), 1U);
  EXPECT_NEAR(refined[0].position_m.x(), 0.75 + 0.5 * 0.6 / 1.6, 1e-6);
  EXPECT_NEAR(refined[0].position_m.y(), 3.25, 1e-6);
  const auto plain = *FindPeaks(kGrid, q, {.distance_m = 0, .refine = false});
  EXPECT_TRUE(plain[0].position_m.isApprox(Eigen::Vector2d(0.75, 3.25)));
}

TEST(FindPeaks, PropertiesOnRandomMaps) {
  std::mt19937 random(4);
  for (int round = 0; round < 100; ++round) {
    std::vector<float> q(static_cast<std::size_t>(kGrid.count()));
    for (float& value : q) value = std::uniform_real_distribution<float>(0, 1)(random);
    const PeakOptions options{.threshold = 0.6, .distance_m = 0.3 * (round % 6), .refine = false};
    const std::vector<Peak> peaks = *FindPeaks(kGrid, q, options);
    for (std::size_t i = 0; i < peaks.size(); ++i) {
      EXPECT_GE(peaks[i].probability, 0.6F);
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GE(peaks[j].probability, peaks[i].probability);
        EXPECT_GE((peaks[i].position_m - peaks[j].position_m).norm(), options.distance_m - 1e-9);
      }
    }
    // The strongest cell is always found.
    EXPECT_EQ(peaks.front().probability, *std::max_element(q.begin(), q.end()));
  }
}

/// Errors of the positions of people anywhere in a hall that four cameras see.
struct PositionErrors {
  int people = 0, found = 0, detections = 0;
  double mean_m = 0;
};

PositionErrors MeasurePositions(const OccupancyOptions& options, double cell_m, bool refine) {
  const testing::Hall hall(4, {320, 240}, cell_m);
  testing::RandomNumbers random(77);
  const OccupancySolver solver = *OccupancySolver::Create(hall.Views(), options);
  std::vector<float> q(solver.cell_count());
  PositionErrors errors;
  for (int round = 0; round < 80; ++round) {
    const std::vector<Eigen::Vector2d> people_m = hall.People(random, 3, 1.2);
    EXPECT_TRUE(solver.Solve(hall.Silhouettes(people_m), q));
    const std::vector<Peak> peaks = *FindPeaks(hall.grid, q, {.refine = refine});
    errors.detections += static_cast<int>(peaks.size());
    for (const Eigen::Vector2d& person_m : people_m) {
      ++errors.people;
      double nearest_m = 1e9;
      for (const Peak& peak : peaks) {
        nearest_m = std::min(nearest_m, (peak.position_m - person_m).norm());
      }
      if (nearest_m > 0.6) continue;
      ++errors.found;
      errors.mean_m += nearest_m;
    }
  }
  errors.mean_m /= errors.found;
  return errors;
}

TEST(FindPeaks, PositionsOfPeopleAreMuchFinerThanTheCells) {
  for (const Evidence evidence : {Evidence::kPerson, Evidence::kPicture}) {
    for (const double cell_m : {0.5, 0.25}) {
      const OccupancyOptions options{.evidence = evidence};
      const PositionErrors refined = MeasurePositions(options, cell_m, true);
      const PositionErrors centres = MeasurePositions(options, cell_m, false);
      EXPECT_GT(refined.people, 230);
      EXPECT_GE(refined.found, 0.99 * refined.people);
      EXPECT_NEAR(refined.detections, refined.people, 0.02 * refined.people) << "one for each";
      const bool person = evidence == Evidence::kPerson;
      EXPECT_LT(refined.mean_m, (person ? 0.25 : 0.36) * cell_m);
      EXPECT_LT(refined.mean_m, (person ? 0.65 : 0.9) * centres.mean_m);
    }
  }
}

TEST(FindPeaks, PersonBetweenTwoCellsIsOneDetection) {
  const std::vector<float> q = Map({{kGrid.Index(3, 2), 1.0F}, {kGrid.Index(4, 2), 1.0F}});
  const auto peaks = *FindPeaks(kGrid, q, {});
  ASSERT_EQ(peaks.size(), 1U);
  EXPECT_TRUE(peaks[0].position_m.isApprox(Eigen::Vector2d(1.0, 3.25)));
  // Two people beyond the distance are two, whatever is between them.
  const std::vector<float> three =
      Map({{kGrid.Index(2, 2), 1.0F}, {kGrid.Index(3, 2), 1.0F}, {kGrid.Index(4, 2), 1.0F}});
  EXPECT_EQ(FindPeaks(kGrid, three, {})->size(), 2U);
}

TEST(FindPeaks, RefusesWhatDoesNotFit) {
  const std::vector<float> q(3);
  EXPECT_THAT(MessageOf(FindPeaks(kGrid, q, {})), HasSubstr("3 cells; the grid has 48"));
  EXPECT_THAT(MessageOf(FindPeaks(kGrid, Map({}), {.threshold = 0})),
              HasSubstr("peaks.threshold is 0"));
}

}  // namespace
}  // namespace vantage
