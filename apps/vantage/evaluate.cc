// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "evaluate_masks.h"
#include "vantage/metrics/clear_mot.h"
#include "vantage/metrics/track_check.h"
#include "vantage/scene/scene.h"
#include "vantage/tracks/track_file.h"

namespace vantage::app {
namespace {

struct Flags {
  std::filesystem::path truth, results, scene, data;
  std::vector<double> area_m;  // x0 y0 x1 y1
  bool boxes = false;
  OptionFlags options;
};

struct Measure {
  const char* name;
  std::string text;
  nlohmann::ordered_json value;
  const char* definition;
};

Measure Count(const char* name, std::int64_t value, const char* definition) {
  return {name, fmt::to_string(value), value, definition};
}

/// NaN, a ratio of nothing, is "-" in the table and null in JSON.
Measure Ratio(const char* name, double value, const char* definition) {
  return {name, std::isnan(value) ? "-" : fmt::format("{:.4f}", value), value, definition};
}

std::vector<Measure> List(const TrackMeasures& m, bool boxes) {
  return {
      Count("frames", m.frames, "that count"),
      Count("truth_tracks", m.truth_tracks, "with a position that counts"),
      Count("result_tracks", m.result_tracks, "with a position that counts"),
      Count("truth_positions", m.truth_positions, "GT"),
      Count("result_positions", m.result_positions, ""),
      Count("matches", m.matches, "TP"),
      Count("misses", m.misses, "FN, truth without a match"),
      Count("false_positives", m.false_positives, "FP, results without a match"),
      Count("switches", m.switches, "IDSW, matched to another result than the last time"),
      Count("fragmentations", m.fragmentations, "times a truth track is lost and found again"),
      Count("mostly_tracked", m.mostly_tracked, "truth tracks matched in at least 80 % of frames"),
      Count("partially_tracked", m.partially_tracked, "the others"),
      Count("mostly_lost", m.mostly_lost, "in less than 20 %"),
      Ratio("mota", m.mota, "1 - (FN + FP + IDSW) / GT"),
      Ratio("motp", m.motp,
            boxes ? "mean of 1 - IoU of the matches, lower is better"
                  : "mean distance of the matches in metres, lower is better"),
      Ratio("precision", m.precision, "TP / (TP + FP)"),
      Ratio("recall", m.recall, "TP / GT"),
      Ratio("idf1", m.idf1, "2 IDTP / (GT + results)"),
      Ratio("idp", m.idp, "IDTP / results"),
      Ratio("idr", m.idr, "IDTP / GT"),
      Ratio("moda", m.moda, "1 - (FN + FP) / GT, every frame assigned for itself"),
      Ratio("modp", m.modp,
            boxes ? "mean IoU of these matches"
                  : "mean of 1 - distance / threshold of these matches"),
  };
}

Result<std::optional<Polygon>> Area(const Flags& flags) {
  if (!flags.scene.empty()) {
    VANTAGE_ASSIGN_OR_RETURN(const Scene scene, LoadScene(flags.scene, flags.data));
    return scene.area;
  }
  if (flags.area_m.empty()) return std::nullopt;
  const auto [x_min, x_max] = std::minmax(flags.area_m[0], flags.area_m[2]);
  const auto [y_min, y_max] = std::minmax(flags.area_m[1], flags.area_m[3]);
  return Polygon::Rectangle({x_min, y_min}, {x_max, y_max});
}

/// What looks like a mistake rather than like bad tracking; empty: nothing does.
std::string Warning(const Tracks& truth, const Tracks& results, const TrackMeasures& measures) {
  if (measures.matches > 0 || results.empty()) return "";
  const double scale = ScaleOfResults(truth, results);
  if (scale > 10 || scale < 0.1) {
    return fmt::format(
        "nothing matches, and coordinates of the results are {:.3g} times those of the truth: are "
        "both in metres?",
        scale);
  }
  if (measures.result_positions == 0) return "no result is in the area in a frame that counts";
  return "nothing matches: are both in the same coordinates?";
}

Status Print(const TrackMeasures& measures, const std::string& warning, bool boxes, bool as_json) {
  const std::vector<Measure> list = List(measures, boxes);
  if (as_json) {
    nlohmann::ordered_json json;
    for (const Measure& measure : list) json[measure.name] = measure.value;
    if (!warning.empty()) json["warning"] = warning;
    fmt::print("{}\n", json.dump(2));
    return {};
  }
  std::vector<ReportRow> rows;
  if (!warning.empty()) rows.push_back({"warning", warning});
  for (const Measure& measure : list) {
    rows.push_back({measure.name, fmt::format("{:>8}  {}", measure.text, measure.definition)});
  }
  PrintTable(rows);
  return {};
}

Status EvaluateTrackFiles(const Flags& flags, const CommonFlags& common) {
  EvaluationOptions options;
  flags.options.ApplyTo(options);
  if (flags.boxes) {
    VANTAGE_ASSIGN_OR_RETURN(const BoxTracks truth, ReadBoxTracks(flags.truth));
    VANTAGE_ASSIGN_OR_RETURN(const BoxTracks results, ReadBoxTracks(flags.results));
    VANTAGE_ASSIGN_OR_RETURN(const TrackMeasures measures, EvaluateBoxes(truth, results, options));
    return Print(measures, "", true, common.json);
  }
  VANTAGE_ASSIGN_OR_RETURN(const Tracks truth, ReadTracks(flags.truth));
  VANTAGE_ASSIGN_OR_RETURN(const Tracks results, ReadTracks(flags.results));
  VANTAGE_ASSIGN_OR_RETURN(const std::optional<Polygon> area, Area(flags));
  VANTAGE_ASSIGN_OR_RETURN(const TrackMeasures measures,
                           EvaluateTracks(truth, results, options, area ? &*area : nullptr));
  return Print(measures, Warning(truth, results, measures), false, common.json);
}

}  // namespace

Command EvaluateCommand() {
  return {
      .name = "evaluate",
      .summary = "Measure results against the truth",
      .define = [](CLI::App& app) -> Action {
        const auto flags = std::make_shared<Flags>();
        app.require_subcommand(1);
        CLI::App* tracks = app.add_subcommand(
            "tracks",
            "CLEAR MOT, identity and detection measures. Both files are Vantage's CSV or "
            "MOTChallenge's text; frames of the latter, counted from 1, are lowered by one");
        tracks->fallthrough();  // the flags that every command has
        tracks->add_option("--truth", flags->truth, "File of the true tracks")
            ->type_name("FILE")
            ->required();
        tracks->add_option("results", flags->results, "File of the tracks to measure")
            ->type_name("FILE")
            ->required();
        CLI::Option* area = tracks->add_option("--area", flags->area_m,
                                               "Only what is inside counts, in truth and results "
                                               "alike: the rectangle X0,Y0,X1,Y1 in m");
        area->delimiter(',')->expected(4)->type_name("X0,Y0,X1,Y1");
        CLI::Option* scene =
            tracks->add_option("--scene", flags->scene, "The same: the area of this scene file");
        scene->type_name("FILE")->excludes(area);
        tracks
            ->add_option("--data", flags->data,
                         "Folder that paths in the scene are relative to; default: the scene's own")
            ->type_name("DIR");
        CLI::Option* boxes = tracks->add_flag(
            "--boxes", flags->boxes, "Compare boxes in pictures (MOTChallenge's columns 3 to 6)");
        boxes->excludes(area)->excludes(scene);
        flags->options = AddOptionFlags(*tracks, EvaluationOptions{}, "", "Evaluation");
        CLI::App* masks = app.add_subcommand(
            "masks", "Masks of what moves against labelled truth: the change-detection measures");
        masks->fallthrough();
        const Action evaluate_masks = DefineEvaluateMasks(*masks);
        return [flags, masks, evaluate_masks](const CommonFlags& common) {
          return masks->parsed() ? evaluate_masks(common) : EvaluateTrackFiles(*flags, common);
        };
      }};
}

}  // namespace vantage::app
