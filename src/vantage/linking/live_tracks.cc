// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/live_tracks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vantage/base/stopwatch.h"
#include "vantage/linking/link_maps.h"

namespace vantage {

using linking::PositionRefiner;
using linking::SeenPosition;

LiveTracks::LiveTracks(PositionRefiner refiner, StreamLinker linker, FrameIndex first_frame,
                       std::int64_t lag_frames)
    : refiner_(std::move(refiner)), linker_(std::move(linker)), first_frame_(first_frame) {
  report_.lag_frames = lag_frames;
}

Result<LiveTracks> LiveTracks::Create(const OccupancyMaps& like, const LinkingOptions& linking,
                                      const TrackOptions& tracks, double lag_secs,
                                      std::span<const Polygon> doors,
                                      std::span<const Polygon> obstacles) {
  constexpr double kMaxLagSecs = 1e6;
  constexpr double kMaxLagFrames = 1e9;
  VANTAGE_ASSIGN_OR_RETURN(PositionRefiner refiner, PositionRefiner::Create(like, tracks));
  if (!(lag_secs >= 0 && lag_secs <= kMaxLagSecs)) {
    return Fail("the lag is {} s; it must be between 0 and {:.0f}", lag_secs, kMaxLagSecs);
  }
  // Bounded against absurd frame rates.
  const auto lag_frames = static_cast<std::int64_t>(
      std::llround(std::clamp(lag_secs * like.frames_per_second, 1.0, kMaxLagFrames)));
  VANTAGE_ASSIGN_OR_RETURN(StreamLinker linker,
                           MakeStreamLinker(like, linking, lag_frames, doors, obstacles));
  return LiveTracks(std::move(refiner), std::move(linker), like.first_frame, lag_frames);
}

Result<std::vector<TrackRow>> LiveTracks::Add(std::span<const float> map) {
  Stopwatch stopwatch;
  const Result<std::optional<StreamFrame>> final_frame = linker_.Add(map);
  if (!final_frame) return tl::unexpected(final_frame.error());
  maps_.emplace_back(map.begin(), map.end());
  report_.linking = linker_.report();
  std::vector<TrackRow> rows;
  if (*final_frame) {
    std::vector<StreamFrame> known = linker_.Tentative();
    known.insert(known.begin(), **final_frame);
    rows = Settle(known, 1);
  }
  stopwatch.LapInto(report_.seconds);
  return rows;
}

std::vector<TrackRow> LiveTracks::Finish() {
  Stopwatch stopwatch;
  const std::vector<StreamFrame> known = linker_.Finish();
  report_.linking = linker_.report();
  std::vector<TrackRow> rows;
  if (!known.empty()) rows = Settle(known, known.size());
  stopwatch.LapInto(report_.seconds);
  return rows;
}

/// `known` are the frames of maps_, at least one; the first `final_frames` of them are final.
std::vector<TrackRow> LiveTracks::Settle(std::span<const StreamFrame> known,
                                         std::size_t final_frames) {
  std::vector<TrackRow> rows;
  Extend(known, final_frames);
  Show(first_frame_ + known.front().frame);
  for (const StreamFrame& frame : known.first(final_frames)) {
    const auto begin = std::ssize(rows);
    for (const StreamPosition& position : frame.positions) {
      Path& path = paths_.at(position.path);
      const std::optional<TrackPoint> point =
          refiner_.PointAt(path.seen, first_frame_ + frame.frame);
      if (!point) continue;
      path.seen_frames += point->inferred ? 0 : 1;
      if (!path.shown) continue;
      if (!path.track) path.track = TrackId{++report_.tracks};
      rows.push_back({.track = *path.track, .point = *point});
      ++report_.positions;
      report_.inferred += point->inferred ? 1 : 0;
    }
    std::ranges::sort(rows.begin() + begin, rows.end(), {}, &TrackRow::track);
  }
  Forget(known[final_frames - 1]);
  maps_.erase(maps_.begin(), maps_.begin() + static_cast<std::ptrdiff_t>(final_frames));
  return rows;
}

/// Adds what is seen in the known frames of all paths that have a position in a final one.
void LiveTracks::Extend(std::span<const StreamFrame> known, std::size_t final_frames) {
  for (std::size_t i = 0; i < known.size(); ++i) {
    const std::vector<float>& map = maps_[i];
    for (const StreamPosition& position : known[i].positions) {
      if (i < final_frames) paths_.try_emplace(position.path);
      const auto path = paths_.find(position.path);
      if (path == paths_.end()) continue;
      if (const auto position_m = refiner_.Find(map, position.cell)) {
        path->second.seen.push_back(
            {.frame = first_frame_ + known[i].frame, .position_m = *position_m});
      }
    }
  }
}

/// Shows the paths that are long enough, as far as is known; `from` is the first frame whose
/// positions are not counted in seen_frames.
void LiveTracks::Show(FrameIndex from) {
  for (auto& [id, path] : paths_) {
    if (path.shown) continue;
    std::int64_t seen_frames = path.seen_frames;
    for (const SeenPosition& seen : path.seen) {
      if (seen.frame >= from && refiner_.PointAt(path.seen, seen.frame)) ++seen_frames;
    }
    path.shown = refiner_.LongEnough(seen_frames);
  }
}

/// Drops the paths that have ended, what is not final of the others, and what is too old to matter.
void LiveTracks::Forget(const StreamFrame& last_final) {
  std::map<PathId, Path> alive;
  for (const StreamPosition& position : last_final.positions) {
    alive.insert(paths_.extract(position.path));
  }
  paths_ = std::move(alive);
  const FrameIndex last = first_frame_ + last_final.frame;
  for (auto& [id, path] : paths_) {
    std::vector<SeenPosition>& seen = path.seen;
    std::erase_if(seen, [&](const SeenPosition& one) { return one.frame > last; });
    const auto in_reach = std::ranges::lower_bound(seen, last + 1 - refiner_.reach_frames(), {},
                                                   &SeenPosition::frame);
    seen.erase(seen.begin(), std::min(in_reach, seen.empty() ? seen.end() : seen.end() - 1));
  }
}

}  // namespace vantage
