// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "scene_flags.h"
#include "vantage/base/file.h"
#include "vantage/occupancy/peaks.h"
#include "vantage/pipeline/track.h"

namespace vantage::app {

/// `vantage occupancy --explain DIR`: a folder of pictures of a scene's ground and of one frame's
/// map, which appears whole or not at all.
class Explanation {
 public:
  /// Fails when the folder cannot be made or holds something already, and when the scene does not
  /// process `frame`.
  static Result<Explanation> Create(const Scene& scene, const std::filesystem::path& folder,
                                    FrameIndex frame);

  /// Keeps the masks of the frame that is explained.
  MaskSink Sink();

  /// Draws everything and puts the folder in its place. Fails when the maps end before the frame.
  Status Finish(const SceneSetup& setup, const MapsResult& result, int threads);

  FrameIndex frame() const { return frame_; }
  /// After Finish: the detections of the frame.
  const std::vector<Peak>& peaks() const { return peaks_; }

 private:
  Explanation(StagedDirectory folder, FrameIndex frame)
      : folder_(std::move(folder)), frame_(frame) {}
  StagedDirectory folder_;
  FrameIndex frame_;
  std::vector<cv::Mat> masks_;
  std::vector<Peak> peaks_;
};

}  // namespace vantage::app
