// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "vantage/background/subtractor.h"
#include "vantage/base/file.h"
#include "vantage/video/mask_writer.h"
#include "vantage/video/open.h"

namespace vantage::app {
namespace {

namespace fs = std::filesystem;

struct Flags {
  fs::path input;
  fs::path output;
  bool force = false;
  OptionFlags options;
};

/// True when `path` is `folder` or lies in it.
bool IsInside(const fs::path& path, const fs::path& folder) {
  std::error_code code;
  const fs::path inner = fs::weakly_canonical(path, code);
  const fs::path outer = fs::weakly_canonical(folder / "", code).parent_path();
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

void PrintReport(const BackgroundReport& report, const BackgroundOptions& options,
                 const Flags& flags, const CommonFlags& common) {
  if (common.json) {
    nlohmann::ordered_json json = {{"input", flags.input.string()},
                                   {"output", flags.output.string()},
                                   {"frames", report.frames},
                                   {"ghosts", report.ghosts},
                                   {"ghosts_px", report.ghosts_px},
                                   {"mixture_seconds", report.mixture_secs},
                                   {"ghost_seconds", report.ghost_secs},
                                   {"cleanup_seconds", report.cleanup_secs}};
    RecordOptions(options, json["options"]);
    fmt::print("{}\n", json.dump(2));
    return;
  }
  PrintTable({{"frames", fmt::format("{}", report.frames)},
              {"ghosts absorbed", fmt::format("{} ({} px)", report.ghosts, report.ghosts_px)},
              {"seconds, mixture", fmt::format("{:.2f}", report.mixture_secs)},
              {"seconds, ghosts", fmt::format("{:.2f}", report.ghost_secs)},
              {"seconds, clean-up", fmt::format("{:.2f}", report.cleanup_secs)},
              {"masks", flags.output.string()}});
}

Status RunBackground(const Flags& flags, const CommonFlags& common) {
  BackgroundOptions options;
  flags.options.ApplyTo(options);
  VANTAGE_RETURN_IF_ERROR(Validate(options));
  if (!flags.output.empty() && IsInside(flags.input, flags.output)) {
    return Fail("{}: the output would replace the input; name another folder",
                flags.output.string());
  }
  VANTAGE_ASSIGN_OR_RETURN(const std::unique_ptr<FrameSource> source, OpenInput(flags.input));
  VANTAGE_ASSIGN_OR_RETURN(BackgroundSubtractor subtractor,
                           BackgroundSubtractor::Create(source->info().size, options));
  VANTAGE_ASSIGN_OR_RETURN(StagedDirectory folder,
                           StagedDirectory::Create(flags.output, flags.force));
  const RunControl control = MakeRunControl(common, "background", "frames");
  const std::int64_t total = source->info().frame_count.value_or(0);
  cv::Mat frame, mask;
  for (FrameIndex index = 0;; ++index) {
    if (control.Stopped()) return Cancelled();
    VANTAGE_ASSIGN_OR_RETURN(const bool more, source->Read(frame));
    if (!more) break;
    VANTAGE_RETURN_IF_ERROR(subtractor.Apply(frame, mask, common.threads));
    VANTAGE_RETURN_IF_ERROR(WriteMask(folder.temporary(), index, mask));
    control.Report(index + 1, total);
  }
  if (subtractor.report().frames == 0) return Fail("{}: holds no frames", flags.input.string());
  VANTAGE_RETURN_IF_ERROR(folder.Commit());
  PrintReport(subtractor.report(), options, flags, common);
  return {};
}

}  // namespace

Command BackgroundCommand() {
  return {.name = "background",
          .summary = "Masks of what moves, from one camera's video or pictures",
          .define = [](CLI::App& app) -> Action {
            const auto flags = std::make_shared<Flags>();
            app.add_option("input", flags->input,
                           "Video, folder of pictures, or pattern as in view1/%06d.png")
                ->type_name("INPUT")
                ->required();
            app.add_option("-o,--output", flags->output,
                           "Folder for the masks, one PNG per frame: 000000.png and on")
                ->type_name("DIR")
                ->required();
            app.add_flag("--force", flags->force, "Replace what the folder holds");
            flags->options = AddOptionFlags(app, BackgroundOptions(), "", "Background");
            return [flags](const CommonFlags& common) { return RunBackground(*flags, common); };
          }};
}

}  // namespace vantage::app
