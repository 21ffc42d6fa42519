// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/truth_writer.h"

#include <fmt/format.h>

#include <map>
#include <utility>

namespace vantage::simulation {
namespace {

namespace fs = std::filesystem;

fs::path BoxesPath(const fs::path& folder, const std::string& camera) {
  return folder / "boxes" / (camera + ".txt");
}

Status CheckStream(std::ofstream& stream, const fs::path& path) {
  if (!stream.flush()) {
    return Fail("{}: cannot be written to; is the disk full?", path.string());
  }
  return {};
}

}  // namespace

Result<TruthWriter> TruthWriter::Create(const Stage& stage, bool masks, const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder / "boxes", failed);
  if (failed) return Fail("{}: cannot be made: {}", (folder / "boxes").string(), failed.message());
  VANTAGE_ASSIGN_OR_RETURN(TrackWriter tracks,
                           TrackWriter::Create(folder / "tracks.csv", stage.frames_per_second));
  TruthWriter writer(std::move(tracks), folder);
  writer.visibility_.open(folder / "visibility.csv");
  writer.visibility_ << "frame,camera,id,pixels,visible_pixels\n";
  for (const StageCamera& camera : stage.cameras) {
    writer.cameras_.push_back(camera.name);
    writer.boxes_.emplace_back(BoxesPath(folder, camera.name));
    if (!masks) continue;
    VANTAGE_ASSIGN_OR_RETURN(
        MaskWriter mask_writer,
        MaskWriter::Create(folder / "masks" / camera.name, MaskFormat::kPng, camera.camera.size(),
                           stage.frames_per_second, false));
    writer.masks_.push_back(std::move(mask_writer));
  }
  return writer;
}

Status TruthWriter::Write(FrameIndex frame, const std::vector<Thing>& things,
                          const std::vector<Shot>& shots) {
  std::map<int, Eigen::Vector2d> people;
  for (const Thing& thing : things) {
    if (thing.kind == Thing::Kind::kPerson) people.emplace(thing.id, thing.ground_m);
  }
  for (const auto& [id, ground_m] : people) {
    people_.insert(id);
    VANTAGE_RETURN_IF_ERROR(
        tracks_.Write(TrackId{id}, {.frame = frame, .x_m = ground_m.x(), .y_m = ground_m.y()}));
  }
  for (std::size_t camera = 0; camera < shots.size(); ++camera) {
    for (const Sighting& sighting : shots[camera].sightings) {
      const auto person = people.find(sighting.id);
      if (person == people.end()) continue;
      visibility_ << fmt::format("{},{},{},{},{}\n", frame, cameras_[camera], sighting.id,
                                 sighting.pixels, sighting.visible_pixels);
      boxes_[camera] << fmt::format("{},{},{},{},{},{},1,{:.4f},{:.4f},0\n", frame + 1, sighting.id,
                                    sighting.box.x, sighting.box.y, sighting.box.width,
                                    sighting.box.height, person->second.x(), person->second.y());
    }
    if (!masks_.empty()) {
      VANTAGE_RETURN_IF_ERROR(masks_[camera].Write(frame, shots[camera].mask));
    }
  }
  return {};
}

Status TruthWriter::Finish() {
  VANTAGE_RETURN_IF_ERROR(tracks_.Commit());
  VANTAGE_RETURN_IF_ERROR(CheckStream(visibility_, folder_ / "visibility.csv"));
  for (std::size_t camera = 0; camera < boxes_.size(); ++camera) {
    VANTAGE_RETURN_IF_ERROR(CheckStream(boxes_[camera], BoxesPath(folder_, cameras_[camera])));
  }
  for (MaskWriter& masks : masks_) VANTAGE_RETURN_IF_ERROR(masks.Finish());
  return {};
}

}  // namespace vantage::simulation
