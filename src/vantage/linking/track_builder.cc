// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/track_builder.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "vantage/linking/position_refiner.h"

namespace vantage {
namespace {

using linking::PositionRefiner;
using linking::SeenPosition;

std::vector<SeenPosition> SeenPositions(const LinkedPath& path, const OccupancyMaps& maps,
                                        const PositionRefiner& refiner) {
  std::vector<SeenPosition> seen;
  std::int64_t frame = path.first_frame;
  for (const CellIndex cell : path.cells) {
    if (const auto position_m = refiner.Find(maps.Frame(frame), cell)) {
      seen.push_back({.frame = maps.first_frame + frame, .position_m = *position_m});
    }
    ++frame;
  }
  return seen;
}

}  // namespace

void VisitOptions(TrackOptions& o, OptionVisitor& v) {
  v.Number({"support", "", "probability around a position that makes it seen, not inferred"},
           o.support, Range::AboveUpTo(0, 1));
  v.Number({"smoothing", "s", "half width of the smoothing window; 0: none"}, o.smoothing_secs,
           Range::Between(0, 60));
  v.Number({"min_length", "s", "tracks seen for less are dropped"}, o.min_length_secs,
           Range::Between(0, 1e6));
}

bool IsSeen(const OccupancyMaps& maps, std::int64_t frame, CellIndex cell, double support) {
  return linking::SupportedPosition(maps.grid, maps.Frame(frame), cell, support).has_value();
}

Result<Tracks> BuildTracks(const std::vector<LinkedPath>& paths, const OccupancyMaps& maps,
                           const TrackOptions& options) {
  VANTAGE_ASSIGN_OR_RETURN(const PositionRefiner refiner, PositionRefiner::Create(maps, options));
  Tracks tracks;
  for (const LinkedPath& path : paths) {
    const std::vector<SeenPosition> seen = SeenPositions(path, maps, refiner);
    if (seen.empty()) continue;
    Track track;
    std::int64_t seen_frames = 0;
    for (FrameIndex frame = seen.front().frame; frame <= seen.back().frame; ++frame) {
      const std::optional<TrackPoint> point = refiner.PointAt(seen, frame);
      if (!point) continue;
      track.points.push_back(*point);
      seen_frames += point->inferred ? 0 : 1;
    }
    if (refiner.LongEnough(seen_frames)) tracks.push_back(std::move(track));
  }
  std::stable_sort(tracks.begin(), tracks.end(), [](const Track& a, const Track& b) {
    return a.points.front().frame < b.points.front().frame;
  });
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    tracks[i].id = static_cast<TrackId>(i + 1);
  }
  return tracks;
}

}  // namespace vantage
