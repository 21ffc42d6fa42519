// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vantage/simulation/stage.h"

namespace vantage::simulation {

/// What stays of a person: build and clothes.
struct Figure {
  double height_m = 1.75;
  double build = 1;  ///< girth, 0.8 to 1.3
  MaterialIndex shirt = 0;
  MaterialIndex sleeves = 0;  ///< upper arms; forearms are skin or sleeves
  bool long_sleeves = false;
  MaterialIndex shorts = 0;  ///< hips and thighs; bare knees, unless the legs are of the same
  MaterialIndex legs = 0;    ///< lower legs: socks, trousers or skin
  MaterialIndex shoes = 0;
  MaterialIndex skin = 0;
  MaterialIndex hair = 0;
  bool stick = false;  ///< carries a floorball stick
  MaterialIndex stick_material = 0;
};

/// How a person holds themselves at one instant.
struct Posture {
  Eigen::Vector2d ground_m = {0, 0};  ///< below the middle of the hips
  double heading_rad = 0;             ///< 0 along +x, counter-clockwise
  double speed_m_s = 0;               ///< 0 stands; to 2.2 walks, above runs
  /// Phase of the gait in strides, a stride being two steps: its fraction tells where the legs
  /// are. AdvanceGait keeps it in step with the distance covered.
  double gait = 0;
  double crouch = 0;     ///< 0 upright to 1 deep knees (goalkeepers, fights for the ball)
  double bend = 0;       ///< 0 upright to 1 the upper body bent forward (putting things down)
  double sit = 0;        ///< 0 stands to 1 sits on a seat 0.45 m high
  double arm_reach = 0;  ///< 0 arms swing to 1 both held forward
};

/// The gait after `seconds` at this speed: cadence grows with speed as people's does, and a foot
/// on the ground stays where it is.
double AdvanceGait(double gait, double speed_m_s, double height_m, double seconds);

/// The limbs of a person, 20 to 24 round cones, soles on the ground.
std::vector<Limb> BodyLimbs(const Figure& figure, const Posture& posture);

}  // namespace vantage::simulation
