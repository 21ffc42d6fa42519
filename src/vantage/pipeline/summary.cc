// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/summary.h"

#include <nlohmann/json.hpp>

#include "vantage/background/report.h"
#include "vantage/base/file.h"
#include "vantage/base/version.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

template <class Options>
Json Recorded(const Options& options) {
  Json json = Json::object();
  RecordOptions(options, json);
  return json;
}

Result<Json> InputHashes(const Scene& scene) {
  Json hashes = Json::object();
  const auto add = [&](const std::filesystem::path& path) -> Status {
    VANTAGE_ASSIGN_OR_RETURN(hashes[path.string()], Sha256OfFile(path));
    return {};
  };
  for (const auto& path : scene.inputs) VANTAGE_RETURN_IF_ERROR(add(path));
  for (const SceneCamera& camera : scene.cameras) {
    // Numbered pictures are too many to hash one by one; their pattern is in the scene file.
    if (std::filesystem::is_regular_file(camera.source.path)) {
      VANTAGE_RETURN_IF_ERROR(add(camera.source.path));
    }
  }
  return hashes;
}

Json StageJson(double seconds, std::int64_t frames) {
  Json json = {{"seconds", seconds}};
  if (seconds > 0) json["frames_per_second"] = static_cast<double>(frames) / seconds;
  return json;
}

}  // namespace

Json JsonOf(const ExtensionReport& report, const Scene& scene) {
  Json json;
  for (std::size_t i = 0; i < report.sides.size(); ++i) {
    const ExtensionSide& side = report.sides[i];
    Json& entry = json[std::string(kSideNames[i])];
    entry["metres"] = side.extension_m;
    entry["reason"] = NameOf(side.reason);
    if (side.camera) entry["camera"] = scene.cameras[*side.camera].name;
    for (std::size_t c = 0; c < side.cameras_m.size(); ++c) {
      entry["cameras_metres"][scene.cameras[c].name] = side.cameras_m[c];
    }
  }
  return json;
}

Result<Json> Summarize(const RunRequest& request, const Scene& scene, const StageOptions& options,
                       const TrackingResult& result) {
  const MapsReport& maps = result.report.maps;
  Json json;
  json["vantage"] = kVersion;
  json["arguments"] = request.arguments;
  json["scene"] = request.scene.string();
  json["data"] = request.data.string();
  json["threads"] = request.threads;
  VANTAGE_ASSIGN_OR_RETURN(json["inputs_sha256"], InputHashes(scene));

  Json& used = json["options"];
  used["grid"] = Recorded(scene.grid);
  used["person"] = Recorded(maps.person.used);
  used["background"] = Recorded(options.background);
  used["hold"] = Recorded(options.hold);
  used["occupancy"] = Recorded(options.occupancy);
  used["linking"] = Recorded(options.linking);
  used["identity"] = Recorded(options.identity);
  used["tracks"] = Recorded(options.tracks);

  json["extension"] = JsonOf(maps.extension, scene);

  Json& counts = json["counts"];
  counts["cameras"] = scene.cameras.size();
  counts["frames"] = maps.frames;
  counts["pictures_missing"] = maps.pictures_missing;
  counts["grid_columns"] = result.maps.grid.columns;
  counts["grid_rows"] = result.maps.grid.rows;
  counts["area_cells"] = maps.area_cells;
  counts["area_cells_unseen"] = maps.unseen_area_cells;
  counts["held_places"] = maps.hold.places;
  counts["held_pictures"] = maps.hold.pictures;
  counts["held_released_by_time"] = maps.hold.released_by_time;
  counts["held_released_as_ghosts_px"] = maps.hold.released_as_ghosts_px;
  counts["occupancy_iterations_mean"] = maps.mean_iterations;
  counts["occupancy_frames_not_converged"] = maps.frames_not_converged;
  counts["paths"] = result.report.linking.linking.paths;
  counts["linking_cost"] = result.report.linking.linking.cost;
  counts["appearances"] = result.report.identity.appearances;
  counts["meetings"] = result.report.identity.meetings;
  counts["exchanges"] = result.report.identity.exchanges.size();
  counts["tracks"] = result.tracks.size();
  std::size_t positions = 0;
  for (const Track& track : result.tracks) positions += track.points.size();
  counts["positions"] = positions;

  json["person"] = JsonOf(maps.person, scene);

  Json& cameras = json["background"] = Json::object();
  for (std::size_t i = 0; i < maps.background.size(); ++i) {
    // Cameras that deliver masks learn no background.
    if (maps.background[i].frames > 0) cameras[scene.cameras[i].name] = JsonOf(maps.background[i]);
  }

  Json& stages = json["stages"];
  stages["rehearsal"] = Json{{"seconds", maps.rehearsal_secs}};
  stages["read"] = StageJson(maps.read_secs, maps.frames);
  stages["background"] = StageJson(maps.background_secs, maps.frames);
  stages["occupancy"] = StageJson(maps.occupancy_secs, maps.frames);
  stages["hold"] = StageJson(maps.hold_secs, maps.frames);
  stages["idle"] = Json{{"seconds", maps.idle_secs}};
  stages["maps"] = StageJson(maps.wall_secs, maps.frames);
  stages["linking"] = StageJson(result.report.linking.linking.seconds, maps.frames);
  stages["identity"] = StageJson(result.report.identity.seconds, maps.frames);
  stages["total"] = StageJson(result.report.total_secs, maps.frames);
  return json;
}

}  // namespace vantage
