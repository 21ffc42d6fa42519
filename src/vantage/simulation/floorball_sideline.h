// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "vantage/simulation/floorball_play.h"
#include "vantage/simulation/floorball_walkers.h"

namespace vantage::simulation {

/// The gap in the boards in front of the benches: players leave in one lane, enter in the other.
/// Team 0 sits at negative x.
inline constexpr double kLaneOut_m = 3.0, kLaneIn_m = 1.8;
inline constexpr double kGateFrom_m = 1.1, kGateTo_m = 3.7;
inline constexpr double kBench_m = 11.85, kBenchFrom_m = 4.5, kSeat_m = 0.75;

/// One team's bench: every now and then somebody gets up, and takes the place of somebody who
/// leaves the rink and sits down instead.
class Bench {
 public:
  /// `resting`: walkers on the bench, placed on it here. The last of five stands beside it.
  Bench(int team, std::vector<int> resting, double first_secs, std::vector<Walker>& walkers);

  void Step(std::vector<Walker>& walkers, Squad& squad, std::optional<int> holder,
            double clock_secs, Dice& dice);

 private:
  enum class State { kQuiet, kRising, kWalking, kLeaving, kCrossing, kReturning, kSittingDown };
  struct Seat {
    int walker = 0;
    Eigen::Vector2d place_m = {0, 0};
    bool stands = false;
    double since_secs = 0;
  };

  double side_;  // -1 or 1: sign of x
  std::vector<Seat> seats_;
  State state_ = State::kQuiet;
  double next_secs_;
  std::size_t seat_ = 0;  // that changes hands
  int entering_ = 0;
  int leaving_ = 0;
  std::size_t slot_ = 0;
  std::array<double, 5> on_since_secs_ = {};
};

/// People who do not play: each walks along a line and pauses, or follows the ball along it.
struct Bystander {
  int walker = 0;
  Eigen::Vector2d from_m = {0, 0};
  Eigen::Vector2d to_m = {0, 0};
  double pace_m_s = 1.3;
  double pause_secs = 3;        ///< longest
  bool follows_ball = false;    ///< referees
  double still_until_secs = 0;  ///< does not move before
  bool sits_at_first = false;   ///< until then
  double next_secs = 0;
};

void StepBystander(Bystander& bystander, std::vector<Walker>& walkers,
                   const Eigen::Vector3d& ball_m, double clock_secs, Dice& dice);

}  // namespace vantage::simulation
