// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vantage/video/frame_source.h"

namespace vantage {

/// One camera of a synchronous reading: frame t of the scene is frame t + offset of the source.
struct SyncedSource {
  std::unique_ptr<FrameSource> source;
  std::int64_t offset_frames = 0;
};

/// What a reading has found out about one camera.
struct CameraFrames {
  std::string name;  ///< SourceInfo::name
  std::int64_t offset_frames = 0;
  std::optional<std::int64_t> frame_count;  ///< of the source, where known
  std::int64_t frames_read = 0;
};

/// Reads several cameras in step. They may differ in size and content.
class MultiCameraReader {
 public:
  /// Starts at frame `first_frame` of the scene. Fails when there is no source, and, naming it, on
  /// a source that ends before its first frame is due.
  static Result<MultiCameraReader> Create(std::vector<SyncedSource> sources,
                                          std::int64_t first_frame = 0);

  /// Reads the next frame of every camera, on at most `threads` threads, into `frames` (in the
  /// order of the sources). An empty Mat means: no picture now, the camera starts later. False at
  /// the end of the shortest source. Errors are those of the sources, the first in their order.
  Result<bool> Read(std::vector<cv::Mat>& frames, int threads);

  /// The same for one camera alone: different cameras may be read from different threads, each at
  /// its own pace. False at the end of its source. A reader is used either in step or like this.
  Result<bool> ReadCamera(std::size_t camera, cv::Mat& frame);

  /// Moves one camera on by `count` frames, as ReadCamera would; fewer when its source ends.
  Status SkipCamera(std::size_t camera, std::int64_t count);

  /// Frames from the start to the end of the shortest source; none when no source knows its count.
  std::optional<std::int64_t> frame_count() const;

  /// Number of the scene's frame that the next Read gives.
  std::int64_t next_frame() const { return next_frame_; }
  std::vector<SourceInfo> infos() const;
  /// Frames of each camera: where the counts less the offsets differ, the longer ones are not used
  /// to their ends.
  std::vector<CameraFrames> report() const;

 private:
  MultiCameraReader() = default;
  Result<bool> Advance(std::size_t camera, cv::Mat& frame);
  std::vector<SyncedSource> sources_;
  std::vector<std::int64_t> frames_read_;
  std::vector<std::int64_t> next_frames_;  // number of the scene's frame that a camera gives next
  std::int64_t first_frame_ = 0;
  std::int64_t next_frame_ = 0;
  bool ended_ = false;
};

}  // namespace vantage
