// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vantage/background/subtractor.h"
#include "vantage/base/result.h"
#include "vantage/scene/scene.h"
#include "vantage/video/multi_camera.h"

namespace vantage {

/// Masks of all cameras of a scene, in step. Colour sources pass through background subtraction;
/// masks and detection boxes pass as they are.
class MaskStream {
 public:
  /// Opens every source. Fails, naming the camera, when one cannot be opened or delivers another
  /// size than its calibration was made for.
  static Result<MaskStream> Create(const Scene& scene, const BackgroundOptions& options,
                                   int threads);

  /// Frames of the scene that all sources hold and that the scene asks for; none when not known.
  std::optional<std::int64_t> frame_count() const { return frame_count_; }

  /// The next frame: one mask per camera, empty where a camera has no picture now. False at the
  /// end. `held`, none or one for each camera, is where objects are known to stand
  /// (BackgroundSubtractor::Apply).
  Result<bool> Read(std::vector<cv::Mat>& masks, std::span<const cv::Mat> held = {});

  /// Time spent, all cameras together as wall-clock.
  double read_secs() const { return read_secs_; }
  double background_secs() const { return background_secs_; }
  const std::vector<std::optional<BackgroundSubtractor>>& subtractors() const {
    return subtractors_;
  }

 private:
  MaskStream(MultiCameraReader reader, int threads)
      : reader_(std::move(reader)), threads_(threads) {}
  MultiCameraReader reader_;
  std::vector<std::optional<BackgroundSubtractor>> subtractors_;  // none: delivers masks
  std::vector<cv::Mat> frames_;
  std::optional<std::int64_t> frame_count_;
  std::int64_t frames_read_ = 0;
  std::int64_t limit_ = -1;  // frames that the scene asks for; -1: all
  int threads_ = 1;
  double read_secs_ = 0;
  double background_secs_ = 0;
};

}  // namespace vantage
