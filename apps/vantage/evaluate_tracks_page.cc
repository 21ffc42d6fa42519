// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "evaluate_tracks_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "vantage/base/version.h"
#include "vantage/experiments/chart.h"
#include "vantage/experiments/report_page.h"

namespace vantage::app {
namespace {

constexpr FrameIndex kMostPoints = 200;   // of a line over time
constexpr std::size_t kMostTracks = 100;  // shown of either file

/// Frames from the one that counts to the next.
FrameIndex StepOf(const std::vector<FrameMeasures>& frames) {
  FrameIndex step = std::numeric_limits<FrameIndex>::max();
  for (std::size_t i = 1; i < frames.size(); ++i) {
    step = std::min(step, frames[i].frame - frames[i - 1].frame);
  }
  return frames.size() < 2 ? 1 : step;
}

/// Means over stretches of equal length, so that a line has at most kMostPoints.
void AddCharts(const TrackComparison& comparison, ReportPage& page) {
  const std::vector<FrameMeasures>& frames = comparison.analysis.frames;
  const FrameIndex step = StepOf(frames);
  const FrameIndex first = frames.front().frame;
  const FrameIndex length = step * ((frames.back().frame - first) / step / kMostPoints + 1);

  LineChart people{.title = "People per frame", .x_label = "frame"};
  people.series = {{.name = "truth"}, {.name = "results"}};
  LineChart errors{.title = "Errors per frame", .x_label = "frame"};
  errors.series = {{.name = "misses"}, {.name = "false positives"}};
  LineChart switches{.title = "Identity switches so far", .x_label = "frame"};
  switches.series = {{.name = "switches"}};
  LineChart distance{.title = comparison.boxes ? "MOTP: mean of 1 - IoU of the matches"
                                               : "MOTP: mean distance of the matches, m",
                     .x_label = "frame"};
  distance.series = {{.name = "motp"}};

  std::int64_t switches_so_far = 0;
  for (std::size_t begin = 0, end = 0; begin < frames.size(); begin = end) {
    const FrameIndex stretch = (frames[begin].frame - first) / length;
    FrameMeasures sum;
    for (; end < frames.size() && (frames[end].frame - first) / length == stretch; ++end) {
      sum.truth += frames[end].truth;
      sum.results += frames[end].results;
      sum.matches += frames[end].matches;
      sum.switches += frames[end].switches;
      sum.distance_sum += frames[end].distance_sum;
    }
    const auto count = static_cast<double>(end - begin);
    const auto x = static_cast<double>(frames[begin].frame + frames[end - 1].frame) / 2;
    const auto add = [x](LineChart& chart, std::size_t series, double value) {
      chart.series[series].points.emplace_back(x, value);
    };
    add(people, 0, static_cast<double>(sum.truth) / count);
    add(people, 1, static_cast<double>(sum.results) / count);
    add(errors, 0, static_cast<double>(sum.truth - sum.matches) / count);
    add(errors, 1, static_cast<double>(sum.results - sum.matches) / count);
    switches_so_far += sum.switches;
    add(switches, 0, static_cast<double>(switches_so_far));
    if (sum.matches > 0) add(distance, 0, sum.distance_sum / static_cast<double>(sum.matches));
  }
  page.Heading("Over time");
  page.Figure({ToSvg(people), ToSvg(errors)}, "Truth and results, misses and false positives.");
  page.Figure({ToSvg(switches), ToSvg(distance)},
              length == step
                  ? "All four: every frame that counts."
                  : fmt::format("All four: a point for every {} frames that count; people, errors "
                                "and distances are means over them.",
                                length / step));

  LineChart hota{.title = "HOTA by threshold", .x_label = "threshold on similarity, %"};
  hota.series = {{.name = "HOTA"}, {.name = "DetA"}, {.name = "AssA"}};
  for (const HotaAtThreshold& at : comparison.analysis.hota) {
    hota.series[0].points.emplace_back(100 * at.alpha, at.hota);
    hota.series[1].points.emplace_back(100 * at.alpha, at.deta);
    hota.series[2].points.emplace_back(100 * at.alpha, at.assa);
  }
  page.Heading("By strictness");
  page.Figure({ToSvg(hota)}, comparison.boxes
                                 ? "Similarity is IoU."
                                 : "Similarity is 1 - distance / (2 threshold): 50 % stands for "
                                   "the threshold, further right is stricter.");
}

/// The tracks to show when there are too many: those with the most wrong, in the order of the file.
std::vector<std::size_t> Worst(const std::vector<ObjectMeasures>& objects) {
  std::vector<std::size_t> order(objects.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  if (order.size() <= kMostTracks) return order;
  const auto wrong = [&](std::size_t i) {
    return objects[i].positions - objects[i].matches + objects[i].switches;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return wrong(a) > wrong(b); });
  order.resize(kMostTracks);
  std::sort(order.begin(), order.end());
  return order;
}

/// One row per true track: bars in the colour of the result it is matched to, a thin line where it
/// is missed, a tick where the match changes.
std::string Timeline(const TrackAnalysis& analysis, const std::vector<std::size_t>& shown) {
  constexpr double kWidth = 1100, kLeft = 60, kRight = kWidth - 10, kTop = 8, kRow = 16;
  constexpr double kLeastMiss = 1.5;
  // From the palette of Okabe and Ito; a number stands beside, where there is room.
  constexpr std::array<const char*, 7> kColors = {"#56b4e9", "#e69f00", "#009e73", "#f0e442",
                                                  "#cc79a7", "#8aa0ff", "#b0b0b0"};
  const auto first = static_cast<double>(analysis.frames.front().frame);
  const FrameIndex step = StepOf(analysis.frames);
  const auto end = static_cast<double>(analysis.frames.back().frame + step);
  const auto at = [&](FrameIndex frame) {
    return kLeft + (static_cast<double>(frame) - first) / (end - first) * (kRight - kLeft);
  };
  std::map<TrackId, std::size_t> color_of;  // neighbours in time differ, as far as colours reach
  const double bottom = kTop + kRow * static_cast<double>(shown.size());
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\" "
      "style=\"max-width: none\" font-family=\"system-ui, sans-serif\" font-size=\"10\" "
      "fill=\"#1a1a1a\">\n",
      kWidth, bottom + 22);
  for (std::size_t row = 0; row < shown.size(); ++row) {
    const ObjectMeasures& object = analysis.truth[shown[row]];
    const auto id = static_cast<std::int64_t>(object.id);
    const double top = kTop + kRow * static_cast<double>(row);
    svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", kLeft - 6,
                       top + 11, id);
    std::optional<TrackId> before;
    std::string misses;  // on top, so that short ones show
    for (const MatchSpan& span : object.spans) {
      const double left = at(span.first_frame);
      const double width = at(span.last_frame + step) - left;
      const std::string frames = fmt::format("frames {} to {}", span.first_frame, span.last_frame);
      if (!span.result) {
        misses += fmt::format(
            "<rect x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"2\" fill=\"#d00000\"><title>"
            "{}, {}: missed</title></rect>\n",
            left, top + 6, std::max(width, kLeastMiss), id, frames);
        continue;
      }
      const auto result = static_cast<std::int64_t>(*span.result);
      const std::size_t color =
          color_of.emplace(*span.result, color_of.size()).first->second % kColors.size();
      svg += fmt::format(
          "<rect x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{}\" fill=\"{}\"><title>{}, "
          "{}: result {}</title></rect>\n",
          left, top + 1, width, kRow - 3, kColors[color], id, frames, result);
      if (width > 26) {
        svg +=
            fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left + 3, top + 11, result);
      }
      if (before && before != span.result) {
        svg += fmt::format(
            "<rect x=\"{:.2f}\" y=\"{:.1f}\" width=\"2\" height=\"{}\" fill=\"#000\"/>\n", left - 1,
            top, kRow - 1);
      }
      before = span.result;
    }
    svg += misses;
  }
  for (const auto& [frame, anchor] : {std::pair{analysis.frames.front().frame, "start"},
                                      std::pair{analysis.frames.back().frame, "end"}}) {
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">frame {}</text>\n",
                       at(frame), bottom + 14, anchor, frame);
  }
  return svg + "</svg>\n";
}

void AddTable(std::string caption, ObjectTable table, const std::vector<std::size_t>& shown,
              ReportPage& page) {
  PageTable part{.header = std::move(table.header), .caption = std::move(caption)};
  if (shown.size() < table.rows.size()) {
    part.caption +=
        fmt::format(", the {} of {} with the most wrong", shown.size(), table.rows.size());
  }
  for (const std::size_t i : shown) part.rows.push_back(std::move(table.rows[i]));
  page.Table(part);
}

void AddObjects(const TrackComparison& comparison, ReportPage& page) {
  const TrackAnalysis& analysis = comparison.analysis;
  const std::vector<std::size_t> truth = Worst(analysis.truth);
  page.Heading("Per object");
  page.Figure({Timeline(analysis, truth)},
              "Every row is a track of the truth with its id. Bars: matched, in the colour and, "
              "where there is room, with the id of the result; thin red: missed; black tick: "
              "matched to another result than before (IDSW); nothing: not there.");
  page.List(ObjectDefinitions(comparison));
  AddTable("Tracks of the truth", TruthTable(analysis), truth, page);
  AddTable("Tracks of the results", ResultTable(analysis), Worst(analysis.results), page);
}

}  // namespace

std::string TrackComparisonPage(const TrackComparison& comparison) {
  ReportPage page(fmt::format("{} against {}", comparison.results_file.filename().string(),
                              comparison.truth_file.filename().string()));
  page.Paragraph(fmt::format(
      "Written by vantage {} (vantage evaluate tracks). Truth: {}. Results: {}. Matches are {}; "
      "what counts is {}{}.",
      kVersion, comparison.truth_file.string(), comparison.results_file.string(),
      MatchRule(comparison), comparison.boxes ? "the whole picture" : AreaText(comparison),
      comparison.options.truth_frames_only ? ", in frames that have truth" : ""));
  std::vector<std::string> remarks;
  for (const std::string& warning : comparison.warnings) remarks.push_back("Warning: " + warning);
  remarks.insert(remarks.end(), comparison.notes.begin(), comparison.notes.end());
  page.List(remarks);
  page.Heading("Figures");
  PageTable table{.header = {"measure", "value", "definition"}, .words = true};
  for (const Measure& measure : ListMeasures(comparison)) {
    table.rows.push_back({measure.name, measure.text, measure.definition});
  }
  page.Table(table);
  AddCharts(comparison, page);
  AddObjects(comparison, page);
  return page.Html();
}

}  // namespace vantage::app
