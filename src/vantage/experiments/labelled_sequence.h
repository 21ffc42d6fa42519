// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"
#include "vantage/video/frame_source.h"

namespace vantage {

/// Which frames of a sequence are used.
struct FrameSpan {
  /// The first frame that a method sees, >= 0.
  FrameIndex begin = 0;
  /// First and last frame that count, of those from begin on that have truth, first <= last.
  FrameIndex first = 0;
  FrameIndex last = std::numeric_limits<FrameIndex>::max();
  /// At most so many frames are seen before the first that counts, >= 0.
  std::int64_t lead = std::numeric_limits<std::int64_t>::max();
  /// Frames that count end after so many, >= 1.
  std::int64_t most = std::numeric_limits<std::int64_t>::max();
};

/// A frame with its truth (labels of video/sequence.h), empty where the frame does not count.
struct LabelledFrame {
  FrameIndex frame = 0;
  cv::Mat bgr;     ///< CV_8UC3
  cv::Mat labels;  ///< CV_8UC1 of its size
};

/// The pictures of one camera in order, with their truth, however the two are kept. Frames that
/// cannot be read, and truth of another size than its picture, are errors that name the file.
class LabelledSequence {
 public:
  /// A change-detection sequence (video/sequence.h). Fails when no frame counts.
  static Result<LabelledSequence> OpenSequence(const std::filesystem::path& folder,
                                               const FrameSpan& span);

  /// A camera, from 0, of a simulated recording (simulation/recording.h) with its true masks.
  static Result<LabelledSequence> OpenRecording(const std::filesystem::path& folder, int camera,
                                                const FrameSpan& span);

  /// Whatever OpenInput reads, without truth: no frame counts; it ends with the input or after
  /// span.last.
  static Result<LabelledSequence> OpenUnlabelled(const std::filesystem::path& path,
                                                 const FrameSpan& span);

  /// False after the last frame that counts.
  Result<bool> Next(LabelledFrame& frame);

  ImageSize size() const { return pictures_->info().size; }
  /// Whether a region of interest restricts what counts; outside it labels say so.
  bool has_roi() const { return !roi_.empty(); }
  /// What a user should know about how the folder was understood, one line each.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Frames in the sequence's temporal range that have no truth and do not count.
  std::int64_t frames_without_truth() const { return frames_without_truth_; }

 private:
  LabelledSequence() = default;

  std::unique_ptr<FrameSource> pictures_;
  /// Truth of a frame from span.begin on, asked for in order; empty where it does not count.
  std::function<Result<cv::Mat>(FrameIndex)> truth_;
  cv::Mat roi_;  ///< as TruthSequence::roi
  std::vector<std::string> notes_;
  std::int64_t frames_without_truth_ = 0;
  FrameIndex next_ = 0;
  FrameIndex last_ = 0;
  /// Whether the pictures must reach last_.
  bool last_is_known_ = false;
};

}  // namespace vantage
