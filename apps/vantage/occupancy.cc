// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "extension_rows.h"
#include "scene_flags.h"
#include "scene_masks.h"
#include "vantage/base/file.h"
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
};

/// `vantage occupancy SCENE.toml -o maps.h5`: maps of the scene's own pictures or of ready masks.
Status RunScene(const Flags& flags, const CommonFlags& common) {
  VANTAGE_ASSIGN_OR_RETURN(SceneSetup setup, flags.scene.Load());
  if (!flags.masks.empty()) VANTAGE_RETURN_IF_ERROR(UseMasks(setup.scene, flags.masks));
  VANTAGE_ASSIGN_OR_RETURN(StagedFile staged, StagedFile::Create(flags.output));
  VANTAGE_ASSIGN_OR_RETURN(const MapsResult result,
                           ComputeMaps(setup.scene, setup.options, common.threads,
                                       MakeRunControl(common, "occupancy", "frames")));
  VANTAGE_RETURN_IF_ERROR(WriteMaps(staged.temporary(), result.maps));
  VANTAGE_RETURN_IF_ERROR(staged.Commit());
  const MapsReport& report = result.report;
  const double seconds = report.read_secs + report.background_secs + report.occupancy_secs;
  if (common.json) {
    const nlohmann::ordered_json json = {{"frames", report.frames},
                                         {"cameras", setup.scene.cameras.size()},
                                         {"cells", result.maps.grid.count()},
                                         {"iterations_mean", report.mean_iterations},
                                         {"not_converged", report.frames_not_converged},
                                         {"area_cells", report.area_cells},
                                         {"area_cells_unseen", report.unseen_area_cells},
                                         {"extension", JsonOf(report.extension, setup.scene)},
                                         {"seconds", seconds},
                                         {"maps", flags.output.string()}};
    fmt::print("{}\n", json.dump(2));
    return {};
  }
  std::vector<ReportRow> rows = {
      {"frames", fmt::to_string(report.frames)},
      {"cameras", fmt::to_string(setup.scene.cameras.size())},
      {"cells", fmt::format("{} x {} of {} m", result.maps.grid.columns, result.maps.grid.rows,
                            result.maps.grid.cell_m)}};
  const std::vector<ReportRow> extension = ExtensionRows(report.extension, setup.scene);
  rows.insert(rows.end(), extension.begin(), extension.end());
  rows.insert(
      rows.end(),
      {{"area unseen", fmt::format("{} of {} cells", report.unseen_area_cells, report.area_cells)},
       {"iterations", fmt::format("{:.1f} per frame", report.mean_iterations)},
       {"frames not converged", fmt::to_string(report.frames_not_converged)},
       {"seconds", fmt::format("{:.2f}", seconds)},
       {"maps", flags.output.string()}});
  PrintTable(rows);
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
            app.parse_complete_callback([flags] {
              if (!flags->pom.empty()) return;
              if (!flags->scene.given()) throw CLI::RequiredError("A scene file or --pom");
              if (flags->output.empty()) throw CLI::RequiredError("--output");
            });
            return [flags](const CommonFlags& common) {
              return flags->pom.empty() ? RunScene(*flags, common) : RunPomFile(*flags, common);
            };
          }};
}

}  // namespace vantage::app
