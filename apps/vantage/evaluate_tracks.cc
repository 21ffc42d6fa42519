// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "evaluate_tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "evaluate_tracks_page.h"
#include "evaluate_tracks_report.h"
#include "vantage/base/file.h"
#include "vantage/base/text.h"
#include "vantage/metrics/track_check.h"
#include "vantage/scene/scene.h"
#include "vantage/tracks/track_file.h"

namespace vantage::app {
namespace {

namespace fs = std::filesystem;

struct Flags {
  fs::path truth, results, scene, data, counts_file, page_file;
  std::string area_m;  // X,Y of corners
  bool boxes = false;
  bool per_object = false;
  OptionFlags options;
};

/// X0,Y0,X1,Y1 of a rectangle or X,Y of three corners and more.
Result<Polygon> ParseArea(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string_view field : Fields(text)) {
    if (!ParseNumber(field, numbers.emplace_back())) numbers.clear();
    if (numbers.empty()) break;
  }
  if (numbers.size() < 4 || numbers.size() % 2 != 0) {
    return Fail(
        "--area: '{}' is neither a rectangle X0,Y0,X1,Y1 nor X,Y of three corners or more, in m",
        text);
  }
  std::vector<Eigen::Vector2d> corners;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    corners.emplace_back(numbers[i], numbers[i + 1]);
  }
  Result<Polygon> area = corners.size() == 2 ? Polygon::Rectangle(corners[0].cwiseMin(corners[1]),
                                                                  corners[0].cwiseMax(corners[1]))
                                             : Polygon::Create(std::move(corners));
  if (!area) return Fail("--area: {}", area.error().message);
  return area;
}

Result<std::optional<Polygon>> Area(const Flags& flags) {
  if (!flags.scene.empty()) {
    VANTAGE_ASSIGN_OR_RETURN(const Scene scene, LoadScene(flags.scene, flags.data));
    return scene.area;
  }
  if (flags.area_m.empty()) return std::nullopt;
  VANTAGE_ASSIGN_OR_RETURN(const Polygon area, ParseArea(flags.area_m));
  return area;
}

/// Remarks begin with the file, and the line where one shows it.
void AddRemarks(const std::vector<TrackRemark>& remarks, const TrackLines& truth_lines,
                const TrackLines& result_lines, TrackComparison& comparison) {
  for (const TrackRemark& remark : remarks) {
    const bool of_truth = remark.about == TrackRemark::About::kTruth;
    std::string place = (of_truth ? comparison.truth_file : comparison.results_file).string();
    if (remark.at) {
      const TrackLines& lines = of_truth ? truth_lines : result_lines;
      place += fmt::format(":{}", lines.at(*remark.at));
    }
    (remark.warning ? comparison.warnings : comparison.notes)
        .push_back(fmt::format("{}: {}", place, remark.text));
  }
}

Result<TrackComparison> Compare(const Flags& flags) {
  TrackComparison comparison;
  comparison.truth_file = flags.truth;
  comparison.results_file = flags.results;
  comparison.boxes = flags.boxes;
  flags.options.ApplyTo(comparison.options);
  TrackLines truth_lines, result_lines;
  std::vector<TrackRemark> remarks;
  if (flags.boxes) {
    VANTAGE_ASSIGN_OR_RETURN(const BoxTracks truth, ReadBoxTracks(flags.truth, &truth_lines));
    VANTAGE_ASSIGN_OR_RETURN(const BoxTracks results, ReadBoxTracks(flags.results, &result_lines));
    VANTAGE_ASSIGN_OR_RETURN(comparison.analysis, AnalyzeBoxes(truth, results, comparison.options));
    remarks = CheckBoxes(truth, results, comparison.options, comparison.analysis.measures);
  } else {
    VANTAGE_ASSIGN_OR_RETURN(const Tracks truth, ReadTracks(flags.truth, &truth_lines));
    VANTAGE_ASSIGN_OR_RETURN(const Tracks results, ReadTracks(flags.results, &result_lines));
    VANTAGE_ASSIGN_OR_RETURN(comparison.area, Area(flags));
    VANTAGE_ASSIGN_OR_RETURN(comparison.analysis,
                             AnalyzeTracks(truth, results, comparison.options,
                                           comparison.area ? &*comparison.area : nullptr));
    remarks = CheckTracks(truth, results, comparison.options, comparison.analysis.measures);
  }
  AddRemarks(remarks, truth_lines, result_lines, comparison);
  return comparison;
}

Status CheckOutputs(const Flags& flags) {
  for (const fs::path& output : {flags.counts_file, flags.page_file}) {
    for (const fs::path& input : {flags.truth, flags.results, flags.scene}) {
      std::error_code code;
      if (!output.empty() && fs::equivalent(output, input, code)) {
        return Fail("{}: is read here and cannot be written too; choose another name",
                    output.string());
      }
    }
  }
  if (flags.counts_file.empty() || flags.counts_file != flags.page_file) return {};
  return Fail("{}: is given for --save-counts and --plot; each needs a file of its own",
              flags.page_file.string());
}

Status EvaluateTrackFiles(const Flags& flags, const CommonFlags& common) {
  VANTAGE_RETURN_IF_ERROR(CheckOutputs(flags));
  VANTAGE_ASSIGN_OR_RETURN(const TrackComparison comparison, Compare(flags));
  if (!flags.counts_file.empty()) {
    VANTAGE_RETURN_IF_ERROR(WriteTextFile(flags.counts_file, FrameCountsCsv(comparison)));
  }
  if (!flags.page_file.empty()) {
    VANTAGE_RETURN_IF_ERROR(WriteTextFile(flags.page_file, TrackComparisonPage(comparison)));
  }
  if (common.json) {
    PrintJson(comparison, flags.per_object);
  } else {
    PrintTables(comparison, flags.per_object);
  }
  return {};
}

}  // namespace

Action DefineEvaluateTracks(CLI::App& app) {
  const auto flags = std::make_shared<Flags>();
  app.add_option("--truth", flags->truth, "File of the true tracks")->type_name("FILE")->required();
  app.add_option("results", flags->results, "File of the tracks to measure")
      ->type_name("FILE")
      ->required();
  CLI::Option* area = app.add_option("--area", flags->area_m,
                                     "Only what is inside counts, in truth and results alike: two "
                                     "corners of a rectangle or all of a polygon [m]");
  area->type_name("X,Y,...");
  CLI::Option* scene =
      app.add_option("--scene", flags->scene, "The same: the area of this scene file");
  scene->type_name("FILE")->excludes(area);
  app.add_option("--data", flags->data,
                 "Folder that paths in the scene are relative to; default: the scene's own")
      ->type_name("DIR");
  app.add_flag("--boxes", flags->boxes, "Compare boxes in pictures (MOTChallenge's columns 3 to 6)")
      ->excludes(area)
      ->excludes(scene);
  app.add_flag("--per-object", flags->per_object, "Also what became of every track");
  app.add_option("--save-counts", flags->counts_file, "CSV file for the counts of every frame")
      ->type_name("FILE");
  app.add_option("--plot", flags->page_file,
                 "HTML page with everything: over time, per object, by threshold")
      ->type_name("FILE");
  flags->options = AddOptionFlags(app, EvaluationOptions{}, "", "Evaluation");
  return [flags](const CommonFlags& common) { return EvaluateTrackFiles(*flags, common); };
}

}  // namespace vantage::app
