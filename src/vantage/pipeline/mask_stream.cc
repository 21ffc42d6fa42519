// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/mask_stream.h"

#include <algorithm>
#include <utility>

#include "vantage/base/parallel.h"
#include "vantage/base/stopwatch.h"

namespace vantage {

Result<MaskStream> MaskStream::Create(const Scene& scene, const BackgroundOptions& options,
                                      int threads) {
  std::vector<SyncedSource> inputs;
  std::vector<std::optional<BackgroundSubtractor>> subtractors;
  for (const SceneCamera& camera : scene.cameras) {
    auto source = OpenSource(camera.source);
    if (!source) return Fail("camera {}: {}", camera.name, source.error().message);
    const SourceInfo& info = (*source)->info();
    if (info.size != camera.camera.size()) {
      return Fail(
          "camera {}: {} has pictures of {} x {} px, its calibration is for {} x {}; give the "
          "calibration of these pictures",
          camera.name, info.name, info.size.width, info.size.height, camera.camera.size().width,
          camera.camera.size().height);
    }
    subtractors.emplace_back();
    if (info.content == FrameContent::kColor) {
      VANTAGE_ASSIGN_OR_RETURN(
          subtractors.back(),
          BackgroundSubtractor::Create(info.size, options, scene.frames_per_second));
    }
    inputs.push_back({.source = std::move(*source), .offset_frames = camera.source.offset_frames});
  }
  VANTAGE_ASSIGN_OR_RETURN(MultiCameraReader reader,
                           MultiCameraReader::Create(std::move(inputs), scene.first_frame));
  MaskStream stream(std::move(reader), threads);
  stream.subtractors_ = std::move(subtractors);
  stream.frame_count_ = stream.reader_.frame_count();
  if (scene.frame_count) {
    stream.frame_count_ =
        std::min(stream.frame_count_.value_or(*scene.frame_count), *scene.frame_count);
    stream.limit_ = *scene.frame_count;
  }
  return stream;
}

Result<bool> MaskStream::Read(std::vector<cv::Mat>& masks, std::span<const cv::Mat> held) {
  if (frames_read_ == limit_) return false;
  Stopwatch stopwatch;
  VANTAGE_ASSIGN_OR_RETURN(const bool more, reader_.Read(frames_, threads_));
  stopwatch.LapInto(read_secs_);
  if (!more) return false;
  masks.resize(frames_.size());
  // One camera uses all threads for its rows; several share them.
  const int row_threads = frames_.size() == 1 ? threads_ : 1;
  std::vector<Status> statuses(frames_.size());
  ParallelFor(threads_, static_cast<std::int64_t>(frames_.size()), [&](std::int64_t i) {
    const auto camera = static_cast<std::size_t>(i);
    if (frames_[camera].empty()) {
      masks[camera] = cv::Mat();
    } else if (subtractors_[camera]) {
      statuses[camera] = subtractors_[camera]->Apply(frames_[camera], masks[camera], row_threads,
                                                     held.empty() ? cv::Mat() : held[camera]);
    } else {
      frames_[camera].copyTo(masks[camera]);
    }
  });
  stopwatch.LapInto(background_secs_);
  for (const Status& status : statuses) VANTAGE_RETURN_IF_ERROR(Status(status));
  ++frames_read_;
  return true;
}

}  // namespace vantage
