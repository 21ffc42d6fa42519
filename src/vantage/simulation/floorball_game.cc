// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/floorball_game.h"

#include <array>
#include <cmath>
#include <numbers>

#include "vantage/simulation/floorball_play.h"
#include "vantage/simulation/floorball_sideline.h"
#include "vantage/simulation/floorball_walkers.h"

namespace vantage::simulation {
namespace {

using Eigen::Vector2d;

constexpr int kStepsPerFrame = 3;
constexpr double kStep_secs = 1 / (FloorballGame::kFramesPerSecond * kStepsPerFrame);
constexpr double kPlacing_secs = 20;  // before the first frame, everybody finds their place
constexpr std::array<int, 2> kTeamSizes = {11, 10};  // with the keeper

std::uint8_t Byte(double share) { return static_cast<std::uint8_t>(std::lround(255 * share)); }

// Those around the rink, with where they begin.
std::vector<Bystander> Bystanders(int first, Dice& dice) {
  std::vector<Bystander> all(8);
  // Referees, behind the boards on the side without benches.
  all[0] = {.from_m = {-18, -10.6}, .to_m = {-1, -10.6}, .pace_m_s = 4, .follows_ball = true};
  all[1] = {.from_m = {1, -10.6}, .to_m = {18, -10.6}, .pace_m_s = 4, .follows_ball = true};
  // Coaches, of whom one stands still for long at first.
  all[2] = {.from_m = {-10.2, 11.1}, .to_m = {-9.1, 10.9}, .pace_m_s = 0.9, .pause_secs = 9};
  all[3] = {.from_m = {9.1, 10.9}, .to_m = {10.6, 11.1}, .pace_m_s = 0.9, .pause_secs = 9};
  all[2].still_until_secs = dice.Uniform(10, 14);
  // Spectators, of whom one sits at first and another just stands.
  all[4] = {.from_m = {-20, -12.6}, .to_m = {20, -12.4}, .pace_m_s = 1.3, .pause_secs = 4};
  all[5] = {.from_m = {21.8, -11.5}, .to_m = {22.2, 11}, .pace_m_s = 1.4, .pause_secs = 5};
  all[6] = {.from_m = {-21.8, -9}, .to_m = {-21.8, 10}, .pace_m_s = 1.2, .pause_secs = 3};
  all[6].still_until_secs = dice.Uniform(6, 10);
  all[6].sits_at_first = true;
  all[7] = {.from_m = {13.5, 12.3}, .to_m = {14.2, 12.5}, .pace_m_s = 0.6, .pause_secs = 20};
  for (std::size_t i = 0; i < all.size(); ++i) all[i].walker = first + static_cast<int>(i);
  return all;
}

}  // namespace

FloorballGame::FloorballGame(std::uint64_t seed, FrameIndex frames) {
  Dice dice(seed * 0x9E3779B97F4A7C15ULL + 1);
  std::vector<Walker> walkers;
  const auto join = [&](Role role, int team) {
    people_.push_back(
        {role, team, role == Role::kSpectator ? dice.Uniform(1.6, 1.85) : dice.Uniform(1.7, 1.94)});
    Walker walker;
    walker.height_m = people_.back().height_m;
    walker.fastest_m_s = dice.Uniform(5.2, 6.5);
    walker.posture.gait = dice.Unit();
    walkers.push_back(walker);
    return static_cast<int>(walkers.size()) - 1;
  };

  std::array<Squad, 2> squads;
  std::vector<Bench> benches;
  for (const int team : {0, 1}) {
    const auto side = static_cast<std::size_t>(team);
    Squad& squad = squads[side];
    const double own = team == 0 ? -1 : 1;
    squad.keeper = join(Role::kKeeper, team);
    walkers.back().place_m = {own * 15.7, 0};
    walkers.back().posture.heading_rad = team == 0 ? 0 : std::numbers::pi;
    walkers.back().in_rink = true;
    for (std::size_t slot = 0; slot < 5; ++slot) {
      squad.slots[slot] = join(Role::kPlayer, team);
      walkers.back().place_m = {own * (1.5 + 2 * static_cast<double>(slot)), dice.Uniform(-7, 7)};
      walkers.back().in_rink = true;
    }
    std::vector<int> resting;
    while (static_cast<int>(resting.size()) + 6 < kTeamSizes[side]) {
      resting.push_back(join(Role::kPlayer, team));
    }
    benches.emplace_back(team, resting, team == 0 ? dice.Uniform(4, 6) : dice.Uniform(7, 10),
                         walkers);
  }
  std::vector<Bystander> bystanders = Bystanders(static_cast<int>(walkers.size()), dice);
  constexpr std::array<Role, 8> kRoles = {Role::kReferee,   Role::kReferee,   Role::kCoach,
                                          Role::kCoach,     Role::kSpectator, Role::kSpectator,
                                          Role::kSpectator, Role::kSpectator};
  for (std::size_t i = 0; i < kRoles.size(); ++i) {
    const Bystander& bystander = bystanders[i];
    join(kRoles[i], i == 3 ? 1 : 0);
    Walker& walker = walkers.back();
    walker.place_m = walker.target_m = 0.5 * (bystander.from_m + bystander.to_m);
    walker.posture.heading_rad = std::atan2(-walker.place_m.y(), -walker.place_m.x());
    walker.posture.sit = bystander.sits_at_first ? 1 : 0;
  }

  Play play(seed + 17);
  const auto placing = static_cast<std::int64_t>(std::lround(kPlacing_secs / kStep_secs));
  const std::int64_t steps = frames * kStepsPerFrame;
  samples_.reserve(static_cast<std::size_t>(frames) * walkers.size());
  balls_.reserve(static_cast<std::size_t>(frames));
  for (std::int64_t step = -placing; step < steps; ++step) {
    const double clock_secs = static_cast<double>(step) * kStep_secs;
    if (step == 0) play.Whistle();
    play.Step(walkers, squads, kStep_secs);
    for (std::size_t team = 0; team < 2; ++team) {
      benches[team].Step(walkers, squads[team], play.holder(), clock_secs, dice);
    }
    for (Bystander& bystander : bystanders) {
      StepBystander(bystander, walkers, play.ball_m(), clock_secs, dice);
    }
    MoveWalkers(walkers, kStep_secs);
    if (step < 0 || step % kStepsPerFrame != 0) continue;
    for (const Walker& walker : walkers) {
      const Posture& p = walker.posture;
      samples_.push_back({static_cast<float>(p.ground_m.x()), static_cast<float>(p.ground_m.y()),
                          static_cast<float>(p.heading_rad), static_cast<float>(p.speed_m_s),
                          static_cast<float>(p.gait), Byte(p.crouch), Byte(p.sit),
                          Byte(p.arm_reach)});
    }
    balls_.push_back(play.ball_m().cast<float>());
  }
}

Posture FloorballGame::PostureAt(std::size_t person, FrameIndex frame) const {
  const Sample& sample = samples_[person + static_cast<std::size_t>(frame) * people_.size()];
  Posture posture;
  posture.ground_m = {sample.x_m, sample.y_m};
  posture.heading_rad = sample.heading_rad;
  posture.speed_m_s = sample.speed_m_s;
  posture.gait = sample.gait;
  posture.crouch = sample.crouch / 255.0;
  posture.sit = sample.sit / 255.0;
  posture.arm_reach = sample.arm_reach / 255.0;
  return posture;
}

Eigen::Vector3d FloorballGame::BallAt(FrameIndex frame) const {
  return balls_[static_cast<std::size_t>(frame)].cast<double>();
}

}  // namespace vantage::simulation
