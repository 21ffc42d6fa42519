// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "vantage/occupancy/pom_run.h"

namespace vantage::app {
namespace {

struct Flags {
  std::filesystem::path pom;
  std::filesystem::path output;
};

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
            app.add_option("--pom", flags->pom,
                           "Configuration of the original POM program; its pictures are read and "
                           "its result files written, relative to its folder")
                ->type_name("FILE")
                ->required();
            app.add_option("-o,--output", flags->output,
                           "Folder that the result files are relative to instead")
                ->type_name("DIR");
            return [flags](const CommonFlags& common) { return RunPomFile(*flags, common); };
          }};
}

}  // namespace vantage::app
