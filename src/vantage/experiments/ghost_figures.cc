// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "vantage/experiments/chart.h"
#include "vantage/experiments/ghost_report.h"
#include "vantage/experiments/ghost_settings.h"
#include "vantage/metrics/mask_measures.h"

namespace vantage {
namespace {

/// Cases that are put together in one set of bars.
struct Group {
  std::string data;  ///< real, simulated or both
  std::vector<const GhostCaseResult*> cases;
};

std::vector<Group> GroupsOf(const GhostResults& results, int figure) {
  std::vector<Group> groups;
  for (const GhostCaseResult& in : results.cases) {
    if (!in.used.figures.contains(figure)) continue;
    const std::string data = figure == 11 ? "real and simulated" : in.used.Origin();
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const Group& one) { return one.data == data; });
    if (group == groups.end()) group = groups.insert(groups.end(), {data, {}});
    group->cases.push_back(&in);
  }
  return groups;
}

/// Mean of each measure over the cases; nothing where a case has no such run.
MaskMeasures MeanOfCases(const GhostResults& results, const Group& group, const std::string& rule,
                         const GhostSetting& setting, double alpha) {
  std::vector<MaskMeasures> measures;
  for (const GhostCaseResult* in : group.cases) {
    const GhostRun* run = results.Find(*in, rule, setting.color, setting.rate, alpha);
    if (run != nullptr) measures.push_back(run->measures);
  }
  return MeanOf(measures);
}

std::string NamesOf(const Group& group) {
  std::string names;
  for (const GhostCaseResult* in : group.cases) {
    names += fmt::format("{}{} ({}, {} frames)", names.empty() ? "" : ", ", in->used.name,
                         in->used.Origin(), in->runs.front().frames.size());
  }
  return names;
}

void AddGroup(const GhostResults& results, const Group& group, int figure, double alpha, bool plain,
              ReportPage& page, std::vector<Figure>& figures) {
  // In the thesis's order, then those that it left out after figure 5, then the rival.
  std::vector<std::pair<std::string, std::string>> rules = {{"noGD", "none"}};
  for (const char* rule : {"fep", "nb", "cb", "fer", "epd"}) {
    rules.emplace_back(rule, std::string(rule) + (plain ? "-plain" : ""));
  }
  rules.emplace_back("standing", "standing");
  const std::string judgement = plain ? "plain judgement, the thesis's" : "our judgement";

  std::vector<BarChart> charts;
  PageTable table{.header = {"rule"},
                  .caption = fmt::format("Figure {}, {} data, {}: R recall, P precision, means "
                                         "over {}",
                                         figure, group.data, judgement, NamesOf(group))};
  for (const GhostMeasure& measure : kGhostMeasures) {
    BarChart& chart = charts.emplace_back(
        BarChart{.title = fmt::format("{}, {}, {}", measure.name, group.data, judgement)});
    for (const GhostSetting& setting : kGhostSettings) {
      chart.series.push_back({.name = setting.name});
    }
    for (const auto& [title, name] : rules) chart.groups.push_back(title);
  }
  for (const GhostSetting& setting : kGhostSettings) {
    for (const char* column : {"R", "P", "F1"}) {
      table.header.push_back(fmt::format("{} {}", setting.name, column));
    }
  }
  for (const auto& [title, name] : rules) {
    std::vector<std::string>& row = table.rows.emplace_back(std::vector<std::string>{title});
    for (std::size_t s = 0; s < kGhostSettings.size(); ++s) {
      const MaskMeasures mean = MeanOfCases(results, group, name, kGhostSettings[s], alpha);
      for (std::size_t m = 0; m < kGhostMeasures.size(); ++m) {
        const double value = mean.*kGhostMeasures[m].value;
        charts[m].series[s].values.push_back(value);
        figures.push_back({.row = fmt::format("{} {} {}", name, kGhostSettings[s].name, group.data),
                           .measure = kGhostMeasures[m].key,
                           .value = value,
                           .data = NamesOf(group),
                           .simulated = group.data != "real"});
        row.push_back(std::isnan(value) ? "-" : fmt::format("{:.3f}", value));
      }
    }
  }
  std::vector<std::string> drawn;
  for (const BarChart& chart : charts) drawn.push_back(ToSvg(chart));
  page.Figure(drawn, fmt::format("Figure {} here, {} data: {}; {}; alpha {}. M: modified, O: "
                                 "original learning rate. standing: whatever stands still for a "
                                 "second is a ghost (the rival of 3.2).",
                                 figure, group.data, NamesOf(group), judgement, alpha));
  page.Table(table);
}

}  // namespace

void AddGhostFigure(const GhostResults& results, int figure, ReportPage& page,
                    std::vector<Figure>& figures) {
  const std::vector<Group> groups = GroupsOf(results, figure);
  if (groups.empty()) page.Paragraph("Nothing to show: none of its sequences is at hand.");
  for (const Group& group : groups) {
    for (const bool plain : {true, false}) {
      AddGroup(results, group, figure, MixtureOptions().alpha, plain, page, figures);
    }
  }
}

}  // namespace vantage
