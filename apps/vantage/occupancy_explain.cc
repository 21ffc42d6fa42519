// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "occupancy_explain.h"

#include <utility>

#include "vantage/pipeline/ground.h"
#include "vantage/rendering/occupancy_picture.h"
#include "vantage/scene/frame_pictures.h"
#include "vantage/video/mask_writer.h"

namespace vantage::app {
Result<Explanation> Explanation::Create(const Scene& scene, const std::filesystem::path& folder,
                                        FrameIndex frame) {
  if (frame < scene.first_frame ||
      (scene.frame_count && frame >= scene.first_frame + *scene.frame_count)) {
    return Fail("--frame {}: {} begins at frame {}{}", frame, scene.file.string(),
                scene.first_frame,
                scene.frame_count
                    ? fmt::format(" and ends at {}", scene.first_frame + *scene.frame_count - 1)
                    : "");
  }
  VANTAGE_ASSIGN_OR_RETURN(StagedDirectory staged, StagedDirectory::Create(folder, false));
  return Explanation(std::move(staged), frame);
}

MaskSink Explanation::Sink() {
  return [this](FrameIndex frame, const std::vector<cv::Mat>& masks) -> Status {
    if (frame != frame_) return {};
    for (const cv::Mat& mask : masks) masks_.push_back(mask.clone());
    return {};
  };
}

Status Explanation::Finish(const SceneSetup& setup, const MapsResult& result, int threads) {
  const Scene& scene = setup.scene;
  if (masks_.empty()) {
    return Fail("--frame {}: the cameras' pictures end at frame {}", frame_,
                scene.first_frame + result.report.frames - 1);
  }
  const PersonOptions& person = result.report.person.used;
  VANTAGE_ASSIGN_OR_RETURN(Ground ground, LayOutGround(scene, person, setup.options.occupancy));
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<cv::Mat> pictures,
                           FramePictures(scene, frame_, threads));
  const std::span<const float> q = result.maps.Frame(frame_ - scene.first_frame);
  VANTAGE_ASSIGN_OR_RETURN(peaks_, FindPeaks(ground.grid, q, {}));

  const OccupancyPicture draw(scene, person, ground.grid, std::move(ground.views),
                              ground.extension);
  const auto write = [&](const std::string& name, const cv::Mat& picture) {
    return WritePng(folder_.temporary() / (name + ".png"), picture);
  };
  VANTAGE_RETURN_IF_ERROR(write("plan_ground", draw.DrawPlan()));
  VANTAGE_RETURN_IF_ERROR(write("plan_map", draw.DrawMap(q, peaks_)));
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const std::string& name = scene.cameras[i].name;
    VANTAGE_RETURN_IF_ERROR(write("view_" + name + "_ground", draw.DrawView(i, pictures[i])));
    VANTAGE_RETURN_IF_ERROR(
        write("view_" + name + "_map", draw.DrawPeaks(i, pictures[i], masks_[i], peaks_)));
  }
  return folder_.Commit();
}

}  // namespace vantage::app
