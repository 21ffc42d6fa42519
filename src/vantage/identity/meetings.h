// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/geometry/grid.h"
#include "vantage/linking/linker.h"

namespace vantage {

/// A moment at which two people are so near that they may be taken for each other.
struct Meeting {
  std::int64_t frame = 0;  ///< counts from the first map
  std::size_t first = 0;   ///< indices of two paths, first < second
  std::size_t second = 0;
  friend bool operator==(const Meeting&, const Meeting&) = default;
};

/// The moments at which two paths are nearer than `distance_m` and nearest to each other of all
/// moments within `apart_frames` (>= 1), in ascending order of frames, then of paths; never at the
/// first frame of either. Of moments that are equally near, the first and those that come more than
/// `apart_frames` after the last one that was taken: people who walk side by side meet many times.
std::vector<Meeting> FindMeetings(std::span<const LinkedPath> paths, const GroundGrid& grid,
                                  double distance_m, std::int64_t apart_frames);

}  // namespace vantage
