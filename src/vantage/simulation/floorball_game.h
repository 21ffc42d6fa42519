// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/simulation/body.h"

namespace vantage::simulation {

/// A game of floorball that is played out once, when it is made: where everybody is in each frame.
/// A function of seed and frame; a longer game begins like a shorter one.
class FloorballGame {
 public:
  static constexpr double kFramesPerSecond = 20;

  enum class Role { kKeeper, kPlayer, kReferee, kCoach, kSpectator };
  struct Person {
    Role role = Role::kPlayer;
    int team = 0;  ///< of keepers, players and coaches: 0 plays towards +x, 1
    double height_m = 1.75;
  };

  FloorballGame(std::uint64_t seed, FrameIndex frames);

  /// 2 keepers, 19 players, 2 referees, 2 coaches, 4 spectators.
  const std::vector<Person>& people() const { return people_; }
  /// `frame` within the game.
  Posture PostureAt(std::size_t person, FrameIndex frame) const;
  Eigen::Vector3d BallAt(FrameIndex frame) const;

 private:
  struct Sample {  // of one person; small, since games are long
    float x_m, y_m, heading_rad, speed_m_s, gait;
    std::uint8_t crouch, sit, arm_reach;  // of 255
  };
  std::vector<Person> people_;
  std::vector<Sample> samples_;         // person + frame * people
  std::vector<Eigen::Vector3f> balls_;  // one a frame
};

}  // namespace vantage::simulation
