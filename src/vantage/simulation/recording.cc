// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/recording.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/base/parallel.h"
#include "vantage/base/stopwatch.h"
#include "vantage/base/version.h"
#include "vantage/scene/scene_text.h"
#include "vantage/simulation/truth_writer.h"
#include "vantage/video/video_writer.h"

namespace vantage::simulation {
namespace {

namespace fs = std::filesystem;

/// What one camera delivers, in the order of delivery: each picture once it has been taken.
class Delivery {
 public:
  static Result<Delivery> Create(const Stage& stage, int camera,
                                 const std::vector<CameraFault>& faults, const fs::path& folder) {
    const StageCamera& used = stage.cameras[static_cast<std::size_t>(camera)];
    const ImageSize size = used.camera.size();
    VANTAGE_ASSIGN_OR_RETURN(VideoWriter video, VideoWriter::Create(folder / (used.name + ".mp4"),
                                                                    size, stage.frames_per_second));
    Delivery delivery(std::move(video));
    delivery.due_ = DeliveredFrames(stage.frames, stage.frames_per_second, camera, faults);
    if (delivery.due_.empty()) {
      return Fail("--fault: camera {} would deliver no picture; leave it some", camera + 1);
    }
    delivery.black_ = cv::Mat::zeros(size.height, size.width, CV_8UC3);
    return delivery;
  }

  /// Writes all that shows this frame, or nothing at all and is due now.
  Status Write(FrameIndex frame, const cv::Mat& picture) {
    for (; next_ < due_.size() && due_[next_].value_or(frame) <= frame; ++next_) {
      VANTAGE_RETURN_IF_ERROR(video_.Write(due_[next_] ? picture : black_));
    }
    return {};
  }

  Status Finish() { return video_.Finish(); }

 private:
  explicit Delivery(VideoWriter video) : video_(std::move(video)) {}
  VideoWriter video_;
  std::vector<std::optional<FrameIndex>> due_;
  std::size_t next_ = 0;
  cv::Mat black_;
};

/// The scene file of a stage; it is at home in the folder of the videos.
Scene SceneOf(const Stage& stage) {
  Scene scene;
  scene.name = stage.name;
  scene.frames_per_second = stage.frames_per_second;
  scene.area = stage.area;
  scene.doors = stage.doors;
  scene.obstacles = stage.obstacles;
  if (stage.cell_m) scene.grid.cell_m = *stage.cell_m;
  for (const StageCamera& camera : stage.cameras) {
    scene.cameras.push_back(
        {.name = camera.name,
         .source = {.kind = SourceSpec::Kind::kVideo, .path = camera.name + ".mp4", .size = {}},
         .camera = camera.camera});
  }
  return scene;
}

nlohmann::ordered_json JsonOf(const CameraFault& fault) {
  constexpr const char* kNames[] = {"drop", "freeze", "black", "drift"};
  nlohmann::ordered_json json = {{"kind", kNames[static_cast<int>(fault.kind)]},
                                 {"camera", fault.camera + 1},
                                 {"first", fault.first}};
  if (fault.kind == CameraFault::Kind::kDrift) {
    json["drift_per_s"] = fault.drift_per_s;
  } else {
    json["count"] = fault.count;
  }
  return json;
}

nlohmann::ordered_json RecordOf(const RecordOptions& options, const Stage& stage, int people) {
  nlohmann::ordered_json json = {{"version", kVersion},
                                 {"simulated", true},
                                 {"preset", options.preset},
                                 {"seed", options.stage.seed},
                                 {"frames", stage.frames},
                                 {"cameras", stage.cameras.size()},
                                 {"scale", options.stage.scale},
                                 {"people_from", options.stage.people.string()},
                                 {"people", people}};
  json["faults"] = nlohmann::ordered_json::array();
  for (const CameraFault& fault : options.faults) json["faults"].push_back(JsonOf(fault));
  return json;
}

std::string TextOf(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

Status FirstError(const std::vector<Status>& statuses) {
  for (const Status& status : statuses) VANTAGE_RETURN_IF_ERROR(Status(status));
  return {};
}

}  // namespace

Result<RecordReport> RecordScene(const RecordOptions& options, const fs::path& folder, int threads,
                                 const RunControl& control) {
  const Stopwatch total;
  VANTAGE_ASSIGN_OR_RETURN(const Stage stage, MakeStage(options.preset, options.stage));
  const auto cameras = static_cast<std::int64_t>(stage.cameras.size());
  for (const CameraFault& fault : options.faults) {
    if (fault.camera >= cameras) {
      return Fail("--fault: there is no camera {}; there are {}", fault.camera + 1, cameras);
    }
  }
  VANTAGE_ASSIGN_OR_RETURN(TruthWriter truth,
                           TruthWriter::Create(stage, options.masks, folder / "truth"));
  std::vector<Delivery> deliveries;
  for (int camera = 0; camera < cameras; ++camera) {
    VANTAGE_ASSIGN_OR_RETURN(Delivery delivery,
                             Delivery::Create(stage, camera, options.faults, folder));
    deliveries.push_back(std::move(delivery));
  }
  control.Report(0, stage.frames);
  const RunControl setup{.progress = {}, .stop = control.stop};  // progress counts frames
  VANTAGE_ASSIGN_OR_RETURN(Film film, Film::Create(stage, options.stage.seed, threads, setup));

  RecordReport report;
  std::vector<Status> statuses(stage.cameras.size());
  for (FrameIndex frame = 0; frame < stage.frames; ++frame) {
    if (control.Stopped()) return Cancelled();
    VANTAGE_ASSIGN_OR_RETURN(const std::vector<Shot> shots, film.Shoot(frame, threads));
    Stopwatch encoding;
    ParallelFor(threads, cameras, [&](std::int64_t i) {
      const auto camera = static_cast<std::size_t>(i);
      statuses[camera] = deliveries[camera].Write(frame, shots[camera].picture);
    });
    VANTAGE_RETURN_IF_ERROR(FirstError(statuses));
    VANTAGE_RETURN_IF_ERROR(truth.Write(frame, stage.script->At(frame), shots));
    encoding.LapInto(report.encode_secs);
    control.Report(frame + 1, stage.frames);
  }
  ParallelFor(threads, cameras, [&](std::int64_t i) {
    const auto camera = static_cast<std::size_t>(i);
    statuses[camera] = deliveries[camera].Finish();
  });
  VANTAGE_RETURN_IF_ERROR(FirstError(statuses));
  VANTAGE_RETURN_IF_ERROR(truth.Finish());
  VANTAGE_ASSIGN_OR_RETURN(const std::string scene, SceneText(SceneOf(stage)));
  VANTAGE_RETURN_IF_ERROR(WriteTextFile(folder / "scene.toml", scene));
  VANTAGE_RETURN_IF_ERROR(
      WriteTextFile(folder / "simulation.json", TextOf(RecordOf(options, stage, truth.people()))));
  report.film = film.report();
  report.frames = stage.frames;
  report.cameras = static_cast<int>(cameras);
  report.people = truth.people();
  report.total_secs = total.Seconds();
  return report;
}

}  // namespace vantage::simulation
