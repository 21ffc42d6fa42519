// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/mask_stream.h"

#include <algorithm>
#include <utility>

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
  MaskStream stream(std::move(reader));
  stream.subtractors_ = std::move(subtractors);
  stream.frame_count_ = stream.reader_.frame_count();
  if (scene.frame_count) {
    stream.frame_count_ =
        std::min(stream.frame_count_.value_or(*scene.frame_count), *scene.frame_count);
    stream.limit_ = *scene.frame_count;
  }
  if (scene.cameras.size() == 1) stream.row_threads_ = threads;
  return stream;
}

Result<bool> MaskStream::Read(int camera, std::int64_t frame, cv::Mat& picture) {
  if (frame == limit_) return false;
  return reader_.ReadCamera(static_cast<std::size_t>(camera), picture);
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
            return stream_.Read(camera, frame, pictures_[frame][static_cast<std::size_t>(camera)]);
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
            VANTAGE_RETURN_IF_ERROR(stream_.Subtract(camera, pictures_[frame][index],
                                                     held ? held(camera) : cv::Mat(), mask));
            if (made) made(camera, mask);
            return true;
          }};
}

}  // namespace vantage
