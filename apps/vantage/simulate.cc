// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command.h"
#include "vantage/base/file.h"
#include "vantage/simulation/recording.h"

namespace vantage::app {
namespace {

struct Flags {
  simulation::RecordOptions record;
  FrameIndex frames = 0;
  int cameras = 0;
  std::vector<std::string> faults;
  bool no_masks = false;
  std::filesystem::path output;
  bool force = false;
};

void PrintReport(const simulation::RecordReport& report, const Flags& flags, bool as_json) {
  const auto shots = static_cast<double>(report.film.shots);
  const double traced = report.film.pixels > 0 ? report.film.pixels_traced / report.film.pixels : 0;
  const double rate = report.total_secs > 0 ? shots / report.total_secs : 0;
  if (as_json) {
    const nlohmann::ordered_json json = {{"scene", (flags.output / "scene.toml").string()},
                                         {"frames", report.frames},
                                         {"cameras", report.cameras},
                                         {"people", report.people},
                                         {"pictures_per_second", rate},
                                         {"share_traced", traced},
                                         {"setup_seconds", report.film.setup_secs},
                                         {"trace_seconds", report.film.trace_secs},
                                         {"encode_seconds", report.encode_secs},
                                         {"seconds", report.total_secs}};
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  PrintTable(
      {{"scene", (flags.output / "scene.toml").string()},
       {"cameras", fmt::to_string(report.cameras)},
       {"frames", fmt::to_string(report.frames)},
       {"people", fmt::to_string(report.people)},
       {"traced", fmt::format("{:.1f} % of the pixels; the rest had not changed", 100 * traced)},
       {"setup", fmt::format("{:.2f} s", report.film.setup_secs)},
       {"tracing", fmt::format("{:.2f} s", report.film.trace_secs)},
       {"encoding", fmt::format("{:.2f} s", report.encode_secs)},
       {"total", fmt::format("{:.2f} s  ({:.1f} pictures/s)", report.total_secs, rate)}});
}

Status Run(const Flags& flags, const CommonFlags& common) {
  simulation::RecordOptions options = flags.record;
  if (flags.frames > 0) options.stage.frames = flags.frames;
  if (flags.cameras > 0) options.stage.cameras = flags.cameras;
  options.masks = !flags.no_masks;
  for (const std::string& text : flags.faults) {
    VANTAGE_ASSIGN_OR_RETURN(const simulation::CameraFault fault,
                             simulation::ParseCameraFault(text));
    options.faults.push_back(fault);
  }
  VANTAGE_ASSIGN_OR_RETURN(StagedDirectory folder,
                           StagedDirectory::Create(flags.output, flags.force));
  VANTAGE_ASSIGN_OR_RETURN(const simulation::RecordReport report,
                           simulation::RecordScene(options, folder.temporary(), common.threads,
                                                   MakeRunControl(common, "simulate", "frames")));
  VANTAGE_RETURN_IF_ERROR(folder.Commit());
  PrintReport(report, flags, common.json);
  return {};
}

}  // namespace

Command SimulateCommand() {
  return {
      "simulate",
      "A recording of an invented scene with its truth: videos, calibration, tracks, boxes, masks",
      [](CLI::App& app) -> Action {
        const auto flags = std::make_shared<Flags>();
        std::vector<std::string> names;
        std::string presets = "What to film:";
        for (const simulation::Preset& preset : simulation::Presets()) {
          names.emplace_back(preset.name);
          presets += fmt::format("\n{}: {}", preset.name, preset.summary);
        }
        app.add_option("preset", flags->record.preset, presets)
            ->check(CLI::IsMember(names))
            ->required();
        app.add_option("-o,--output", flags->output, "Folder for scene.toml, the videos and truth/")
            ->type_name("DIR")
            ->required();
        app.add_flag("--force", flags->force, "Replace what the folder holds");
        app.add_option("--seed", flags->record.stage.seed,
                       "Another seed is another recording of the same kind; the same seed is the "
                       "same recording")
            ->capture_default_str();
        app.add_option("--frames", flags->frames, "Frames; default: the preset's")
            ->check(CLI::Range(1, 100000));
        app.add_option("--cameras", flags->cameras, "The first so many cameras; default: all")
            ->check(CLI::Range(1, 64));
        app.add_option("--scale", flags->record.stage.scale,
                       "Size of the pictures, as a factor of the preset's width and height")
            ->check(CLI::Range(0.1, 2.0))
            ->capture_default_str();
        app.add_option("--people", flags->record.stage.people,
                       "Truth of the real recording, whose people walk here instead of invented "
                       "ones: campus a MOTChallenge file with metres in columns 8 and 9, crowd the "
                       "folder with annotations_positions")
            ->type_name("PATH");
        app.add_flag("--no-masks", flags->no_masks, "Leave out the true masks");
        app.add_option("--fault", flags->faults,
                       "Something wrong with a camera, from 1; may be given several times: "
                       "drop, freeze or black:CAMERA:FIRST:COUNT (frames), or "
                       "drift:CAMERA:FIRST:FRAMES (frames a second)")
            ->type_name("TEXT");
        return [flags](const CommonFlags& common) { return Run(*flags, common); };
      }};
}

}  // namespace vantage::app
