// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/geometry/polygon.h"
#include "vantage/linking/linker.h"
#include "vantage/linking/stream_linker.h"
#include "vantage/linking/track_builder.h"
#include "vantage/occupancy/maps.h"
#include "vantage/tracks/track.h"

namespace vantage {

/// Tracks of the last moments of a recording that is still running: what a stream's linker has not
/// settled yet. Their ids count within one window.
class RecentTracks {
 public:
  /// `like` gives grid, area, visibility, frame rate and the number of the first frame; its own
  /// values are not used. `window_frames` >= 1. Fails on options out of range.
  static Result<RecentTracks> Create(const OccupancyMaps& like, std::int64_t window_frames,
                                     const LinkingOptions& linking, const TrackOptions& tracks,
                                     std::span<const Polygon> doors,
                                     std::span<const Polygon> obstacles);

  /// The maps of the frames that follow, one after another; the oldest leave the window.
  Status Add(std::span<const float> maps);

  /// Number of the frame after the last one added.
  FrameIndex next_frame() const { return window_.first_frame + window_.frame_count(); }

  /// The tracks in the window, as LinkMaps gives them but neither smoothed nor dropped for being
  /// short.
  Result<Tracks> Link() const;

 private:
  RecentTracks(const OccupancyMaps& like, std::int64_t window_frames, StreamLinker linker,
               const TrackOptions& tracks);

  OccupancyMaps window_;
  std::int64_t window_frames_;
  StreamLinker linker_;
  TrackOptions tracks_;
};

}  // namespace vantage
