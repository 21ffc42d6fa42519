// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <initializer_list>
#include <limits>

#include "vantage/tracks/track.h"

/// For tests only.

namespace vantage::testing {

constexpr double kGone = std::numeric_limits<double>::quiet_NaN();

/// A track on the x axis from `first` on; kGone: not there in that frame.
inline Track Walk(std::int64_t id, std::initializer_list<double> xs, FrameIndex first = 0,
                  FrameIndex step = 1) {
  Track track{.id = TrackId{id}, .points = {}};
  FrameIndex frame = first;
  for (const double x : xs) {
    if (!std::isnan(x)) track.points.push_back({frame, x, 0, false});
    frame += step;
  }
  return track;
}

}  // namespace vantage::testing
