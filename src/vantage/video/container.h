// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>

#include "vantage/base/result.h"

/// Internal to the video module: what a video file says about itself. FFmpeg reports the end of a
/// cut file like an honest end, and OpenCV's frame count is an upper bound or an estimate (edit
/// lists hide frames of an MP4, dropped frames are empty chunks in an AVI), so the file's own
/// structure decides.

namespace vantage::internal {

struct ContainerFacts {
  /// Bytes of the file, and bytes that its structure needs (0: the format does not say).
  std::uint64_t file_bytes = 0;
  std::uint64_t needed_bytes = 0;
  /// True when each frame that the header counts is one to decode (AVI and MP4/MOV only).
  bool frame_count_exact = false;
  /// Decodable frames by the AVI index; 0: not known from the structure, ask FFmpeg.
  std::int64_t indexed_frames = 0;

  bool cut_short() const { return needed_bytes > file_bytes; }
};

/// Reads the structure of AVI (RIFF), MP4/MOV (ISO base media) and Matroska/WebM files; other
/// formats give no facts. Fails on files that are missing, empty or plain text.
Result<ContainerFacts> InspectContainer(const std::filesystem::path& path);

}  // namespace vantage::internal
