// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "vantage/simulation/body.h"
#include "vantage/simulation/dice.h"

/// How people of the floorball preset move: each has a wish and follows it within what legs can do,
/// without running into others.

namespace vantage::simulation {

/// The rink: the boards stand on this line, with rounded corners.
inline constexpr double kRinkHalfLength_m = 20, kRinkHalfWidth_m = 10, kRinkCornerRadius_m = 2.5;

struct Walker {
  Eigen::Vector2d place_m = {0, 0};
  Eigen::Vector2d velocity_m_s = {0, 0};
  Posture posture;  ///< as it is filmed
  double height_m = 1.78;
  double fastest_m_s = 6;

  // Wishes for the next step.
  Eigen::Vector2d target_m = {0, 0};
  double pace_m_s = 1.5;
  std::optional<Eigen::Vector2d> look_at_m;  ///< turned to when slow
  double crouch = 0;
  double sit = 0;
  double arm_reach = 0;
  bool in_rink = false;  ///< kept within the boards
  bool seated = false;   ///< goes straight to its target: no one pushes it off its seat
};

/// Distance to the boards from within; negative outside.
double GapToBoards(const Eigen::Vector2d& place_m);
/// The nearest place that is at least `gap_m` within the boards.
Eigen::Vector2d WithinBoards(const Eigen::Vector2d& place_m, double gap_m);

/// Moves everybody towards their targets for a short time (1/60 s).
void MoveWalkers(std::vector<Walker>& walkers, double seconds);

}  // namespace vantage::simulation
