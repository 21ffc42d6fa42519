// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "vantage/base/file.h"
#include "vantage/geometry/test_cameras.h"
#include "vantage/scene/scene_text.h"
#include "vantage/simulation/recording.h"
#include "vantage/tracks/track_file.h"
#include "vantage/video/video_writer.h"

/// For tests only: a stand-in for simulation::RecordScene that draws in an instant.

namespace vantage::testing {

/// Three cameras of 160 x 120 px around 8 x 6 m, 10 frames a second. Two people walk inside, dark
/// boxes before a textured wall; a third walks past outside. They come after the third frame.
struct DrawnRecording {
  static constexpr int kPeople = 3;
  static constexpr FrameIndex kEmpty = 3;

  static Eigen::Vector2d PositionAt(int person, FrameIndex frame) {
    const double t = static_cast<double>(frame) * 0.1;
    if (person == 0) return {-3 + 0.9 * t, -1.5};
    if (person == 1) return {2.5, -2 + 0.8 * t};
    return {-4 + 1.1 * t, 4.2};
  }

  static Scene MakeScene() {
    Scene scene;
    scene.grid.cell_m = 0.5;  // smaller ones make two people of a drawn one
    scene.name = "drawn";
    scene.frames_per_second = 10;
    scene.area = Polygon::Rectangle({-4, -3}, {4, 3}).value();
    const double places[3][2] = {{-8, -7}, {8, -7}, {1, 9}};
    for (int i = 0; i < 3; ++i) {
      const PinholeModel lens{.fx_px = 110, .fy_px = 110, .cx_px = 79.5, .cy_px = 59.5};
      const std::string name = fmt::format("camera{}", i + 1);
      scene.cameras.push_back(
          {.name = name,
           .source = {.kind = SourceSpec::Kind::kVideo, .path = name + ".mp4", .size = {}},
           .camera = Camera::Create({160, 120}, lens,
                                    LookAt({places[i][0], places[i][1], 5}, {0, 0, 0.5}))
                         .value()});
    }
    return scene;
  }

  static cv::Mat Draw(const Camera& camera, int seed, FrameIndex frame) {
    cv::RNG wall_rng(static_cast<std::uint64_t>(seed) + 1);
    cv::RNG rng(static_cast<std::uint64_t>(frame * 8 + seed) + 99);
    cv::Mat picture(camera.size().height, camera.size().width, CV_8UC3);
    wall_rng.fill(picture, cv::RNG::UNIFORM, 120, 255);
    cv::GaussianBlur(picture, picture, {0, 0}, 5);
    for (int person = 0; frame >= kEmpty && person < kPeople; ++person) {
      const auto box = PersonBox(camera, PositionAt(person, frame), PersonOptions());
      if (!box) continue;
      cv::rectangle(picture, cv::Point2d(box->min_x, box->min_y),
                    cv::Point2d(box->max_x, box->max_y),
                    cv::Scalar(30 + 20 * person, 20, 60 - 20 * person), cv::FILLED);
    }
    cv::Mat noise(picture.size(), CV_8UC3);
    rng.fill(noise, cv::RNG::UNIFORM, 0, 4);
    return picture + noise;
  }

  static Result<simulation::RecordReport> Record(const simulation::RecordOptions& options,
                                                 const std::filesystem::path& folder, int,
                                                 const RunControl&) {
    const Scene scene = MakeScene();
    const FrameIndex frames = options.stage.frames.value();
    VANTAGE_ASSIGN_OR_RETURN(const std::string text, SceneText(scene));
    VANTAGE_RETURN_IF_ERROR(WriteTextFile(folder / "scene.toml", text));
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
      const SceneCamera& camera = scene.cameras[i];
      VANTAGE_ASSIGN_OR_RETURN(VideoWriter video, VideoWriter::Create(folder / camera.source.path,
                                                                      camera.camera.size(), 10));
      for (FrameIndex frame = 0; frame < frames; ++frame) {
        VANTAGE_RETURN_IF_ERROR(video.Write(Draw(camera.camera, static_cast<int>(i), frame)));
      }
      VANTAGE_RETURN_IF_ERROR(video.Finish());
    }
    Tracks truth;
    for (int person = 0; person < kPeople; ++person) {
      Track& track = truth.emplace_back(Track{.id = TrackId{person + 1}, .points = {}});
      for (FrameIndex frame = kEmpty; frame < frames; ++frame) {
        const Eigen::Vector2d at = PositionAt(person, frame);
        track.points.push_back({frame, at.x(), at.y(), false});
      }
    }
    VANTAGE_RETURN_IF_ERROR(WriteTracks(folder / "truth" / "tracks.csv", truth, 10));
    return simulation::RecordReport{.film = {}, .frames = frames, .cameras = 3, .people = kPeople};
  }
};

}  // namespace vantage::testing
