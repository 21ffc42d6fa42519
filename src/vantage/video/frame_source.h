// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"

namespace vantage {

/// What a source's pictures are.
enum class FrameContent {
  kColor,  ///< CV_8UC3, blue green red, as OpenCV has them
  kMask,   ///< CV_8UC1, 0 background, 255 foreground
};

/// Known when a source is opened and true for each of its frames.
struct SourceInfo {
  std::string name;  ///< path or address, for messages
  ImageSize size;
  FrameContent content = FrameContent::kColor;
  /// Frames in the source where that can be known beforehand (not for a live stream).
  std::optional<std::int64_t> frame_count;
  /// Frames per second where the source says it.
  std::optional<double> frames_per_second;
};

/// Frames of one camera in order. A live stream implements the same two functions.
/// Not thread-safe; different sources may be read from different threads.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  virtual const SourceInfo& info() const = 0;

  /// Reads the next frame into `frame` (reallocated when needed). False at the end of the source.
  /// Fails, naming source and frame, on a frame that cannot be decoded or has another size than the
  /// first, and on a video that ends before the frames that its header promises.
  virtual Result<bool> Read(cv::Mat& frame) = 0;

  /// Skips `count` frames; fewer when the source ends. The default reads and drops them.
  virtual Result<std::int64_t> Skip(std::int64_t count);
};

}  // namespace vantage
