// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vantage/base/ids.h"

namespace vantage {

/// Where one person stood at one frame, on the ground in metres.
struct TrackPoint {
  FrameIndex frame = 0;
  double x_m = 0;
  double y_m = 0;
  /// True where nothing in the pictures supports the position and it was filled in between
  /// positions that are.
  bool inferred = false;
  friend bool operator==(const TrackPoint&, const TrackPoint&) = default;
};

/// One identity; frames strictly ascend.
struct Track {
  TrackId id{};
  std::vector<TrackPoint> points;
  friend bool operator==(const Track&, const Track&) = default;
};

/// Tracks of one run, in ascending order of id; no two share an id.
using Tracks = std::vector<Track>;

}  // namespace vantage
