// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/track_recording.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/experiments/pets_scenes.h"
#include "vantage/experiments/recordings.h"
#include "vantage/tracks/track_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr FrameIndex kPetsFrames = 795;
constexpr FrameIndex kQuickFrames = 100;  // of PETS
constexpr const char* kPetsTruth = "gt-mot15-3d.txt";
constexpr const char* kVideo = "vtest.avi";
constexpr const char* kVideoOfPackage = "/usr/share/doc/opencv-doc/examples/data";

/// A simulated recording and how readers are told of it.
Result<TrackRecording> Simulated(const Study& study, const std::string& name,
                                 const simulation::RecordOptions& options,
                                 const std::string& size) {
  TrackRecording recording{.name = name, .title = "", .simulated = true};
  VANTAGE_ASSIGN_OR_RETURN(recording.made_by, SimulatedRecording(study, name, options));
  const FrameIndex frames = std::min(*options.stage.frames, study.frames.value_or(1'000'000));
  recording.title = fmt::format("{}, simulated: {} cameras, {}, {} frames", name,
                                options.stage.cameras.value_or(0), size, frames);
  recording.scene = [name](const fs::path& folder) {
    return LoadScene(folder / "data" / name / "scene.toml");
  };
  recording.truth = fs::path("data") / name / "truth" / "tracks.csv";
  recording.frames = frames;
  recording.picture_scale = options.stage.scale;
  return recording;
}

/// A scene of the examples on real data.
TrackRecording Real(const Study& study, std::string name, std::string title, std::string_view text,
                    const fs::path& data) {
  TrackRecording recording{.name = std::move(name), .title = std::move(title)};
  if (study.quick) recording.name += "-quick";
  const FrameIndex all = study.quick ? kQuickFrames : kPetsFrames;
  recording.frames = std::min(all, study.frames.value_or(all));
  recording.title += fmt::format(", {} frames", *recording.frames);
  recording.inputs["scene"] = text;
  recording.inputs["frames"] = *recording.frames;
  recording.truth = fs::absolute(study.data) / "pets2009" / kPetsTruth;
  recording.scene = [name = recording.name, text = std::string(text), data = fs::absolute(data),
                     frames = recording.frames](const fs::path& folder) -> Result<Scene> {
    const fs::path file = folder / "scenes" / (name + ".toml");
    VANTAGE_RETURN_IF_ERROR(WriteTextFile(file, text));
    VANTAGE_ASSIGN_OR_RETURN(Scene scene, LoadScene(file, data));
    scene.frame_count = frames;
    return scene;
  };
  return recording;
}

/// A line for the first of the files that is not there.
bool AllThere(const std::vector<fs::path>& files, std::string_view what,
              std::vector<std::string>& skipped) {
  std::error_code code;
  for (const fs::path& file : files) {
    if (fs::exists(file, code)) continue;
    skipped.push_back(fmt::format("{}: {} is not there", what, file.string()));
    return false;
  }
  return true;
}

}  // namespace

std::vector<CellPtr> TrackRecording::Needs() const {
  return made_by ? std::vector<CellPtr>{made_by} : std::vector<CellPtr>{};
}

Result<Tracks> TrackRecording::Truth(const fs::path& folder, FrameIndex every) const {
  VANTAGE_ASSIGN_OR_RETURN(Tracks tracks, ReadTracks(folder / truth));
  for (Track& track : tracks) {
    std::erase_if(track.points, [&](const TrackPoint& point) {
      return (frames && point.frame >= *frames) || point.frame % every != 0;
    });
  }
  std::erase_if(tracks, [](const Track& track) { return track.points.empty(); });
  return tracks;
}

Result<TrackRecording> FloorballRecording(const Study& study) {
  simulation::RecordOptions options;
  options.preset = "floorball";
  options.stage.frames = study.quick ? 80 : 1000;
  options.stage.cameras = study.quick ? 4 : 8;
  options.stage.scale = study.quick ? 0.5 : 1;
  VANTAGE_ASSIGN_OR_RETURN(TrackRecording recording,
                           Simulated(study, study.quick ? "floorball-quick" : "floorball", options,
                                     study.quick ? "480 x 384" : "960 x 768"));
  recording.sparse_truth = study.quick ? 8 : 40;
  return recording;
}

Result<TrackRecording> CampusRecording(const Study& study) {
  simulation::RecordOptions options;
  options.preset = "campus";
  options.stage.frames = study.quick ? 60 : kPetsFrames;
  options.stage.cameras = study.quick ? 4 : 7;
  options.stage.scale = study.quick ? 0.5 : 1;
  std::error_code code;
  const fs::path people = study.data / "pets2009" / kPetsTruth;
  const bool real_people = !study.data.empty() && fs::exists(people, code);
  if (real_people) options.stage.people = fs::absolute(people);
  return Simulated(study, study.quick ? "campus-quick" : "campus", options,
                   real_people ? "the people of PETS 2009 S2.L1" : "invented people");
}

Result<std::optional<TrackRecording>> PetsVideoRecording(const Study& study,
                                                         std::vector<std::string>& skipped) {
  constexpr const char* kTitle = "PETS 2009 S2.L1, View_001, real video";
  if (study.data.empty()) {
    skipped.push_back(fmt::format("{}: no --data", kTitle));
    return std::nullopt;
  }
  const fs::path pets = study.data / "pets2009";
  std::error_code code;
  const fs::path folder = fs::exists(pets / kVideo, code) ? pets : fs::path(kVideoOfPackage);
  if (!AllThere({pets / kPetsTruth, folder / kVideo}, kTitle, skipped)) return std::nullopt;
  TrackRecording recording = Real(study, "pets-video", kTitle, kPetsView001Scene, folder);
  VANTAGE_ASSIGN_OR_RETURN(recording.inputs["video"], DescribeData(folder / kVideo));
  VANTAGE_ASSIGN_OR_RETURN(recording.inputs["truth"], DescribeData(pets / kPetsTruth));
  return recording;
}

Result<std::optional<TrackRecording>> PetsBoxesRecording(const Study& study,
                                                         std::vector<std::string>& skipped) {
  constexpr const char* kTitle = "PETS 2009 S2.L1, a detector's boxes in 7 real views";
  if (study.data.empty()) {
    skipped.push_back(fmt::format("{}: no --data", kTitle));
    return std::nullopt;
  }
  const fs::path pets = study.data / "pets2009";
  if (!AllThere({pets / kPetsTruth, pets / "detections", pets / "calibration"}, kTitle, skipped)) {
    return std::nullopt;
  }
  TrackRecording recording = Real(study, "pets-boxes", kTitle, kPetsSevenViewsScene, pets);
  for (const char* part : {"detections", "calibration", kPetsTruth}) {
    VANTAGE_ASSIGN_OR_RETURN(recording.inputs[part], DescribeData(pets / part));
  }
  return recording;
}

}  // namespace vantage
