// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "vantage/background/subtractor.h"
#include "vantage/base/result.h"
#include "vantage/pipeline/flow.h"
#include "vantage/scene/scene.h"
#include "vantage/video/multi_camera.h"

namespace vantage {

/// Masks of all cameras of a scene. Colour sources pass through background subtraction; masks and
/// detection boxes pass as they are. Each camera is read and judged at its own pace; frames count
/// from 0, the first that the scene asks for.
class MaskStream {
 public:
  /// Opens every source. Fails, naming the camera, when one cannot be opened or delivers another
  /// size than its calibration was made for. `threads` is for the rows of a picture where there is
  /// one camera only; several share them.
  static Result<MaskStream> Create(const Scene& scene, const BackgroundOptions& options,
                                   int threads);

  int cameras() const { return static_cast<int>(subtractors_.size()); }

  /// Frames of the scene that all sources hold and that the scene asks for; none when not known.
  std::optional<std::int64_t> frame_count() const { return frame_count_; }

  /// The next picture of a camera; empty when it has none now. False at its end, and after the last
  /// frame that the scene asks for. Different cameras may be read at the same time.
  Result<bool> Read(int camera, std::int64_t frame, cv::Mat& picture);

  /// Leaves out the next `count` frames of a camera.
  Status Skip(int camera, std::int64_t count);

  /// Its mask, CV_8UC1; empty for an empty picture. To be called for the frames in order.
  /// `held` is where objects are known to stand, or empty (BackgroundSubtractor::Apply). Different
  /// cameras may be asked at the same time.
  Status Subtract(int camera, const cv::Mat& picture, const cv::Mat& held, cv::Mat& mask);

  /// What a rehearsal makes of a picture (BackgroundSubtractor::Rehearse): the camera learns it.
  /// Masks and boxes pass as they are.
  Status Rehearse(int camera, const cv::Mat& picture, cv::Mat& mask);

  /// Back to the first frame: the sources are opened once more. What the cameras have learnt stays
  /// with them if `keep_learnt`; otherwise they have learnt nothing.
  Status Rewind(const Scene& scene, const BackgroundOptions& options, bool keep_learnt);

  const std::vector<std::optional<BackgroundSubtractor>>& subtractors() const {
    return subtractors_;
  }
  /// Whether any camera learns a background.
  bool learns() const;

 private:
  explicit MaskStream(MultiCameraReader reader) : reader_(std::move(reader)) {}
  Status MakeSubtractors(const Scene& scene, const BackgroundOptions& options);
  MultiCameraReader reader_;
  std::vector<std::optional<BackgroundSubtractor>> subtractors_;  // none: delivers masks
  std::optional<std::int64_t> frame_count_;
  std::int64_t limit_ = -1;  // frames that the scene asks for; -1: all
  int row_threads_ = 1;
};

/// What is on its way between stages, one entry for each of the frames that may be at once.
template <class T>
class Ring {
 public:
  explicit Ring(std::int64_t size, const T& value = {})
      : entries_(static_cast<std::size_t>(size), value) {}
  T& operator[](std::int64_t frame) {
    return entries_[static_cast<std::size_t>(frame) % entries_.size()];
  }

 private:
  std::vector<T> entries_;
};

/// The first two stages of a chain, reading and background, with a lane for each camera. They leave
/// the masks in masks[frame][camera] and, of some frames, the pictures of cameras that deliver
/// colour in pictures[frame][camera], empty ones of the other cameras.
class MaskStages {
 public:
  /// Pictures that wait for the background: a decoder has long frames and short ones.
  static constexpr std::int64_t kPictureQueue = 4;

  /// `kept`: frames for which the masks of one stay; the queues from the background to the last
  /// stage that uses them. Pictures stay of every so many frames, from the first on; 0: of none.
  /// Who uses them lets go of them, since the next ones come only so many frames later.
  MaskStages(MaskStream& stream, std::int64_t kept, std::int64_t frames_between_pictures = 0)
      : masks(kept, std::vector<cv::Mat>(static_cast<std::size_t>(stream.cameras()))),
        pictures(kept, std::vector<cv::Mat>(static_cast<std::size_t>(stream.cameras()))),
        stream_(stream),
        frames_between_pictures_(frames_between_pictures),
        read_(kPictureQueue, std::vector<cv::Mat>(static_cast<std::size_t>(stream.cameras()))) {}

  /// Whether the pictures of a frame stay.
  bool KeepsPictures(std::int64_t frame) const {
    return frames_between_pictures_ > 0 && frame % frames_between_pictures_ == 0;
  }

  FlowStage Reading();
  /// `held`, if any, gives what a camera holds; `made` is told that a camera has made a mask.
  FlowStage Background(std::int64_t queue, std::function<const cv::Mat&(int camera)> held = {},
                       std::function<void(int camera, const cv::Mat& mask)> made = {});

  Ring<std::vector<cv::Mat>> masks;
  Ring<std::vector<cv::Mat>> pictures;

 private:
  MaskStream& stream_;
  std::int64_t frames_between_pictures_;
  Ring<std::vector<cv::Mat>> read_;
};

}  // namespace vantage
