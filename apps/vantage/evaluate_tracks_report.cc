// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "evaluate_tracks_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "command.h"
#include "vantage/base/options.h"

namespace vantage::app {
namespace {

Measure Count(const char* name, std::int64_t value, std::string definition) {
  return {name, fmt::to_string(value), value, std::move(definition)};
}

/// NaN, a ratio of nothing, is "-" in the table and null in JSON.
std::string Text(double value) { return std::isnan(value) ? "-" : fmt::format("{:.4f}", value); }

Measure Ratio(const char* name, double value, std::string definition) {
  return {name, Text(value), value, std::move(definition)};
}

double MeanDistance(const ObjectMeasures& object) {
  return object.distance_sum / static_cast<double>(object.matches);  // 0 / 0 is NaN
}

std::string IdText(const std::optional<TrackId>& id) {
  return id ? fmt::to_string(static_cast<std::int64_t>(*id)) : "-";
}

nlohmann::ordered_json IdJson(const std::optional<TrackId>& id) {
  if (!id) return nullptr;
  return static_cast<std::int64_t>(*id);
}

/// What truth and results have in common.
nlohmann::ordered_json ToJson(const ObjectMeasures& object, const char* errors) {
  return {{"id", static_cast<std::int64_t>(object.id)},
          {"first_frame", object.first_frame},
          {"last_frame", object.last_frame},
          {"positions", object.positions},
          {"matches", object.matches},
          {errors, object.positions - object.matches},
          {"partners", object.partners},
          {"motp", MeanDistance(object)},
          {"identity", IdJson(object.identity)},
          {"id_true_positives", object.id_true_positives}};
}

nlohmann::ordered_json TruthJson(const ObjectMeasures& object) {
  nlohmann::ordered_json json = ToJson(object, "misses");
  json["switches"] = object.switches;
  json["fragmentations"] = object.fragmentations;
  json["spans"] = nlohmann::ordered_json::array();
  for (const MatchSpan& span : object.spans) {
    json["spans"].push_back({{"first_frame", span.first_frame},
                             {"last_frame", span.last_frame},
                             {"result", IdJson(span.result)}});
  }
  return json;
}

std::vector<std::string> CommonCells(const ObjectMeasures& object) {
  return {IdText(object.id),
          fmt::to_string(object.first_frame),
          fmt::to_string(object.last_frame),
          fmt::to_string(object.positions),
          fmt::to_string(object.matches),
          fmt::to_string(object.positions - object.matches),
          fmt::to_string(object.partners),
          Text(MeanDistance(object)),
          IdText(object.identity),
          fmt::to_string(object.id_true_positives)};
}

void Print(const char* title, const ObjectTable& table) {
  std::vector<std::size_t> widths(table.header.size(), 0);
  const auto widen = [&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], cells[i].size());
  };
  widen(table.header);
  for (const std::vector<std::string>& row : table.rows) widen(row);
  const auto print = [&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) fmt::print("  {:>{}}", cells[i], widths[i]);
    fmt::print("\n");
  };
  fmt::print("\n{}\n", title);
  print(table.header);
  for (const std::vector<std::string>& row : table.rows) print(row);
}

}  // namespace

std::string MatchRule(const TrackComparison& comparison) {
  return comparison.boxes
             ? fmt::format("boxes that overlap by an IoU of at least {}",
                           comparison.options.min_iou)
             : fmt::format("positions nearer than {} m", comparison.options.threshold_m);
}

std::string AreaText(const TrackComparison& comparison) {
  if (!comparison.area) return "everywhere";
  std::string text = "inside";
  for (const Eigen::Vector2d& corner : comparison.area->corners_m()) {
    text += fmt::format(" ({:.6g}, {:.6g})", corner.x(), corner.y());
  }
  return text + " m";
}

std::vector<Measure> ListMeasures(const TrackComparison& comparison) {
  const TrackMeasures& m = comparison.analysis.measures;
  const bool boxes = comparison.boxes;
  const char* similarity = boxes ? "IoU" : "1 - distance / threshold";
  return {
      Count("frames", m.frames, "that count"),
      Count("truth_tracks", m.truth_tracks, "with a position that counts"),
      Count("result_tracks", m.result_tracks, "with a position that counts"),
      Count("truth_positions", m.truth_positions, "GT"),
      Count("result_positions", m.result_positions, "TP + FP"),
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
            fmt::format("mean {} of the matches, lower is better (CLEAR MOT, py-motmetrics)",
                        boxes ? "1 - IoU" : "distance in metres")),
      Ratio(
          "motp_similarity", m.motp_similarity,
          fmt::format("mean {} of the matches, higher is better: MOTChallenge's MOTP", similarity)),
      Ratio("precision", m.precision, "TP / (TP + FP)"),
      Ratio("recall", m.recall, "TP / GT"),
      Ratio("idf1", m.idf1,
            "2 IDTP / (GT + results); IDTP: matches when each track has one partner for good"),
      Ratio("idp", m.idp, "IDTP / results"),
      Ratio("idr", m.idr, "IDTP / GT"),
      Ratio("moda", m.moda, "1 - (FN + FP) / GT, every frame assigned for itself"),
      Ratio("modp", m.modp, fmt::format("mean {} of these matches, higher is better", similarity)),
      Ratio("hota", m.hota,
            fmt::format("mean of sqrt(DetA AssA) over thresholds 0.05 ... 0.95 on {}",
                        boxes ? "IoU" : "1 - distance / (2 threshold)")),
      Ratio("deta", m.deta, "mean of TP / (TP + FN + FP) over these thresholds"),
      Ratio("assa", m.assa, "mean of TPA / (TPA + FNA + FPA), how far the tracks of a TP agree"),
      Ratio("loca", m.loca, "mean similarity of the TP, over thresholds that have any"),
  };
}

ObjectTable TruthTable(const TrackAnalysis& analysis) {
  ObjectTable table{.header = {"id", "first", "last", "positions", "matches", "misses", "partners",
                               "motp", "identity", "idtp", "switches", "fragmentations"},
                    .rows = {}};
  for (const ObjectMeasures& object : analysis.truth) {
    std::vector<std::string>& row = table.rows.emplace_back(CommonCells(object));
    row.push_back(fmt::to_string(object.switches));
    row.push_back(fmt::to_string(object.fragmentations));
  }
  return table;
}

ObjectTable ResultTable(const TrackAnalysis& analysis) {
  ObjectTable table{.header = {"id", "first", "last", "positions", "matches", "false", "partners",
                               "motp", "identity", "idtp"},
                    .rows = {}};
  for (const ObjectMeasures& object : analysis.results) table.rows.push_back(CommonCells(object));
  return table;
}

std::vector<std::string> ObjectDefinitions(const TrackComparison& comparison) {
  return {
      "first, last: frames, of those that count",
      "partners: tracks of the other file that it was ever matched to",
      fmt::format("motp: mean {} of its matches",
                  comparison.boxes ? "1 - IoU" : "distance in metres"),
      "identity, idtp: the one track of the other file that IDF1 joins it to, if one is left, and "
      "in how many frames they match",
  };
}

void PrintTables(const TrackComparison& comparison, bool per_object) {
  std::vector<ReportRow> rows;
  for (const std::string& warning : comparison.warnings) rows.push_back({"warning", warning});
  for (const std::string& note : comparison.notes) rows.push_back({"note", note});
  rows.push_back({"match", MatchRule(comparison)});
  if (!comparison.boxes) rows.push_back({"area", AreaText(comparison)});
  for (const Measure& measure : ListMeasures(comparison)) {
    rows.push_back({measure.name, fmt::format("{:>8}  {}", measure.text, measure.definition)});
  }
  PrintTable(rows);
  if (!per_object) return;
  Print("tracks of the truth", TruthTable(comparison.analysis));
  Print("tracks of the results", ResultTable(comparison.analysis));
  fmt::print("\n");
  for (const std::string& line : ObjectDefinitions(comparison)) fmt::print("{}\n", line);
}

void PrintJson(const TrackComparison& comparison, bool per_object) {
  nlohmann::ordered_json json = {{"truth", comparison.truth_file.string()},
                                 {"results", comparison.results_file.string()},
                                 {"space", comparison.boxes ? "boxes" : "ground"},
                                 {"options", nlohmann::ordered_json::object()},
                                 {"area_m", nullptr},
                                 {"warnings", comparison.warnings},
                                 {"notes", comparison.notes}};
  RecordOptions(comparison.options, json["options"]);
  if (comparison.area) {
    json["area_m"] = nlohmann::ordered_json::array();
    for (const Eigen::Vector2d& corner : comparison.area->corners_m()) {
      json["area_m"].push_back(nlohmann::ordered_json::array({corner.x(), corner.y()}));
    }
  }
  nlohmann::ordered_json definitions;
  for (const Measure& measure : ListMeasures(comparison)) {
    json[measure.name] = measure.value;
    definitions[measure.name] = measure.definition;
  }
  json["hota_by_threshold"] = nlohmann::ordered_json::array();
  for (const HotaAtThreshold& at : comparison.analysis.hota) {
    json["hota_by_threshold"].push_back({{"alpha", at.alpha},
                                         {"hota", at.hota},
                                         {"deta", at.deta},
                                         {"assa", at.assa},
                                         {"loca", at.loca}});
  }
  json["definitions"] = std::move(definitions);
  if (per_object) {
    json["truth_objects"] = json["result_objects"] = nlohmann::ordered_json::array();
    for (const ObjectMeasures& object : comparison.analysis.truth) {
      json["truth_objects"].push_back(TruthJson(object));
    }
    for (const ObjectMeasures& object : comparison.analysis.results) {
      json["result_objects"].push_back(ToJson(object, "false_positives"));
    }
  }
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

std::string FrameCountsCsv(const TrackComparison& comparison) {
  std::string text = "frame,truth,results,matches,misses,false_positives,switches,motp\n";
  for (const FrameMeasures& frame : comparison.analysis.frames) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},", frame.frame, frame.truth,
                   frame.results, frame.matches, frame.truth - frame.matches,
                   frame.results - frame.matches, frame.switches);
    if (frame.matches > 0) {
      fmt::format_to(std::back_inserter(text), "{:.4f}",
                     frame.distance_sum / static_cast<double>(frame.matches));
    }
    text += '\n';
  }
  return text;
}

}  // namespace vantage::app
