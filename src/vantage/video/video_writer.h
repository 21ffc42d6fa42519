// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"

namespace vantage {

/// Writes a video that browsers play: H.264 in MP4, 4:2:0. Sides must be even there, so an odd one
/// gets its last column or row twice. The file appears under its name only by Finish; without it
/// nothing is left.
class VideoWriter {
 public:
  /// `path` ends in .mp4; sides 1 to 8192 pixels; 0 < frames_per_second <= 1000. Fails when the
  /// place cannot be written to.
  static Result<VideoWriter> Create(const std::filesystem::path& path, ImageSize size,
                                    double frames_per_second);
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;
  ~VideoWriter();

  /// Appends a CV_8UC3 frame (blue green red) of the size given to Create.
  Status Write(const cv::Mat& frame);

  /// Closes the file, reads it back (its structure, the count of its frames, the last one) because
  /// the encoder does not report a full disk, and puts it in its place. To be called once.
  Status Finish();

 private:
  struct State;
  explicit VideoWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace vantage
