// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/scene/frame_pictures.h"

#include <utility>

#include "vantage/video/multi_camera.h"

namespace vantage {

Result<std::vector<cv::Mat>> FramePictures(const Scene& scene, FrameIndex frame, int threads) {
  std::vector<SyncedSource> sources;
  for (const SceneCamera& camera : scene.cameras) {
    VANTAGE_ASSIGN_OR_RETURN(auto source, OpenSource(camera.source));
    sources.push_back({std::move(source), camera.source.offset_frames});
  }
  VANTAGE_ASSIGN_OR_RETURN(MultiCameraReader reader,
                           MultiCameraReader::Create(std::move(sources), frame));
  std::vector<cv::Mat> pictures;
  VANTAGE_RETURN_IF_ERROR(reader.Read(pictures, threads));
  pictures.resize(scene.cameras.size());
  return pictures;
}

}  // namespace vantage
