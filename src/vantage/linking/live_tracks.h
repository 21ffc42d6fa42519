// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/geometry/polygon.h"
#include "vantage/linking/linker.h"
#include "vantage/linking/position_refiner.h"
#include "vantage/linking/stream_linker.h"
#include "vantage/linking/track_builder.h"
#include "vantage/occupancy/maps.h"
#include "vantage/tracks/track.h"

namespace vantage {

/// One row of a file of tracks.
struct TrackRow {
  TrackId track{};
  TrackPoint point;
  friend bool operator==(const TrackRow&, const TrackRow&) = default;
};

struct LiveReport {
  StreamReport linking;
  std::int64_t lag_frames = 0;
  std::int64_t tracks = 0;     ///< ids given out
  std::int64_t positions = 0;  ///< given out
  std::int64_t inferred = 0;   ///< of these
  double seconds = 0;
};

/// Tracks of a stream of maps, given out for good a fixed lag after each frame, in memory for the
/// maps of that lag. With a lag of the whole recording they are those of LinkMaps. With less, what
/// comes later than the lag is not known to
/// - the linking (StreamLinker): who does not earn the birth cost within the lag is not seen;
/// - the smoothing: its window ends where the known frames end;
/// - stretches without support: they are inferred from the frame on from which the next supported
///   position is known. While it is not, the track has no position, as at the end of a path; it
///   goes on with the same id;
/// - the minimal length: a track begins in the first frame in which it is known to be long enough,
///   and loses the positions before.
class LiveTracks {
 public:
  /// `like` gives grid, area, visibility, frame rate and the number of the first frame; its values
  /// are not used. 0 <= lag_secs <= 1e6, rounded to whole frames, at least one. Fails as LinkMaps
  /// does, and on linking.max_paths > 0.
  static Result<LiveTracks> Create(const OccupancyMaps& like, const LinkingOptions& linking,
                                   const TrackOptions& tracks, double lag_secs,
                                   std::span<const Polygon> doors = {},
                                   std::span<const Polygon> obstacles = {});

  /// Adds the next frame's map. Returns the positions of the frame that is final now, if any, by
  /// id. Ids count from 1 in the order of their first positions, and are never given twice. Fails,
  /// changing nothing, on a wrong size and on values that are no probabilities.
  Result<std::vector<TrackRow>> Add(std::span<const float> map);

  /// Ends the stream: the positions of the frames that were not final, by frame, then by id. Add
  /// must not follow.
  std::vector<TrackRow> Finish();

  const LiveReport& report() const { return report_; }

 private:
  /// A path that has a position in the last final frame.
  struct Path {
    /// By frame; of those before the last final frame the ones in the smoothing's reach, and at
    /// least one.
    std::vector<linking::SeenPosition> seen;
    std::int64_t seen_frames = 0;  ///< inside the area, in final frames
    bool shown = false;            ///< long enough
    std::optional<TrackId> track;
  };

  LiveTracks(linking::PositionRefiner refiner, StreamLinker linker, FrameIndex first_frame,
             std::int64_t lag_frames);
  std::vector<TrackRow> Settle(std::span<const StreamFrame> known, std::size_t final_frames);
  void Extend(std::span<const StreamFrame> known, std::size_t final_frames);
  void Show(FrameIndex from);
  void Forget(const StreamFrame& last_final);

  linking::PositionRefiner refiner_;
  StreamLinker linker_;
  FrameIndex first_frame_;
  std::deque<std::vector<float>> maps_;  ///< of the frames that are not final
  std::map<PathId, Path> paths_;
  LiveReport report_;
};

}  // namespace vantage
