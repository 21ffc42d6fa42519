// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/floorball_game.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "vantage/simulation/floorball_hall.h"
#include "vantage/simulation/floorball_walkers.h"

namespace vantage::simulation {
namespace {

using Eigen::Vector2d;
using Role = FloorballGame::Role;

constexpr FrameIndex kFrames = 2400;  // two minutes
constexpr double kRate = FloorballGame::kFramesPerSecond;

const FloorballGame& Game() {
  static const FloorballGame game(7, kFrames);
  return game;
}

Vector2d Place(std::size_t person, FrameIndex frame) {
  return Game().PostureAt(person, frame).ground_m;
}

bool OnField(const Vector2d& place) {
  return std::abs(place.x()) <= kRinkHalfLength_m && std::abs(place.y()) <= kRinkHalfWidth_m;
}

bool IsPlayer(std::size_t person) {
  const Role role = Game().people()[person].role;
  return role == Role::kPlayer || role == Role::kKeeper;
}

int Count(Role role) {
  return static_cast<int>(
      std::count_if(Game().people().begin(), Game().people().end(),
                    [&](const FloorballGame::Person& person) { return person.role == role; }));
}

TEST(FloorballGame, HasTwentyOnePlayersOfWhomTwelveAreInTheRink) {
  EXPECT_EQ(Count(Role::kKeeper) + Count(Role::kPlayer), 21);
  EXPECT_EQ(Count(Role::kKeeper), 2);
  EXPECT_EQ(Count(Role::kReferee), 2);
  int twelve = 0;
  for (FrameIndex frame = 0; frame < kFrames; ++frame) {
    int inside = 0;
    for (std::size_t i = 0; i < Game().people().size(); ++i) {
      if (!OnField(Place(i, frame))) continue;
      ++inside;
      EXPECT_TRUE(IsPlayer(i)) << i << " at " << frame;
    }
    EXPECT_GE(inside, 10);
    EXPECT_LE(inside, 14);
    twelve += inside == 12 ? 1 : 0;
  }
  EXPECT_GE(twelve, 0.95 * kFrames);
}

TEST(FloorballGame, SubstitutesComeInAndSitDownAgain) {
  int entered = 0;
  int sat_down = 0;
  for (std::size_t i = 0; i < Game().people().size(); ++i) {
    if (!IsPlayer(i)) continue;
    const bool inside_first = OnField(Place(i, 0));
    bool came = false;
    bool sat = false;
    for (FrameIndex frame = 0; frame < kFrames; ++frame) {
      came |= !inside_first && OnField(Place(i, frame));
      sat |= inside_first && Game().PostureAt(i, frame).sit == 1;
    }
    entered += came ? 1 : 0;
    sat_down += sat ? 1 : 0;
  }
  EXPECT_GE(entered, 4);
  EXPECT_GE(sat_down, 3);
}

TEST(FloorballGame, NobodyJumpsOrLeavesTheHall) {
  double fastest = 0;
  double hardest = 0;
  for (std::size_t i = 0; i < Game().people().size(); ++i) {
    for (FrameIndex frame = 2; frame < kFrames; ++frame) {
      const Vector2d now = Place(i, frame), before = Place(i, frame - 1);
      ASSERT_LT(std::abs(now.x()), kHallHalfLength_m - 0.3);
      ASSERT_LT(std::abs(now.y()), kHallHalfWidth_m - 0.3);
      fastest = std::max(fastest, (now - before).norm() * kRate);
      hardest = std::max(hardest, (now - 2 * before + Place(i, frame - 2)).norm() * kRate * kRate);
    }
  }
  EXPECT_LT(fastest, 7);
  EXPECT_GT(fastest, 4.5);
  EXPECT_LT(hardest, 7);
}

TEST(FloorballGame, PlayersRunAndKeepersHardlyMove) {
  for (std::size_t i = 0; i < Game().people().size(); ++i) {
    if (Game().people()[i].role != Role::kKeeper) continue;
    double way = 0;
    for (FrameIndex frame = 1; frame < kFrames; ++frame) {
      way += (Place(i, frame) - Place(i, frame - 1)).norm();
      EXPECT_LT((Place(i, frame) - Place(i, 0)).norm(), 2.5);
    }
    EXPECT_LT(way / kFrames * kRate, 0.2);
    EXPECT_GT(way, 1);
  }
  double way = 0;
  double secs = 0;
  for (std::size_t i = 0; i < Game().people().size(); ++i) {
    if (Game().people()[i].role != Role::kPlayer) continue;
    for (FrameIndex frame = 1; frame < kFrames; ++frame) {
      if (!OnField(Place(i, frame))) continue;
      way += (Place(i, frame) - Place(i, frame - 1)).norm();
      secs += 1 / kRate;
    }
  }
  EXPECT_GT(way / secs, 1.5);
  EXPECT_LT(way / secs, 3);
}

TEST(FloorballGame, PeopleFightForTheBallButDoNotPassThroughEachOther) {
  int overlapping = 0;
  int fights = 0;  // frames with three players or more within 0.8 m of the ball
  for (FrameIndex frame = 0; frame < kFrames; ++frame) {
    const std::size_t people = Game().people().size();
    int near = 0;
    bool overlaps = false;
    const Vector2d ball = Game().BallAt(frame).head<2>();
    for (std::size_t i = 0; i < people; ++i) {
      if ((Place(i, frame) - ball).norm() < 1) ++near;
      for (std::size_t j = 0; j < i; ++j) {
        overlaps |= (Place(i, frame) - Place(j, frame)).norm() < 0.45;
      }
    }
    fights += near >= 3 ? 1 : 0;
    overlapping += overlaps ? 1 : 0;
  }
  EXPECT_LT(overlapping, 0.01 * kFrames);
  EXPECT_GT(fights, 0.01 * kFrames);
}

TEST(FloorballGame, TheBallStaysInTheRinkAndNearPlayers) {
  int held = 0;
  for (FrameIndex frame = 0; frame < kFrames; ++frame) {
    const Eigen::Vector3d ball = Game().BallAt(frame);
    EXPECT_GT(GapToBoards(ball.head<2>()), 0.05);
    EXPECT_GT(ball.z(), 0);
    if (frame > 0) {
      EXPECT_LT((ball - Game().BallAt(frame - 1)).norm() * kRate, 20);
    }
    for (std::size_t i = 0; i < Game().people().size(); ++i) {
      if ((Place(i, frame) - ball.head<2>()).norm() < 1.1) {
        ++held;
        break;
      }
    }
  }
  EXPECT_GT(held, 0.5 * kFrames);
}

TEST(FloorballGame, SomeStandOrSitAtFirstAndMoveLater) {
  int ghosts = 0;
  for (std::size_t i = 0; i < Game().people().size(); ++i) {
    double first = 0;
    double later = 0;
    for (FrameIndex frame = 1; frame < 600; ++frame) {
      double& way = frame < 60 ? first : later;
      way += (Place(i, frame) - Place(i, frame - 1)).norm();
    }
    ghosts += first < 0.05 && later > 3 ? 1 : 0;
  }
  EXPECT_GE(ghosts, 4);
  EXPECT_LE(ghosts, 16);
}

TEST(FloorballGame, IsAFunctionOfTheSeedAndALongerOneBeginsAlike) {
  const FloorballGame same(7, 300);
  const FloorballGame other(8, 300);
  double differs = 0;
  for (FrameIndex frame = 0; frame < 300; ++frame) {
    for (std::size_t i = 0; i < same.people().size(); ++i) {
      EXPECT_EQ(same.PostureAt(i, frame).ground_m, Place(i, frame));
      EXPECT_EQ(same.PostureAt(i, frame).gait, Game().PostureAt(i, frame).gait);
      differs += (other.PostureAt(i, frame).ground_m - Place(i, frame)).norm();
    }
    EXPECT_EQ(same.BallAt(frame), Game().BallAt(frame));
  }
  EXPECT_GT(differs, 300);
}

TEST(Boards, AreFarthestFromTheMiddleAndRoundInTheCorners) {
  EXPECT_NEAR(GapToBoards({0, 0}), 10, 1e-9);
  EXPECT_NEAR(GapToBoards({19, 0}), 1, 1e-9);
  EXPECT_LT(GapToBoards({19.8, 9.8}), 0);
  EXPECT_NEAR(GapToBoards({0, 11}), -1, 1e-9);
  Dice dice(3);
  for (int i = 0; i < 200; ++i) {
    const Vector2d place(dice.Uniform(-25, 25), dice.Uniform(-15, 15));
    EXPECT_GE(GapToBoards(WithinBoards(place, 0.5)), 0.5 - 1e-9);
    if (GapToBoards(place) > 0.5) {
      EXPECT_NEAR((WithinBoards(place, 0.5) - place).norm(), 0, 1e-9);
    }
  }
}

TEST(Walkers, PassEachOtherWithoutTouching) {
  std::vector<Walker> walkers(2);
  walkers[0].place_m = {-4, 0};
  walkers[0].target_m = {4, 0};
  walkers[1].place_m = {4, 0.02};
  walkers[1].target_m = {-4, 0};
  for (Walker& walker : walkers) walker.pace_m_s = 4;
  for (int step = 0; step < 60 * 8; ++step) {
    MoveWalkers(walkers, 1.0 / 60);
    ASSERT_GT((walkers[0].place_m - walkers[1].place_m).norm(), 0.4);
  }
  EXPECT_LT((walkers[0].place_m - walkers[0].target_m).norm(), 0.1);
  EXPECT_LT((walkers[1].place_m - walkers[1].target_m).norm(), 0.1);
}

}  // namespace
}  // namespace vantage::simulation
