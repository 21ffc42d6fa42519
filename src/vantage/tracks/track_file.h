// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/tracks/box_track.h"
#include "vantage/tracks/track.h"

/// Files of tracks. Two formats are read, told apart by the first line:
///
/// - Vantage CSV: a header with the columns frame, id, x, y (metres), optionally `inferred` (0 or
/// 1)
///   and others, which are passed over (`time`, in seconds, is for people). Frames count from 0.
/// - MOTChallenge text, no header: frame, id, left, top, width, height, confidence, x, y, z. Frames
///   count from 1 there and are lowered by one on reading, so that the first picture of a recording
///   is frame 0 in both. Positions are metres, boxes pixels; what is not known is -1. Boxes
///   with confidence 0 are passed over (they mark what does not count). Otherwise, and for
///   positions, the confidence is not looked at, as in published figures on such truth.
///
/// Errors name file and line. Refused: numbers that are not finite, negative frames, frames above
/// 10^9, the same id twice in a frame, empty files.

namespace vantage {

/// The line of its file that each position stands in, from 1.
using TrackLines = std::map<std::pair<TrackId, FrameIndex>, std::size_t>;

/// Ground tracks of either format. With `lines` it says where each position was read.
Result<Tracks> ReadTracks(const std::filesystem::path& path, TrackLines* lines = nullptr);

/// Boxes of a MOTChallenge file.
Result<BoxTracks> ReadBoxTracks(const std::filesystem::path& path, TrackLines* lines = nullptr);

/// Writes Vantage CSV as positions become known: frame,id,x,y,time,inferred in the order of frames,
/// then ids; x and y to 0.1 mm. The file appears whole with Commit, or not at all.
class TrackWriter {
 public:
  /// `frames_per_second` gives the time of a frame, frame 0 being at 0 s. Fails unless it is above
  /// 0, and where the file cannot be made.
  static Result<TrackWriter> Create(const std::filesystem::path& path, double frames_per_second);

  /// Fails on positions that are not finite, out of order or twice there.
  Status Write(TrackId id, const TrackPoint& point);

  Status Commit();

 private:
  TrackWriter(StagedFile staged, double frames_per_second);
  Status CheckWritten() const;

  StagedFile staged_;
  std::ofstream stream_;
  double frames_per_second_;
  std::optional<std::pair<FrameIndex, TrackId>> last_;
};

/// Writes whole tracks as TrackWriter does.
Status WriteTracks(const std::filesystem::path& path, const Tracks& tracks,
                   double frames_per_second);

}  // namespace vantage
