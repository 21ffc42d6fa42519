// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "vantage/simulation/body.h"
#include "vantage/simulation/dice.h"
#include "vantage/simulation/props.h"
#include "vantage/simulation/stage.h"

namespace vantage::simulation {

/// A person of the film: postures of the frames from `first` on.
struct Actor {
  int id = 0;
  Figure figure;
  FrameIndex first = 0;
  std::vector<Posture> postures;
};

/// Where a rigid thing is.
struct Placement {
  Eigen::Vector3f ground_m = {0, 0, 0};  ///< of its own origin
  float yaw_rad = 0;
};

/// An object that may move, or be moved.
struct Prop {
  int id = 0;
  Shape shape;                        ///< about its own origin, on the ground z = 0
  std::vector<Placement> placements;  ///< of the frames from 0 on; the last one holds on
};

/// A swaying part of the scenery.
struct Swaying {
  int id = 0;
  Foliage foliage;
};

/// A board that shows one picture after the other.
struct Board {
  int id = 0;
  Block block;
  std::vector<MaterialIndex> pictures;  ///< at least one
  double secs = 5;                      ///< each, > 0
};

/// Gain of a light over time: (seconds, gain), times ascending; smooth steps between them.
using LightCurve = std::vector<std::pair<double, double>>;

/// The sun behind passing clouds: slow changes over 20 to 40 s, and now and then one of 3 s.
LightCurve Clouds(double seconds, Dice& dice);

/// What is rehearsed beforehand and played as it is.
struct Rehearsal {
  double frames_per_second = 10;
  std::vector<Actor> actors;
  std::vector<Prop> props;
  std::vector<Swaying> scenery;
  std::vector<Board> boards;
  std::vector<LightCurve> lights;  ///< ambient, then each lamp; empty curves are 1 throughout
};

/// The script of a rehearsal. Ids must differ.
std::unique_ptr<Script> MakePlay(Rehearsal rehearsal);

}  // namespace vantage::simulation
