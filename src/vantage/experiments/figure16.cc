// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/figure16.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vantage/experiments/chart.h"
#include "vantage/experiments/track_cell.h"
#include "vantage/experiments/track_report.h"

namespace vantage {
namespace {

/// From the thesis's least to its largest, metres.
std::vector<double> CellSizes(const Study& study) {
  if (study.quick) return {0.3, 0.5, 1, 3};
  return {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1, 1.25, 1.5, 2, 2.5, 3};
}

/// A larger cell that costs no more MOTA than this is taken as the compromise.
constexpr double kWorthIt = 0.01;

struct Sweep {
  TrackRecording recording;
  std::vector<double> sizes_m;
  std::vector<CellPtr> cells = {};
};

/// The thesis's size, one of every sweep.
std::size_t ThesisOf(const Sweep& sweep) {
  return static_cast<std::size_t>(std::ranges::find(sweep.sizes_m, 0.5) - sweep.sizes_m.begin());
}

/// MOTA, MOTP and time over the size; the thesis has MOTA over MOTP, sizes as colours.
void AddCharts(const Sweep& sweep, const std::vector<TrackRow>& rows, ReportPage& page) {
  std::vector<std::string> charts;
  const std::vector<std::pair<double, std::string>> marks = {{GridOptions().cell_m, "default"}};
  const auto chart = [&](const char* title, const auto& value) {
    LineChart lines{.title = title, .x_label = "cell, m", .series = {}, .marks = marks};
    lines.x_step = 0.5;
    LineSeries& series = lines.series.emplace_back(LineSeries{.name = "here"});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double y = value(rows[i].result);
      if (std::isfinite(y)) series.points.emplace_back(sweep.sizes_m[i], std::max(0.0, y));
    }
    charts.push_back(ToSvg(lines));
  };
  chart("MOTA", [](const auto& result) { return MotaOf(result); });
  chart("MOTP, m (smaller is better)",
        [](const auto& result) { return NumberAt(result.at("every"), "motp"); });
  chart("Seconds of occupancy and linking, one thread", [](const auto& result) {
    const auto& seconds = result.at("seconds");
    return NumberAt(seconds, "occupancy") + NumberAt(seconds, "linking");
  });
  page.Figure(charts,
              "Overall tracking performance over the size of a cell, as the thesis's figure 16.");
}

Status Report(const Sweep& sweep, const CellResults& results, ReportPage& page,
              ExperimentReport& report) {
  page.Paragraph(
      "Masks are the defaults', the same for all sizes; all else is at the defaults, but that "
      "nobody is held in the foreground and nobody told apart by colours. The thesis shows its "
      "figures as a picture only and takes 0.5 m.");
  std::vector<TrackRow> rows;
  for (std::size_t i = 0; i < sweep.cells.size(); ++i) {
    rows.push_back({.name = fmt::format("{} m", sweep.sizes_m[i]),
                    .result = results.at(sweep.cells[i]->name)});
  }
  AddCharts(sweep, rows, page);
  AddTrackTable(sweep.recording, rows, "every", {}, page, report);
  AddTrackTable(sweep.recording, rows, "sparse", {}, page, report);

  const auto mota = [&](std::size_t i) { return MotaOf(rows[i].result); };
  std::size_t best = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (mota(i) > mota(best)) best = i;
  }
  std::size_t largest = best;
  for (std::size_t i = best; i < rows.size(); ++i) {
    if (mota(i) >= mota(best) - kWorthIt) largest = i;
  }
  const std::size_t used = ThesisOf(sweep);
  report.findings.push_back(
      {.thesis = "A cell of 0.5 m is a good compromise between 0.3 and 3 m",
       .here = fmt::format(
           "{}: MOTA {:.4f} at {} m, the best {:.4f} at {} m; the largest cell within {} of it: {} "
           "m",
           sweep.recording.title, mota(used), sweep.sizes_m[used], mota(best), sweep.sizes_m[best],
           kWorthIt, sweep.sizes_m[largest]),
       .verdict = !(mota(best) > 0)                         ? Verdict::kNotDecided
                  : mota(used) >= mota(best) - 2 * kWorthIt ? Verdict::kHolds
                                                            : Verdict::kDoesNotHold});
  return {};
}

Result<ExperimentPlan> Plan(const Study& study) {
  ExperimentPlan plan;
  VANTAGE_ASSIGN_OR_RETURN(TrackRecording recording, FloorballRecording(study));
  Sweep sweep{.recording = std::move(recording), .sizes_m = CellSizes(study)};
  const StageOptions defaults = PlainOptionsFor(sweep.recording);
  const CellPtr masks = MasksCell(sweep.recording, "defaults", defaults.background);
  for (const double cell_m : sweep.sizes_m) {
    sweep.cells.push_back(TrackCell(
        sweep.recording,
        {.name = fmt::format("cell-{}", cell_m), .options = defaults, .cell_m = cell_m}, masks));
  }
  plan.cells = sweep.cells;
  plan.report = [sweep = std::move(sweep)](const CellResults& results, ReportPage& page,
                                           ExperimentReport& report) {
    return Report(sweep, results, page, report);
  };
  return plan;
}

}  // namespace

Experiment Figure16Experiment() {
  return {.name = "fig16",
          .title = "Figure 16: the size of a cell",
          .summary = "Tracks of floorball with cells of 0.3 to 3 m",
          .also = {},
          .plan = &Plan};
}

}  // namespace vantage
