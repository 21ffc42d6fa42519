// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/tracks/track.h"

namespace vantage {

/// Where somebody was, some frames ago.
struct TrailPoint {
  Eigen::Vector2d position_m = {0, 0};
  double age = 0;  ///< 1 at the trail's beginning, 0 now
};

/// Somebody who is there at one frame.
struct Person {
  TrackId id{};
  Eigen::Vector2d position_m = {0, 0};
  bool inferred = false;
  std::vector<TrailPoint> trail;  ///< oldest first, the present position last
};

/// The people of one frame in order of their ids, each with the positions of the last
/// `trail_frames` frames. Positions that are not finite are left out.
std::vector<Person> PeopleAt(const Tracks& tracks, FrameIndex frame, FrameIndex trail_frames);

}  // namespace vantage
