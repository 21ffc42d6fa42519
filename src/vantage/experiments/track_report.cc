// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/track_report.h"

#include <cmath>
#include <utility>

#include "vantage/experiments/track_cell.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

struct Column {
  const char* name;
  const char* key;
  bool whole;  ///< a count
};
/// Those that the thesis has, in its order, then others.
constexpr Column kOfThesis[] = {{"MOTA", "mota", false},
                                {"MOTP m", "motp", false},
                                {"FN", "fn", true},
                                {"FP", "fp", true},
                                {"IDSW", "idsw", true}};
constexpr Column kOthers[] = {{"IDF1", "idf1", false}, {"HOTA", "hota", false}, {"GT", "gt", true}};

std::string Text(double value, bool whole) {
  if (!std::isfinite(value)) return "-";
  return whole ? fmt::format("{:.0f}", value) : fmt::format("{:.4f}", value);
}

std::optional<double> OfThesis(const std::optional<ThesisTracks>& thesis, const Column& column,
                               const ThesisUnits& units) {
  if (!thesis) return std::nullopt;
  const std::string_view key = column.key;
  if (key == "mota") return thesis->mota;
  if (key == "motp") return units.metres ? std::optional(thesis->motp) : std::nullopt;
  if (!units.counts) return std::nullopt;
  return key == "fn" ? thesis->misses : key == "fp" ? thesis->false_positives : thesis->switches;
}

}  // namespace

void AddTrackTable(const TrackRecording& recording, const std::vector<TrackRow>& rows,
                   const std::string& which, const ThesisUnits& units, ReportPage& page,
                   ExperimentReport& report) {
  const bool sparse = which == "sparse";
  const std::string truth = sparse
                                ? fmt::format("truth at every {}th frame", recording.sparse_truth)
                                : std::string("truth at every frame");
  PageTable table{.header = {"setting"},
                  .caption = fmt::format("{}; {}. Column \"thesis\": its own recording.",
                                         recording.title, truth)};
  for (const Column& column : kOfThesis) {
    table.header.push_back(column.name);
    table.header.emplace_back("thesis");
  }
  for (const Column& column : kOthers) table.header.push_back(column.name);
  for (const TrackRow& row : rows) {
    const Json& measures = row.result.at(which);
    std::vector<std::string>& cells = table.rows.emplace_back(std::vector<std::string>{row.name});
    const auto add = [&](const Column& column, const std::optional<double>& thesis) {
      const double value = NumberAt(measures, column.key);
      cells.push_back(Text(value, column.whole));
      report.figures.push_back({.row = row.name + ", " + truth,
                                .measure = column.key,
                                .value = value,
                                .thesis = thesis,
                                .data = recording.title,
                                .simulated = recording.simulated});
    };
    for (const Column& column : kOfThesis) {
      const std::optional<double> thesis = OfThesis(row.thesis, column, units);
      add(column, thesis);
      cells.push_back(thesis ? Text(*thesis, column.whole) : "");
    }
    for (const Column& column : kOthers) add(column, std::nullopt);
  }
  page.Table(table);
}

double MotaOf(const Json& result) { return NumberAt(result.at("every"), "mota"); }

Verdict VerdictOfGain(double gain) {
  if (gain > kSameMota) return Verdict::kHolds;
  return gain < -kSameMota ? Verdict::kDoesNotHold : Verdict::kNotDecided;
}

Verdict Both(Verdict a, Verdict b) {
  if (a == Verdict::kDoesNotHold || b == Verdict::kDoesNotHold) return Verdict::kDoesNotHold;
  return a == Verdict::kHolds ? b : a;
}

std::string Comparison(double value, double other) {
  return fmt::format("{:.4f} against {:.4f} ({:+.4f})", value, other, value - other);
}

Finding GoalFinding(const TrackRecording& recording, const Json& result, double goal_mota,
                    double thesis_mota) {
  const double mota = MotaOf(result);
  return {.thesis = fmt::format("Its best MOTA is {:.4f}; the defaults here shall reach {:.2f}",
                                thesis_mota, goal_mota),
          .here = fmt::format("{}: MOTA {:.4f}", recording.title, mota),
          .verdict = mota >= goal_mota ? Verdict::kHolds : Verdict::kDoesNotHold};
}

}  // namespace vantage
