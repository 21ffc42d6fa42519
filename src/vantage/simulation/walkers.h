// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/simulation/body.h"

/// From where people are to how they walk there.

namespace vantage::simulation {

struct Waypoint {
  double seconds = 0;
  Eigen::Vector2d ground_m = {0, 0};
};

/// The smooth way through waypoints: each coordinate is interpolated by monotone cubics (Fritsch
/// and Carlson, 1980), which pass through every waypoint, never overshoot, and rest where two
/// successive waypoints are the same place.
class Way {
 public:
  /// At least one waypoint, times ascending strictly.
  explicit Way(std::vector<Waypoint> waypoints);
  /// Before the first waypoint and after the last one: there.
  Eigen::Vector2d At(double seconds) const;

 private:
  std::vector<Waypoint> waypoints_;
  std::vector<Eigen::Vector2d> velocities_m_s_;
};

/// A place where people appear and vanish because no camera sees them there: behind or in a
/// building, outside of all pictures. Leads from that place to the open ground.
using Gate = std::vector<Eigen::Vector2d>;

/// What is known of somebody's way (at least one waypoint), completed so that nobody pops up: they
/// come from the gate that lies best behind their first steps and leave through the one before
/// their last, and where nothing is known for longer than `max_gap_secs` they go into a gate and
/// come back, or as far towards it as there is time for. All known waypoints are kept.
std::vector<Waypoint> ThroughGates(const std::vector<Waypoint>& known,
                                   const std::vector<Gate>& gates, double max_gap_secs);

/// Where somebody is in successive frames from `first` on.
struct Walk {
  FrameIndex first = 0;
  std::vector<Eigen::Vector2d> ground_m;
  /// What they look at when they stand, one a frame; may be empty.
  std::vector<std::optional<Eigen::Vector2d>> look_at_m;
};

/// The frames of 0 to frames - 1 that lie on the way.
Walk WalkThrough(const std::vector<Waypoint>& waypoints, double frames_per_second,
                 FrameIndex frames);

/// Postures of a walk, one a frame: exactly there, turned where the smoothed velocity points (or
/// to what they look at), the legs in step with the distance covered.
std::vector<Posture> Postures(const Walk& walk, double frames_per_second, double height_m);

}  // namespace vantage::simulation
