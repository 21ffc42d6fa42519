// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/linking/linker.h"
#include "vantage/occupancy/maps.h"
#include "vantage/tracks/track.h"

namespace vantage {

/// From paths of cells to positions in metres (algorithms.md section 5; table [tracks]).
struct TrackOptions {
  /// A position counts as seen where the 3 x 3 cells around the path's cell hold a probability of
  /// at least this together, 0 < support <= 1; elsewhere it is inferred.
  double support = 0.5;
  /// Half width of the window in which positions are smoothed by a weighted straight line,
  /// 0 <= smoothing_secs <= 60; 0 turns smoothing off.
  double smoothing_secs = 0.7;
  /// Tracks that are seen for less than this are dropped, 0 <= min_length_secs.
  double min_length_secs = 1.0;
};
void VisitOptions(TrackOptions& options, OptionVisitor& visitor);

/// True when the position counts as seen: the 3 x 3 cells around `cell` hold `support` together.
bool IsSeen(const OccupancyMaps& maps, std::int64_t frame, CellIndex cell, double support);

/// Tracks of the paths, inside the area of interest only. A position is the mean of the 3 x 3 cells
/// around the path's cell, weighted by their probabilities, then smoothed; where nothing supports
/// it, it lies on the straight line between the supported positions before and after and is marked
/// as inferred. Before the first and after the last supported position of a path nothing is known,
/// so there is no position. Ids count from 1 in the order of first frames, then of paths.
Result<Tracks> BuildTracks(const std::vector<LinkedPath>& paths, const OccupancyMaps& maps,
                           const TrackOptions& options);

}  // namespace vantage
