// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"
#include "vantage/video/frame_source.h"

namespace vantage {

/// Writes a video that browsers play: H.264 in MP4, 4:2:0. Sides must be even there, so an odd one
/// gets its last column or row twice. Or masks without any loss: FFV1 in Matroska, grey. The file
/// appears under its name only by Finish; without it
/// nothing is left.
class VideoWriter {
 public:
  /// `path` ends in .mp4; sides 1 to 8192 pixels; 0 < frames_per_second <= 1000. Fails when the
  /// place cannot be written to.
  static Result<VideoWriter> Create(const std::filesystem::path& path, ImageSize size,
                                    double frames_per_second);
  /// `path` ends in .mkv; as above, but both sides must be even: OpenCV's encoder drops an odd last
  /// column or row, and what is lossless cannot grow one either.
  static Result<VideoWriter> CreateForMasks(const std::filesystem::path& path, ImageSize size,
                                            double frames_per_second);
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;
  ~VideoWriter();

  /// Appends a frame of the size given on creation: CV_8UC3 (blue green red); a mask CV_8UC1, 0 and
  /// 255.
  Status Write(const cv::Mat& frame);

  /// Closes the file, reads it back (its structure, the count of its frames, the last one; of masks
  /// bit for bit) because
  /// the encoder does not report a full disk, and puts it in its place. To be called once.
  Status Finish();

 private:
  struct State;
  static Result<VideoWriter> Open(const std::filesystem::path& path, ImageSize size,
                                  double frames_per_second, FrameContent content);
  explicit VideoWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace vantage
