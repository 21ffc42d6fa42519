// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/walkers.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "vantage/simulation/dice.h"
#include "vantage/simulation/pedestrians.h"

namespace vantage::simulation {
namespace {

using Eigen::Vector2d;

TEST(WayTest, PassesWaypointsAndNeverOvershoots) {
  Dice dice(7);
  std::vector<Waypoint> waypoints;
  double secs = -3;
  for (int i = 0; i < 40; ++i) {
    secs += dice.Uniform(0.1, 3);
    const double x = dice.Uniform(-5, 5);
    waypoints.push_back({secs, {x, dice.Uniform(-5, 5)}});
  }
  const Way way(waypoints);
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
    const Waypoint& a = waypoints[i];
    const Waypoint& b = waypoints[i + 1];
    EXPECT_LT((way.At(a.seconds) - a.ground_m).norm(), 1e-12);
    for (int k = 1; k < 10; ++k) {
      const Vector2d place = way.At(a.seconds + 0.1 * k * (b.seconds - a.seconds));
      for (int axis = 0; axis < 2; ++axis) {
        EXPECT_GE(place[axis], std::min(a.ground_m[axis], b.ground_m[axis]) - 1e-12);
        EXPECT_LE(place[axis], std::max(a.ground_m[axis], b.ground_m[axis]) + 1e-12);
      }
    }
  }
  EXPECT_EQ(way.At(-100), waypoints.front().ground_m);
  EXPECT_EQ(way.At(1e6), waypoints.back().ground_m);
}

TEST(WayTest, IsSmoothAtWaypoints) {
  const Way way({{0, {0, 0}}, {1, {1, 0}}, {3, {2, 3}}, {4, {5, 4}}});
  for (const double at : {1.0, 3.0}) {
    const Vector2d before = (way.At(at) - way.At(at - 1e-5)) / 1e-5;
    const Vector2d after = (way.At(at + 1e-5) - way.At(at)) / 1e-5;
    EXPECT_LT((before - after).norm(), 1e-3);
  }
}

TEST(WayTest, RestsBetweenEqualWaypoints) {
  const Way way({{0, {0, 0}}, {4, {5, 1}}, {9, {5, 1}}, {12, {9, 9}}});
  for (double secs = 4; secs <= 9; secs += 0.25) EXPECT_EQ(way.At(secs), Vector2d(5, 1));
}

const std::vector<Gate> kGates = {{{-30, 0}, {-20, 0}}, {{30, 0}, {20, 0}}};

TEST(ThroughGatesTest, ComesFromBehindAndLeavesAhead) {
  const std::vector<Waypoint> known = {{10, {-1, 0}}, {11, {0.3, 0}}, {12, {1.6, 0}}};
  const std::vector<Waypoint> way = ThroughGates(known, kGates, 2);
  EXPECT_EQ(way.front().ground_m, Vector2d(-30, 0));
  EXPECT_EQ(way.back().ground_m, Vector2d(30, 0));
  ASSERT_EQ(way.size(), 7U);
  for (std::size_t i = 0; i < known.size(); ++i) {
    EXPECT_EQ(way[i + 2].seconds, known[i].seconds);
    EXPECT_EQ(way[i + 2].ground_m, known[i].ground_m);
  }
  for (std::size_t i = 1; i < way.size(); ++i) {
    const double secs = way[i].seconds - way[i - 1].seconds;
    EXPECT_NEAR((way[i].ground_m - way[i - 1].ground_m).norm() / secs, 1.3, 1e-9);
  }
}

TEST(ThroughGatesTest, LongAbsenceIsSpentInAGate) {
  const std::vector<Waypoint> known = {{0, {8, 0}}, {1, {9.3, 0}}, {100, {9, 1}}, {101, {8, 1}}};
  const Way way(ThroughGates(known, kGates, 2));
  EXPECT_LT((way.At(50) - Vector2d(30, 0)).norm(), 1e-9);
  EXPECT_EQ(way.At(1), known[1].ground_m);
  EXPECT_EQ(way.At(100), known[2].ground_m);
}

TEST(ThroughGatesTest, ShorterAbsenceLeadsAsFarAsTimeAllows) {
  const std::vector<Waypoint> known = {{0, {8, 0}}, {1, {9.3, 0}}, {9, {9.3, 0.5}}, {10, {8, 0.5}}};
  const Way way(ThroughGates(known, kGates, 2));
  double farthest = 0;
  for (double secs = 1; secs < 9; secs += 0.1) {
    farthest = std::max(farthest, way.At(secs).x());
    EXPECT_LE((way.At(secs + 0.1) - way.At(secs)).norm(), 0.1 * 1.3 * 2);
  }
  EXPECT_GT(farthest, 9.3 + 4);
  EXPECT_LT(farthest, 9.3 + 5.2 + 1e-9);
}

TEST(PosturesTest, LooksAheadAndKeepsStep) {
  Walk walk;
  for (int i = 0; i < 50; ++i) walk.ground_m.emplace_back(0, 0.065 * i);
  const std::vector<Posture> postures = Postures(walk, 20, 1.75);
  ASSERT_EQ(postures.size(), 50U);
  for (std::size_t i = 1; i < 50; ++i) {
    EXPECT_EQ(postures[i].ground_m, walk.ground_m[i]);
    EXPECT_NEAR(postures[i].heading_rad, std::numbers::pi / 2, 1e-9);
    EXPECT_NEAR(postures[i].speed_m_s, 1.3, 1e-9);
    EXPECT_DOUBLE_EQ(postures[i].gait,
                     AdvanceGait(postures[i - 1].gait, postures[i].speed_m_s, 1.75, 0.05));
  }
}

TEST(PosturesTest, WhoStandsLooksWhereTold) {
  Walk walk;
  for (int i = 0; i < 40; ++i) {
    walk.ground_m.emplace_back(2, 3);
    walk.look_at_m.emplace_back(Vector2d(-5, 3));
  }
  for (const Posture& posture : Postures(walk, 20, 1.75)) {
    EXPECT_NEAR(std::abs(posture.heading_rad), std::numbers::pi, 1e-9);
    EXPECT_EQ(posture.speed_m_s, 0);
  }
}

TEST(StrollTest, MakesWayForOthersAndPillars) {
  const std::vector<Pedestrian> people = {{0, 1.3, {{{-8, 0}}, {{8, 0}}}},
                                          {0, 1.3, {{{8, 0}}, {{-8, 0}}}},
                                          {0, 1.2, {{{0.1, -8}}, {{0, 8}}}}};
  const std::vector<Pillar> pillars = {{{4, 0.1}, 0.2}};
  const std::vector<Walk> walks = Stroll(people, pillars, 10, 200);
  ASSERT_EQ(walks.size(), 3U);
  for (std::size_t i = 0; i < walks.size(); ++i) {
    // They arrive, if a little later.
    EXPECT_LT(walks[i].ground_m.size(), 170U);
    EXPECT_LT((walks[i].ground_m.back() - people[i].stops[1].ground_m).norm(), 1.2);
    for (std::size_t frame = 0; frame < walks[i].ground_m.size(); ++frame) {
      EXPECT_GT((walks[i].ground_m[frame] - pillars[0].center_m).norm(), 0.3);
      for (std::size_t k = i + 1; k < walks.size(); ++k) {
        if (frame >= walks[k].ground_m.size()) continue;
        EXPECT_GT((walks[i].ground_m[frame] - walks[k].ground_m[frame]).norm(), 0.4);
      }
    }
  }
}

TEST(StrollTest, StaysWhereToldAndBeginsBeforeTheFilm) {
  const std::vector<Walk> walks =
      Stroll({{-10, 1, {{{0, 0}}, {{5, 0}, 30, {{9, 9}}}, {{20, 0}}}}}, {}, 10, 600);
  EXPECT_EQ(walks[0].first, 0);
  EXPECT_LT((walks[0].ground_m[100] - Vector2d(5, 0)).norm(), 0.05);
  EXPECT_EQ(walks[0].look_at_m[100], Vector2d(9, 9));
  EXPECT_LT(walks[0].ground_m.size(), 450U);
  EXPECT_FALSE(walks[0].look_at_m.back().has_value());
}

}  // namespace
}  // namespace vantage::simulation
