// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vantage/base/ids.h"

namespace vantage {

/// Where one person was seen in the picture of one camera, in pixels; width and height above 0.
struct BoxPoint {
  FrameIndex frame = 0;
  double left_px = 0;
  double top_px = 0;
  double width_px = 0;
  double height_px = 0;
  friend bool operator==(const BoxPoint&, const BoxPoint&) = default;
};

/// One identity in the pictures of one camera; frames strictly ascend.
struct BoxTrack {
  TrackId id{};
  std::vector<BoxPoint> points;
  friend bool operator==(const BoxTrack&, const BoxTrack&) = default;
};

/// In ascending order of id; no two share an id.
using BoxTracks = std::vector<BoxTrack>;

}  // namespace vantage
