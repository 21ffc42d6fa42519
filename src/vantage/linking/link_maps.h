// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/geometry/polygon.h"
#include "vantage/linking/linker.h"
#include "vantage/linking/stream_linker.h"
#include "vantage/linking/track_builder.h"
#include "vantage/occupancy/maps.h"
#include "vantage/tracks/track.h"

namespace vantage {

struct LinkMapsReport {
  LinkingReport linking;
  /// Paths without a track: outside the area, or seen too shortly.
  std::int64_t dropped_paths = 0;
};

struct LinkMapsResult {
  Tracks tracks;
  /// What the tracks are made from: the optimum.
  std::vector<LinkedPath> paths;
  LinkMapsReport report;
};

/// The problem of LinkPaths that LinkMaps solves; it refers to its arguments.
LinkingProblem ProblemOf(const OccupancyMaps& maps, std::span<const std::uint8_t> access,
                         std::span<const std::uint8_t> obstacle);

/// From maps to tracks: the optimal set of paths over area and extension, then their positions in
/// the area. `doors` are places inside where people come and go, `obstacles` where nobody stands.
Result<LinkMapsResult> LinkMaps(const OccupancyMaps& maps, const LinkingOptions& linking,
                                const TrackOptions& tracks, std::span<const Polygon> doors = {},
                                std::span<const Polygon> obstacles = {},
                                const RunControl& control = {});

/// The linker of a stream of maps on the grid and with the visibility of `like`, whose values are
/// not used; access and obstacles as LinkMaps has them.
Result<StreamLinker> MakeStreamLinker(const OccupancyMaps& like, const LinkingOptions& linking,
                                      std::int64_t lag_frames, std::span<const Polygon> doors,
                                      std::span<const Polygon> obstacles);

}  // namespace vantage
