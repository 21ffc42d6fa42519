// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "command.h"
#include "extension_rows.h"
#include "occupancy_explain.h"
#include "scene_flags.h"
#include "scene_masks.h"
#include "vantage/base/file.h"
#include "vantage/identity/appearance_file.h"
#include "vantage/occupancy/map_file.h"
#include "vantage/occupancy/pom_run.h"
#include "vantage/pipeline/summary.h"

namespace vantage::app {
namespace {

struct Flags {
  SceneFlags scene;
  std::filesystem::path masks;
  std::filesystem::path pom;
  std::filesystem::path output;
  std::filesystem::path explain;
  FrameIndex frame = -1;  // -1: the first
};

void PrintSceneReport(const Flags& flags, const Scene& scene, const MapsResult& result,
                      const Explanation* explanation, bool as_json) {
  const MapsReport& report = result.report;
  const double seconds = report.wall_secs;
  if (as_json) {
    nlohmann::ordered_json json = {{"frames", report.frames},
                                   {"cameras", scene.cameras.size()},
                                   {"cells", result.maps.grid.count()},
                                   {"person", JsonOf(report.person, scene)},
                                   {"iterations_mean", report.mean_iterations},
                                   {"not_converged", report.frames_not_converged},
                                   {"pictures_missing", report.pictures_missing},
                                   {"area_cells", report.area_cells},
                                   {"area_cells_unseen", report.unseen_area_cells},
                                   {"extension", JsonOf(report.extension, scene)},
                                   {"seconds", seconds}};
    if (!flags.output.empty()) json["maps"] = flags.output.string();
    if (explanation != nullptr) {
      nlohmann::ordered_json& explained = json["explained"];
      explained = {{"folder", flags.explain.string()}, {"frame", explanation->frame()}};
      explained["peaks"] = nlohmann::ordered_json::array();
      for (const Peak& peak : explanation->peaks()) {
        explained["peaks"].push_back({{"x", peak.position_m.x()},
                                      {"y", peak.position_m.y()},
                                      {"probability", peak.probability}});
      }
    }
    fmt::print("{}\n", json.dump(2));
    return;
  }
  std::vector<ReportRow> rows = {
      {"frames", fmt::to_string(report.frames)},
      {"cameras", fmt::to_string(scene.cameras.size())},
      {"cells", fmt::format("{} x {} of {} m", result.maps.grid.columns, result.maps.grid.rows,
                            result.maps.grid.cell_m)}};
  const std::vector<ReportRow> extension = ExtensionRows(report.extension, scene);
  rows.insert(rows.end(), extension.begin(), extension.end());
  rows.push_back(
      {"area unseen", fmt::format("{} of {} cells", report.unseen_area_cells, report.area_cells)});
  rows.push_back({"person", TextOf(report.person)});
  if (report.pictures_missing > 0) {
    rows.push_back({"pictures missing", fmt::to_string(report.pictures_missing)});
  }
  rows.push_back({"iterations", fmt::format("{:.1f} per frame", report.mean_iterations)});
  rows.push_back({"frames not converged", fmt::to_string(report.frames_not_converged)});
  rows.push_back({"seconds", fmt::format("{:.2f}", seconds)});
  if (!flags.output.empty()) rows.push_back({"maps", flags.output.string()});
  if (explanation != nullptr) {
    rows.push_back({"explained", fmt::format("{}: frame {}, {} found", flags.explain.string(),
                                             explanation->frame(), explanation->peaks().size())});
  }
  PrintTable(rows);
}

/// `vantage occupancy SCENE.toml -o maps.h5 --explain DIR`: maps of the scene's own pictures or of
/// ready masks, and pictures that explain them.
Status RunScene(const Flags& flags, const CommonFlags& common) {
  VANTAGE_ASSIGN_OR_RETURN(SceneSetup setup, flags.scene.Load());
  Scene& scene = setup.scene;
  if (!flags.masks.empty()) VANTAGE_RETURN_IF_ERROR(UseMasks(scene, flags.masks));
  std::optional<StagedFile> maps;
  if (!flags.output.empty()) {
    VANTAGE_ASSIGN_OR_RETURN(maps, StagedFile::Create(flags.output));
  }
  std::optional<Explanation> explanation;
  MaskSink sink;
  if (!flags.explain.empty()) {
    VANTAGE_ASSIGN_OR_RETURN(
        explanation, Explanation::Create(scene, flags.explain,
                                         flags.frame < 0 ? scene.first_frame : flags.frame));
    sink = explanation->Sink();
    // Nothing that comes later changes what is explained.
    if (!maps) scene.frame_count = explanation->frame() + 1 - scene.first_frame;
  }
  VANTAGE_ASSIGN_OR_RETURN(const MapsResult result,
                           ComputeMaps(scene, setup.options, common.threads,
                                       MakeRunControl(common, "occupancy", "frames"), sink));
  if (maps) {
    VANTAGE_RETURN_IF_ERROR(WriteMaps(maps->temporary(), result.maps));
    VANTAGE_RETURN_IF_ERROR(AddAppearances(maps->temporary(), result.appearances));
  }
  if (explanation) {
    VANTAGE_RETURN_IF_ERROR(explanation->Finish(setup, result, common.threads));
  }
  if (maps) VANTAGE_RETURN_IF_ERROR(maps->Commit());
  PrintSceneReport(flags, scene, result, explanation ? &*explanation : nullptr, common.json);
  return {};
}

/// `vantage occupancy --pom FILE.pom`: the original POM program's job.
Status RunPomFile(const Flags& flags, const CommonFlags& common) {
  VANTAGE_ASSIGN_OR_RETURN(const PomFile file, ReadPomFile(flags.pom));
  VANTAGE_ASSIGN_OR_RETURN(
      const PomReport report,
      RunPom(file, flags.output, common.threads, MakeRunControl(common, "occupancy", "frames")));
  const std::size_t cameras = file.views.size();
  const std::size_t cells = file.views.front().rectangles.size();
  const std::string first_result =
      file.ResultPath(file.frames.front().first, flags.output).string();
  if (common.json) {
    const nlohmann::ordered_json json = {{"frames", report.frames},
                                         {"cameras", cameras},
                                         {"cells", cells},
                                         {"iterations", report.iterations},
                                         {"not_converged", report.not_converged},
                                         {"seconds", report.seconds},
                                         {"first_result", first_result}};
    fmt::print("{}\n", json.dump(2));
    return {};
  }
  PrintTable({{"frames", fmt::format("{}", report.frames)},
              {"cameras", fmt::format("{}", cameras)},
              {"cells", fmt::format("{}", cells)},
              {"iterations", fmt::format("{}", report.iterations)},
              {"frames not converged", fmt::format("{}", report.not_converged)},
              {"seconds", fmt::format("{:.2f}", report.seconds)},
              {"first result", first_result}});
  return {};
}

}  // namespace

Command OccupancyCommand() {
  return {.name = "occupancy",
          .summary = "Maps of where people stand, from the cameras' masks",
          .define = [](CLI::App& app) -> Action {
            const auto flags = std::make_shared<Flags>();
            CLI::Option* scene = flags->scene.DefineForOccupancy(app);
            CLI::Option* masks =
                app.add_option(
                       "--masks", flags->masks,
                       "Folder of ready masks, MASKS/CAMERA/000000.png ... or masks.mkv, by "
                       "the scene's frames, to use in place of the cameras' own sources")
                    ->type_name("DIR")
                    ->needs(scene);
            app.add_option("--pom", flags->pom,
                           "Configuration of the original POM program, in place of a scene; its "
                           "pictures are read and its result files written, relative to its folder")
                ->type_name("FILE")
                ->excludes(scene)
                ->excludes(masks);
            app.add_option("-o,--output", flags->output,
                           "The maps to write, HDF5; with --pom the folder that its result files "
                           "are relative to instead")
                ->type_name("PATH");
            CLI::Option* explain =
                app.add_option("--explain", flags->explain,
                               "Folder for pictures that explain the maps: area, extension, cells "
                               "and what each camera sees of them, on the plan of the ground and "
                               "in the cameras' views, and the map of one frame; must not hold "
                               "anything yet; without -o nothing but that is made")
                    ->type_name("DIR")
                    ->needs(scene);
            app.add_option("--frame", flags->frame,
                           "The frame of --explain; default: the scene's first. Cameras that "
                           "deliver pictures need a few seconds before it to learn a background")
                ->check(CLI::Range(FrameIndex{0}, FrameIndex{1'000'000'000}))
                ->needs(explain);
            app.parse_complete_callback([flags] {
              if (!flags->pom.empty()) return;
              if (!flags->scene.given()) throw CLI::RequiredError("A scene file or --pom");
              if (flags->output.empty() && flags->explain.empty()) {
                throw CLI::RequiredError("--output or --explain");
              }
            });
            return [flags](const CommonFlags& common) {
              return flags->pom.empty() ? RunScene(*flags, common) : RunPomFile(*flags, common);
            };
          }};
}

}  // namespace vantage::app
