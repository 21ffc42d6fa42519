// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/recent_tracks.h"

#include <utility>

#include "vantage/linking/link_maps.h"

namespace vantage {

RecentTracks::RecentTracks(const OccupancyMaps& like, std::int64_t window_frames,
                           const LinkingOptions& linking, const TrackOptions& tracks,
                           std::vector<Polygon> doors, std::vector<Polygon> obstacles)
    : window_{.grid = like.grid,
              .first_frame = like.first_frame,
              .frames_per_second = like.frames_per_second,
              .in_area = like.in_area,
              .visible = like.visible,
              .values = {}},
      window_frames_(window_frames),
      linking_(linking),
      tracks_(tracks),
      doors_(std::move(doors)),
      obstacles_(std::move(obstacles)) {
  tracks_.smoothing_secs = 0;
  tracks_.min_length_secs = 0;
}

void RecentTracks::Add(std::span<const float> maps) {
  std::vector<float>& values = window_.values;
  values.insert(values.end(), maps.begin(), maps.end());
  const std::int64_t left = window_.frame_count() - window_frames_;
  if (left <= 0) return;
  values.erase(values.begin(), values.begin() + left * window_.grid.count());
  window_.first_frame += left;
}

Result<Tracks> RecentTracks::Link() const {
  VANTAGE_ASSIGN_OR_RETURN(LinkMapsResult linked,
                           LinkMaps(window_, linking_, tracks_, doors_, obstacles_));
  return std::move(linked.tracks);
}

}  // namespace vantage
