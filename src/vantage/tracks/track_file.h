// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/tracks/track.h"

/// Files of tracks. Two formats are read, told apart by their first line:
///
/// Vantage's CSV: a header that begins with frame,id,x,y, then one position a line, in metres, frames
/// from 0. Of the optional columns `inferred` (0 or 1) is read, `time` and unknown ones are not.
///
/// MOTChallenge's text: no header; frame,id,left,top,width,height,confidence,x,y,... with frames and
/// pixels from 1. Frames become ours by taking away 1, so that the first frame of a recording is
/// frame 0 in both formats.
///
/// Errors name file and line. A frame that is negative, a number that is not finite, and a second
/// position of the same id in the same frame are errors.

namespace vantage {

/// Reads positions on the ground (of MOTChallenge's text, columns 8 and 9; an error where they are
/// missing or all -1).
Result<Tracks> ReadTracks(const std::filesystem::path& path);

/// Rectangle in a picture, pixels.
struct ImageBox {
  double left = 0;
  double top = 0;
  double width = 0;
  double height = 0;
};

struct BoxTrackPoint {
  FrameIndex frame = 0;
  ImageBox box;
};

/// One identity in a picture; frames strictly ascend.
struct BoxTrack {
  TrackId id{};
  std::vector<BoxTrackPoint> points;
};

/// Reads boxes in a picture from MOTChallenge's text (columns 3 to 6). Lines of truth whose
/// confidence (column 7) is 0 are marked there as not to be evaluated and are left out.
Result<std::vector<BoxTrack>> ReadBoxTracks(const std::filesystem::path& path);

/// Writes Vantage's CSV, whole or not at all, in order of frame and id, positions to 0.1 mm:
/// frame,id,x,y,time,inferred with the time in seconds, frame / frames_per_second (> 0).
Status WriteTracks(const std::filesystem::path& path, const Tracks& tracks,
                   double frames_per_second);

}  // namespace vantage
