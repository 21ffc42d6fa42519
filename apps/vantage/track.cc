// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "command.h"
#include "extension_rows.h"
#include "identity_rows.h"
#include "scene_flags.h"
#include "scene_masks.h"
#include "vantage/background/report.h"
#include "vantage/base/file.h"
#include "vantage/identity/appearance_file.h"
#include "vantage/occupancy/map_file.h"
#include "vantage/pipeline/summary.h"
#include "vantage/pipeline/track.h"
#include "vantage/tracks/track_file.h"

namespace vantage::app {
namespace {

struct Flags {
  SceneFlags scene;
  std::string output;
  bool save_maps = false;
  bool save_masks = false;
};

void PrintReport(const Scene& scene, const TrackingResult& result) {
  const MapsReport& maps = result.report.maps;
  const auto rate = [&](double seconds) {
    return seconds > 0 ? fmt::format("{:.2f} s  ({:.0f} frames/s)", seconds,
                                     static_cast<double>(maps.frames) / seconds)
                       : std::string("-");
  };
  std::size_t positions = 0;
  std::size_t inferred = 0;
  for (const Track& track : result.tracks) {
    positions += track.points.size();
    for (const TrackPoint& point : track.points) inferred += point.inferred ? 1 : 0;
  }
  std::vector<ReportRow> rows = {
      {"scene", scene.name},
      {"cameras", fmt::to_string(scene.cameras.size())},
      {"frames", fmt::format("{}  ({:.1f} s at {} per second)", maps.frames,
                             static_cast<double>(maps.frames) / scene.frames_per_second,
                             scene.frames_per_second)},
      {"grid", fmt::format("{} x {} cells of {} m", result.maps.grid.columns, result.maps.grid.rows,
                           result.maps.grid.cell_m)},
      {"area", fmt::format("{:.1f} m^2", scene.area.area_m2())},
      {"person", TextOf(maps.person)},
  };
  const std::vector<ReportRow> extension = ExtensionRows(maps.extension, scene);
  rows.insert(rows.end(), extension.begin(), extension.end());
  if (maps.unseen_area_cells > 0) {
    rows.push_back({"unseen", fmt::format("{:.1f} % of the area is seen by no camera",
                                          100.0 * static_cast<double>(maps.unseen_area_cells) /
                                              static_cast<double>(maps.area_cells))});
  }
  rows.push_back({"tracks", fmt::to_string(result.tracks.size())});
  rows.push_back({"positions",
                  fmt::format("{}  ({} inferred), {:.1f} people per frame", positions, inferred,
                              static_cast<double>(positions) / static_cast<double>(maps.frames))});
  if (maps.hold.places > 0) {
    rows.push_back({"held", fmt::format("{} places where people stood; {} released by time, {} px "
                                        "as ghosts",
                                        maps.hold.places, maps.hold.released_by_time,
                                        maps.hold.released_as_ghosts_px)});
  }
  const std::vector<ReportRow> identity = IdentityRows(result.report.identity);
  rows.insert(rows.end(), identity.begin(), identity.end());
  for (std::size_t i = 0; i < maps.background.size(); ++i) {
    for (const DisturbanceEvent& event : maps.background[i].disturbances.events) {
      rows.push_back({"disturbance", fmt::format("{}: {}", scene.cameras[i].name,
                                                 TextOf(event, scene.first_frame))});
    }
  }
  // Stages that overlap: the time of all threads together.
  const auto busy = [](double seconds) { return fmt::format("{:.2f} s of all threads", seconds); };
  rows.push_back({"reading", busy(maps.read_secs)});
  rows.push_back({"background", busy(maps.background_secs)});
  rows.push_back({"occupancy", busy(maps.occupancy_secs)});
  rows.push_back({"idle", busy(maps.idle_secs)});
  if (maps.rehearsal_secs > 0) {
    rows.push_back({"rehearsal", fmt::format("{:.2f} s", maps.rehearsal_secs)});
  }
  rows.push_back({"maps", rate(maps.wall_secs)});
  rows.push_back({"linking", rate(result.report.linking.linking.seconds)});
  const double recorded_secs = static_cast<double>(maps.frames) / scene.frames_per_second;
  rows.push_back({"total", fmt::format("{}, {:.2f} x real time", rate(result.report.total_secs),
                                       recorded_secs / result.report.total_secs)});
  PrintTable(rows);
}

Status Run(const Flags& flags, const CommonFlags& common) {
  VANTAGE_ASSIGN_OR_RETURN(const SceneSetup setup, flags.scene.Load());
  const std::filesystem::path output = flags.output;
  // All outputs are staged first: an unwritable folder fails now, not after minutes of work, and
  // the files appear together at the end.
  std::vector<StagedFile> staged;
  for (const char* name : {"tracks.csv", "summary.json", "maps.h5"}) {
    VANTAGE_ASSIGN_OR_RETURN(StagedFile file, StagedFile::Create(output / name));
    staged.push_back(std::move(file));
  }
  if (!flags.save_maps) staged.pop_back();
  std::optional<SceneMaskWriter> masks;
  MaskSink sink;
  if (flags.save_masks) {
    VANTAGE_ASSIGN_OR_RETURN(masks, SceneMaskWriter::Create(setup.scene, output / "masks"));
    sink = [&](FrameIndex frame, const std::vector<cv::Mat>& images) {
      return masks->Write(frame, images);
    };
  }

  VANTAGE_ASSIGN_OR_RETURN(const TrackingResult result,
                           TrackPeople(setup.scene, setup.options, common.threads,
                                       MakeRunControl(common, "track", "frames"), sink));
  // Absolute, so that `vantage render` finds them from wherever it is run.
  const auto absolute = [](const std::filesystem::path& path) {
    return path.empty() ? path : std::filesystem::absolute(path).lexically_normal();
  };
  const RunRequest request{.arguments = common.arguments,
                           .scene = absolute(setup.scene.file),
                           .data = absolute(setup.data),
                           .threads = common.threads};
  VANTAGE_ASSIGN_OR_RETURN(const nlohmann::ordered_json summary,
                           Summarize(request, setup.scene, setup.options, result));

  VANTAGE_RETURN_IF_ERROR(
      WriteTracks(staged[0].temporary(), result.tracks, setup.scene.frames_per_second));
  VANTAGE_RETURN_IF_ERROR(WriteTextFile(staged[1].temporary(), summary.dump(2) + "\n"));
  if (flags.save_maps) {
    VANTAGE_RETURN_IF_ERROR(WriteMaps(staged[2].temporary(), result.maps));
    VANTAGE_RETURN_IF_ERROR(AddAppearances(staged[2].temporary(), result.appearances));
  }
  if (masks) VANTAGE_RETURN_IF_ERROR(masks->Finish());
  for (StagedFile& file : staged) VANTAGE_RETURN_IF_ERROR(file.Commit());
  if (common.json) {
    fmt::print("{}\n", summary.dump(2));
  } else {
    PrintReport(setup.scene, result);
  }
  return {};
}

}  // namespace

Command TrackCommand() {
  return {"track", "The whole way: from the cameras of a scene to tracks on the ground",
          [](CLI::App& app) -> Action {
            auto flags = std::make_shared<Flags>();
            flags->scene.DefineForTracking(app)->required();
            app.add_option("-o,--output", flags->output,
                           "Folder for tracks.csv, summary.json and what else is asked for")
                ->required();
            app.add_flag("--save-maps", flags->save_maps,
                         "Also write the occupancy maps with people's colours, maps.h5");
            app.add_flag("--save-masks", flags->save_masks,
                         "Also write the masks, masks/CAMERA/000000.png ...");
            return [flags](const CommonFlags& common) { return Run(*flags, common); };
          }};
}

}  // namespace vantage::app
