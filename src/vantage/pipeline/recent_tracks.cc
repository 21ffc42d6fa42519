// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/recent_tracks.h"

#include <map>
#include <utility>
#include <vector>

#include "vantage/linking/link_maps.h"

namespace vantage {

RecentTracks::RecentTracks(const OccupancyMaps& like, std::int64_t window_frames,
                           StreamLinker linker, const TrackOptions& tracks)
    : window_{.grid = like.grid,
              .first_frame = like.first_frame,
              .frames_per_second = like.frames_per_second,
              .in_area = like.in_area,
              .visible = like.visible,
              .values = {}},
      window_frames_(window_frames),
      linker_(std::move(linker)),
      tracks_(tracks) {
  tracks_.smoothing_secs = 0;
  tracks_.min_length_secs = 0;
}

Result<RecentTracks> RecentTracks::Create(const OccupancyMaps& like, std::int64_t window_frames,
                                          const LinkingOptions& linking, const TrackOptions& tracks,
                                          std::span<const Polygon> doors,
                                          std::span<const Polygon> obstacles) {
  LinkingOptions stream_linking = linking;
  stream_linking.max_paths = 0;  // a cap counts the paths of the whole recording
  VANTAGE_ASSIGN_OR_RETURN(StreamLinker linker,
                           MakeStreamLinker(like, stream_linking, window_frames, doors, obstacles));
  return RecentTracks(like, window_frames, std::move(linker), tracks);
}

Status RecentTracks::Add(std::span<const float> maps) {
  const auto cells = static_cast<std::size_t>(window_.grid.count());
  for (std::size_t i = 0; i < maps.size(); i += cells) {
    const auto settled = linker_.Add(maps.subspan(i, cells));
    if (!settled) return tl::unexpected(settled.error());
  }
  std::vector<float>& values = window_.values;
  values.insert(values.end(), maps.begin(), maps.end());
  const std::int64_t left = window_.frame_count() - window_frames_;
  if (left <= 0) return {};
  values.erase(values.begin(), values.begin() + left * window_.grid.count());
  window_.first_frame += left;
  return {};
}

Result<Tracks> RecentTracks::Link() const {
  std::map<PathId, LinkedPath> by_id;
  std::int64_t frame = 0;  // of the window
  for (const StreamFrame& tentative : linker_.Tentative()) {
    for (const StreamPosition& position : tentative.positions) {
      LinkedPath& path = by_id.try_emplace(position.path, LinkedPath{frame, {}}).first->second;
      path.cells.push_back(position.cell);
    }
    ++frame;
  }
  std::vector<LinkedPath> paths;
  for (auto& [id, path] : by_id) paths.push_back(std::move(path));
  return BuildTracks(paths, window_, tracks_);
}

}  // namespace vantage
