// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "vantage/experiments/chart.h"
#include "vantage/experiments/ghost_report.h"
#include "vantage/experiments/ghost_settings.h"

namespace vantage {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string Text(double value) { return std::isnan(value) ? "-" : fmt::format("{:.3f}", value); }
std::string Signed(double value) { return std::isnan(value) ? "-" : fmt::format("{:+.3f}", value); }

/// Names of the variants of the mixture, or of OpenCV's methods, each once.
std::vector<std::string> Names(const GhostResults& results, bool peers) {
  std::vector<std::string> names;
  for (const GhostVariant& variant : results.variants) {
    if (variant.IsPeer() != peers) continue;
    if (std::find(names.begin(), names.end(), variant.name) == names.end()) {
      names.push_back(variant.name);
    }
  }
  return names;
}

/// At the default colour and rate.
const GhostRun* FindDefault(const GhostResults& results, const GhostCaseResult& in,
                            const std::string& variant, double alpha) {
  const MixtureOptions defaults;
  return results.Find(in, variant, defaults.color, defaults.rate, alpha);
}

double F1Of(const GhostRun* run) { return run == nullptr ? kNan : run->measures.f1; }

std::string ShareOfPeak(const GhostCaseResult& in, const GhostRun& run, const GhostRun& of) {
  const auto at_check = run.FalsePositivesAt(*in.used.check);
  if (!at_check) return "-";
  const std::int64_t peak = std::max<std::int64_t>(of.Peak().counts.false_positives, 1);
  return fmt::format("{:.1f} %",
                     100.0 * static_cast<double>(*at_check) / static_cast<double>(peak));
}

void AddSideBySide(const GhostResults& results, ReportPage& page) {
  const double alpha = MixtureOptions().alpha;
  page.Subheading("Side by side, all at their defaults");
  page.Paragraph(fmt::format(
      "F1. Ours: the mixture with the default options of this version (ghosts by {}, alpha {}). "
      "mog2 and knn: OpenCV's, bare, as they come; what they call shadow is background. "
      "mog2-ghosts and knn-ghosts: the same with our disturbances, ghost detection and clean-up "
      "around them. KNN calls its whole first frame foreground, which counts where the truth "
      "begins "
      "there (IBMtest2).",
      DefaultVariantName(), alpha));
  const std::vector<std::string> peers = Names(results, true);
  PageTable table{.header = {"sequence", "data", "ours", "ours without ghosts"}};
  BarChart chart{.title = "F1 at defaults", .series = {{.name = "ours"}}};
  for (const std::string& peer : peers) {
    table.header.push_back(peer);
    chart.series.push_back({.name = peer});
  }
  std::vector<std::string> below;
  for (const GhostCaseResult& in : results.cases) {
    const double ours = F1Of(FindDefault(results, in, DefaultVariantName(), alpha));
    std::vector<std::string>& row = table.rows.emplace_back(
        std::vector<std::string>{in.used.name, in.used.Origin(), Text(ours),
                                 Text(F1Of(FindDefault(results, in, "none", alpha)))});
    chart.groups.push_back(in.used.name);
    chart.series[0].values.push_back(ours);
    for (std::size_t i = 0; i < peers.size(); ++i) {
      const double f1 = F1Of(FindDefault(results, in, peers[i], alpha));
      row.push_back(Text(f1));
      chart.series[i + 1].values.push_back(f1);
      if (ours < f1 && !peers[i].ends_with("-ghosts")) {
        below.push_back(
            fmt::format("{}: {} against {} of {}", in.used.name, Text(ours), Text(f1), peers[i]));
      }
    }
  }
  page.Table(table);
  page.Paragraph(below.empty() ? "Ours is below a bare method of OpenCV's on no sequence."
                               : "Ours is below a bare method of OpenCV's here:");
  page.List(below);
  page.Figure({ToSvg(chart)}, "Ours beside OpenCV's methods, bare and with our stage around them.");
}

void AddEffect(const GhostResults& results, ReportPage& page) {
  page.Subheading("What ghost detection does, at the default colour and rate");
  page.Paragraph(
      "Without ghost detection, with FEP in the thesis's plain form, and with the default. "
      "Differences are to no detection. False foreground at the check is given in percent of the "
      "default's own peak, and of the peak without detection.");
  PageTable table{.header = {"sequence", "alpha", "ghost", "F1 none", "F1 plain", "F1 default",
                             "F1 gain, plain", "F1 gain, default", "recall gain, plain",
                             "recall gain, default", "false at check, of own peak",
                             "false at check, of peak of none"}};
  for (const GhostCaseResult& in : results.cases) {
    for (const double alpha : AlphasOf(results)) {
      const GhostRun* none = FindDefault(results, in, "none", alpha);
      const GhostRun* plain = FindDefault(results, in, "fep-plain", alpha);
      const GhostRun* ours = FindDefault(results, in, DefaultVariantName(), alpha);
      if (none == nullptr || plain == nullptr || ours == nullptr) continue;
      table.rows.push_back({in.used.name, fmt::to_string(alpha), in.used.ghost ? "yes" : "no",
                            Text(none->measures.f1), Text(plain->measures.f1),
                            Text(ours->measures.f1), Signed(plain->measures.f1 - none->measures.f1),
                            Signed(ours->measures.f1 - none->measures.f1),
                            Signed(plain->measures.recall - none->measures.recall),
                            Signed(ours->measures.recall - none->measures.recall),
                            in.used.check ? ShareOfPeak(in, *ours, *ours) : "",
                            in.used.check ? ShareOfPeak(in, *ours, *none) : ""});
    }
  }
  page.Table(table);
}

void AddLines(const GhostResults& results, const GhostCaseResult& in, ReportPage& page) {
  std::vector<std::string> charts;
  for (const double alpha : AlphasOf(results)) {
    LineChart chart{.title = fmt::format("False foreground pixels per frame, alpha {}", alpha),
                    .x_label = "frame"};
    for (const auto& [variant, name] :
         {std::pair<std::string, std::string>{DefaultVariantName(), "default"},
          {"fep-plain", "plain FEP"},
          {"none", "none"}}) {
      const GhostRun* run = FindDefault(results, in, variant, alpha);
      if (run == nullptr) continue;
      LineSeries& line = chart.series.emplace_back(LineSeries{.name = name});
      for (const auto& [frame, counts] : run->frames) {
        line.points.emplace_back(frame, counts.false_positives);
      }
    }
    if (in.used.check) chart.marks.emplace_back(*in.used.check, "check");
    charts.push_back(ToSvg(chart));
  }
  page.Figure(charts, "At the default colour and rate.");
}

void AddTable(const GhostResults& results, const GhostCaseResult& in, double alpha,
              ReportPage& page) {
  PageTable table{
      .header = {"rule"},
      .caption = fmt::format("{}, alpha {}: R recall, P precision{}", in.used.name, alpha,
                             in.used.check ? ", FP false pixels at the check" : "")};
  for (const GhostSetting& setting : kGhostSettings) {
    for (const char* column : {"R", "P", "F1"}) {
      table.header.push_back(fmt::format("{} {}", setting.name, column));
    }
    if (in.used.check) table.header.push_back(fmt::format("{} FP", setting.name));
  }
  for (const std::string& name : Names(results, false)) {
    std::vector<std::string>& row = table.rows.emplace_back(std::vector<std::string>{name});
    for (const GhostSetting& setting : kGhostSettings) {
      const GhostRun* run = results.Find(in, name, setting.color, setting.rate, alpha);
      for (const GhostMeasure& measure : kGhostMeasures) {
        row.push_back(run == nullptr ? "-" : Text(run->measures.*measure.value));
      }
      if (!in.used.check) continue;
      const auto at_check = run == nullptr ? std::nullopt : run->FalsePositivesAt(*in.used.check);
      row.push_back(at_check ? fmt::to_string(*at_check) : "-");
    }
  }
  page.Table(table);
}

std::string PlaceOf(const GhostCase& one) {
  return one.Simulated() ? fmt::format("preset {}, camera {}", one.preset, one.camera + 1)
                         : one.sequence.generic_string();
}

void AddCase(const GhostResults& results, const GhostCaseResult& in, ReportPage& page) {
  const std::vector<MaskFrameCounts>& frames = in.runs.front().frames;
  page.Subheading(fmt::format("{} ({})", in.used.name, in.used.Origin()));
  page.Paragraph(in.used.note);
  std::vector<std::string> facts = {
      fmt::format("{}: {}, {} x {} px; the methods see it from frame {} on, {} frames",
                  in.used.Origin(), PlaceOf(in.used), in.size.width, in.size.height,
                  in.used.span.begin, in.frames_shown),
      fmt::format("{} frames count, from {} to {}: those with truth, in the sequence's own "
                  "temporal range{}",
                  frames.size(), frames.front().frame, frames.back().frame,
                  in.used.span.first > 0 || in.used.span.last != FrameSpan().last
                      ? fmt::format(", and in {} to {}", in.used.span.first, in.used.span.last)
                      : ""),
      in.roi ? "pixels outside its region of interest, and with the labels 85 and 170, do not count"
             : "it has no region of interest that can be used; pixels with the labels 85 and 170 "
               "do not count"};
  facts.insert(facts.end(), in.notes.begin(), in.notes.end());
  page.List(facts);
  if (in.used.ghost) AddLines(results, in, page);
  for (const double alpha : AlphasOf(results)) AddTable(results, in, alpha, page);
}

void AddSeconds(const GhostResults& results, ReportPage& page) {
  page.Subheading("Time");
  page.Paragraph(
      "Milliseconds per frame of the whole background stage, wall-clock, mean over the runs of "
      "each "
      "rule; every run is in ghosts.csv. Several cells may have run at once, so that these are "
      "above what one alone needs; OpenCV's methods use threads of their own.");
  PageTable table{.header = {"rule"}};
  for (const GhostCaseResult& in : results.cases) table.header.push_back(in.used.name);
  std::vector<std::string> names = Names(results, false);
  const std::vector<std::string> peers = Names(results, true);
  names.insert(names.end(), peers.begin(), peers.end());
  for (const std::string& name : names) {
    std::vector<std::string>& row = table.rows.emplace_back(std::vector<std::string>{name});
    for (const GhostCaseResult& in : results.cases) {
      double sum_secs = 0;
      int runs = 0;
      for (std::size_t i = 0; i < in.runs.size(); ++i) {
        if (results.variants[i].name != name) continue;
        sum_secs += in.runs[i].secs_per_frame;
        ++runs;
      }
      row.push_back(fmt::format("{:.2f}", 1e3 * sum_secs / runs));
    }
  }
  page.Table(table);
}

void AddDefaults(ReportPage& page) {
  page.Subheading("Defaults");
  page.Paragraph(
      "Options of the background stage that every run used where the tables say nothing "
      "else.");
  nlohmann::ordered_json options;
  RecordOptions(BackgroundOptions(), options);
  PageTable table{.header = {"option", "value"}, .words = true};
  for (const auto& [name, value] : options.items()) {
    table.rows.push_back({name, value.is_string() ? value.get<std::string>() : value.dump()});
  }
  page.Table(table);
}

}  // namespace

void AddGhostDetails(const GhostResults& results, ReportPage& page) {
  if (results.cases.empty()) return;
  AddSideBySide(results, page);
  AddEffect(results, page);
  for (const GhostCaseResult& in : results.cases) AddCase(results, in, page);
  AddSeconds(results, page);
  AddDefaults(page);
}

}  // namespace vantage
