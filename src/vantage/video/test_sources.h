// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/video/frame_source.h"

/// Helpers for tests only; not installed.

namespace vantage::testing {

inline std::string Bytes(const std::filesystem::path& path) { return ReadTextFile(path).value(); }
inline void WriteBytes(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// Reads to the end; the number of frames, and the message if it failed.
struct Outcome {
  int frames = 0;
  std::string message;
};
inline Outcome ReadAll(FrameSource& source) {
  Outcome outcome;
  cv::Mat frame;
  for (;; ++outcome.frames) {
    const Result<bool> more = source.Read(frame);
    outcome.message = MessageOf(more);
    if (!more || !*more) return outcome;
  }
}

}  // namespace vantage::testing
