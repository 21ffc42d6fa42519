// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "vantage/background/subtractor.h"
#include "vantage/base/file.h"
#include "vantage/rendering/ghost_picture.h"
#include "vantage/video/mask_writer.h"
#include "vantage/video/open.h"

namespace vantage::app {
namespace {

namespace fs = std::filesystem;
constexpr std::int64_t kMaxFrames = std::int64_t{1} << 40;

struct Flags {
  fs::path input;
  fs::path output;
  bool force = false;
  std::string format = "png";          // or "video"
  std::int64_t start = 0;              // frame of the input
  std::optional<std::int64_t> frames;  // none: to the end
  fs::path explain;                    // empty: no pictures
  OptionFlags options;
};

void PrintReport(const BackgroundReport& report, const BackgroundOptions& options,
                 const Flags& flags, const CommonFlags& common) {
  if (common.json) {
    nlohmann::ordered_json json = {{"input", flags.input.string()},
                                   {"output", flags.output.string()}};
    json.update(JsonOf(report));
    RecordOptions(options, json["options"]);
    fmt::print("{}\n", json.dump(2));
    return;
  }
  const auto secs = [](double value) { return fmt::format("{:.2f}", value); };
  std::vector<ReportRow> rows = {
      {"frames", fmt::format("{}", report.frames)},
      {"ghosts absorbed",
       fmt::format("{} px in {} frames", report.ghosts_px, report.ghost_frames)}};
  for (const DisturbanceEvent& event : report.disturbances.events) {
    rows.push_back({"disturbance", TextOf(event, flags.start)});
  }
  rows.push_back({"seconds, method", secs(report.method_secs)});
  rows.push_back({"seconds, disturbances", secs(report.disturbance_secs)});
  if (options.shadows.enabled) rows.push_back({"seconds, shadows", secs(report.shadow_secs)});
  rows.push_back({"seconds, ghosts", secs(report.ghost_secs)});
  rows.push_back({"seconds, clean-up", secs(report.cleanup_secs)});
  rows.push_back({"masks", flags.output.string()});
  PrintTable(rows);
}

/// Frames per second: the input's where it has a usable one.
double RateOf(const SourceInfo& info) {
  const double rate = info.frames_per_second.value_or(0);
  return rate >= 1 && rate <= 200 ? rate : 25;
}

/// 0: not known.
std::int64_t FramesToProcess(const SourceInfo& info, const Flags& flags) {
  if (!info.frame_count) return flags.frames.value_or(0);
  const std::int64_t left = *info.frame_count - flags.start;
  return std::min(left, flags.frames.value_or(left));
}

/// The input is opened for itself once more.
Status RehearseInput(const Flags& flags, const BackgroundOptions& options, int threads,
                     const RunControl& control, BackgroundSubtractor& subtractor) {
  VANTAGE_ASSIGN_OR_RETURN(const std::unique_ptr<FrameSource> source, OpenInput(flags.input));
  const std::int64_t total = FramesToProcess(source->info(), flags);
  VANTAGE_RETURN_IF_ERROR(source->Skip(flags.start));
  const RehearsalPlan plan = PlanRehearsal(
      options.rehearsal, total > 0 ? std::optional(total) : std::nullopt, RateOf(source->info()));
  return Rehearse(subtractor, *source, plan, threads, control);
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
  VANTAGE_ASSIGN_OR_RETURN(
      BackgroundSubtractor subtractor,
      BackgroundSubtractor::Create(source->info().size, options, RateOf(source->info())));
  VANTAGE_ASSIGN_OR_RETURN(
      MaskWriter masks,
      MaskWriter::Create(flags.output,
                         flags.format == "video" ? MaskFormat::kVideo : MaskFormat::kPng,
                         source->info().size, RateOf(source->info()), flags.force));
  std::optional<StagedDirectory> explanations;
  if (!flags.explain.empty()) {
    VANTAGE_ASSIGN_OR_RETURN(explanations, StagedDirectory::Create(flags.explain, flags.force));
  }
  const RunControl control = MakeRunControl(common, "background", "frames");
  VANTAGE_ASSIGN_OR_RETURN(const std::int64_t skipped, source->Skip(flags.start));
  if (skipped < flags.start) {
    return Fail("{}: holds {} frames; --start must be below that", flags.input.string(), skipped);
  }
  const std::int64_t total = FramesToProcess(source->info(), flags);
  VANTAGE_RETURN_IF_ERROR(RehearseInput(flags, options, common.threads, control, subtractor));
  cv::Mat frame, mask;
  for (std::int64_t done = 0; !flags.frames || done < *flags.frames; ++done) {
    if (control.Stopped()) return Cancelled();
    VANTAGE_ASSIGN_OR_RETURN(const bool more, source->Read(frame));
    if (!more) break;
    VANTAGE_RETURN_IF_ERROR(subtractor.Apply(frame, mask, common.threads));
    VANTAGE_RETURN_IF_ERROR(masks.Write(flags.start + done, mask));
    if (explanations) {
      VANTAGE_RETURN_IF_ERROR(
          WritePng(explanations->temporary() / fmt::format("{:06}.png", flags.start + done),
                   DrawGhosts(frame, subtractor.foreground(), subtractor.verdict())));
    }
    control.Report(done + 1, total);
  }
  if (subtractor.report().frames == 0) {
    return Fail("{}: holds no frame from {} on", flags.input.string(), flags.start);
  }
  VANTAGE_RETURN_IF_ERROR(masks.Finish());
  if (explanations) VANTAGE_RETURN_IF_ERROR(explanations->Commit());
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
                           "Video, folder of pictures, pattern as in view1/%06d.png, or folder of "
                           "a change-detection sequence")
                ->type_name("INPUT")
                ->required();
            app.add_option("-o,--output", flags->output,
                           "Folder for the masks: 000000.png for frame 0 of the input and on, or "
                           "masks.mkv")
                ->type_name("DIR")
                ->required();
            app.add_option("--format", flags->format,
                           "One PNG per frame, or one lossless video (masks.mkv, FFV1)")
                ->check(CLI::IsMember({"png", "video"}))
                ->capture_default_str();
            app.add_option("--explain", flags->explain,
                           "Also write, for each frame, a picture of what was judged: objects "
                           "outlined in green, ghosts in orange and, when absorbed, red, with "
                           "the rule's value; in grey what could not be judged")
                ->type_name("DIR");
            app.add_option("--start", flags->start, "First frame of the input to read [frames]")
                ->check(CLI::Range(std::int64_t{0}, kMaxFrames))
                ->type_name("NUMBER")
                ->capture_default_str();
            app.add_option("--frames", flags->frames,
                           "How many frames to read from there; default: to the end [frames]")
                ->check(CLI::Range(std::int64_t{1}, kMaxFrames))
                ->type_name("NUMBER");
            app.add_flag("--force", flags->force, "Replace what the folder holds");
            flags->options = AddOptionFlags(app, BackgroundOptions(), "", "Background");
            return [flags](const CommonFlags& common) { return RunBackground(*flags, common); };
          }};
}

}  // namespace vantage::app
