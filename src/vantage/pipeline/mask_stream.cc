// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/mask_stream.h"

#include <algorithm>
#include <utility>

namespace vantage {

namespace {

/// All sources of a scene at its first frame.
Result<MultiCameraReader> OpenCameras(const Scene& scene) {
  std::vector<SyncedSource> inputs;
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
    inputs.push_back({.source = std::move(*source), .offset_frames = camera.source.offset_frames});
  }
  return MultiCameraReader::Create(std::move(inputs), scene.first_frame);
}

}  // namespace

Result<MaskStream> MaskStream::Create(const Scene& scene, const BackgroundOptions& options,
                                      int threads) {
  VANTAGE_ASSIGN_OR_RETURN(MultiCameraReader reader, OpenCameras(scene));
  MaskStream stream(std::move(reader));
  VANTAGE_RETURN_IF_ERROR(stream.MakeSubtractors(scene, options));
  stream.frame_count_ = stream.reader_.frame_count();
  if (scene.frame_count) {
    stream.frame_count_ =
        std::min(stream.frame_count_.value_or(*scene.frame_count), *scene.frame_count);
    stream.limit_ = *scene.frame_count;
  }
  if (scene.cameras.size() == 1) stream.row_threads_ = threads;
  return stream;
}

Status MaskStream::MakeSubtractors(const Scene& scene, const BackgroundOptions& options) {
  subtractors_.clear();
  for (const SourceInfo& info : reader_.infos()) {
    subtractors_.emplace_back();
    if (info.content != FrameContent::kColor) continue;
    VANTAGE_ASSIGN_OR_RETURN(subtractors_.back(), BackgroundSubtractor::Create(
                                                      info.size, options, scene.frames_per_second));
  }
  return {};
}

Status MaskStream::Rewind(const Scene& scene, const BackgroundOptions& options, bool keep_learnt) {
  VANTAGE_ASSIGN_OR_RETURN(reader_, OpenCameras(scene));
  return keep_learnt ? Status() : MakeSubtractors(scene, options);
}

bool MaskStream::learns() const {
  return std::ranges::any_of(subtractors_, [](const auto& camera) { return camera.has_value(); });
}

Result<bool> MaskStream::Read(int camera, std::int64_t frame, cv::Mat& picture) {
  if (frame == limit_) return false;
  return reader_.ReadCamera(static_cast<std::size_t>(camera), picture);
}

Status MaskStream::Skip(int camera, std::int64_t count) {
  return reader_.SkipCamera(static_cast<std::size_t>(camera), count);
}

Status MaskStream::Rehearse(int camera, const cv::Mat& picture, cv::Mat& mask) {
  auto& subtractor = subtractors_[static_cast<std::size_t>(camera)];
  if (!subtractor || picture.empty()) return Subtract(camera, picture, {}, mask);
  return subtractor->Rehearse(picture, mask, row_threads_);
}

Status MaskStream::Subtract(int camera, const cv::Mat& picture, const cv::Mat& held,
                            cv::Mat& mask) {
  auto& subtractor = subtractors_[static_cast<std::size_t>(camera)];
  if (picture.empty()) {
    mask = cv::Mat();
  } else if (subtractor) {
    return subtractor->Apply(picture, mask, row_threads_, held);
  } else {
    picture.copyTo(mask);
  }
  return {};
}

FlowStage MaskStages::Reading() {
  return {.lanes = stream_.cameras(),
          .queue = kPictureQueue,
          .work = [this](std::int64_t frame, int camera) {
            return stream_.Read(camera, frame, read_[frame][static_cast<std::size_t>(camera)]);
          }};
}

FlowStage MaskStages::Background(std::int64_t queue, std::function<const cv::Mat&(int camera)> held,
                                 std::function<void(int camera, const cv::Mat& mask)> made) {
  return {.lanes = stream_.cameras(),
          .queue = queue,
          .work = [this, held = std::move(held), made = std::move(made)](
                      std::int64_t frame, int camera) -> Result<bool> {
            const auto index = static_cast<std::size_t>(camera);
            cv::Mat& mask = masks[frame][index];
            cv::Mat& picture = read_[frame][index];
            VANTAGE_RETURN_IF_ERROR(
                stream_.Subtract(camera, picture, held ? held(camera) : cv::Mat(), mask));
            // Moved, so that the picture read next has memory of its own.
            if (KeepsPictures(frame) && stream_.subtractors()[index]) {
              pictures[frame][index] = std::move(picture);
            }
            if (made) made(camera, mask);
            return true;
          }};
}

}  // namespace vantage
