// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/ghosts_cell.h"

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "vantage/experiments/ghost_experiment.h"
#include "vantage/experiments/ghost_findings.h"
#include "vantage/experiments/ghost_report.h"
#include "vantage/experiments/recordings.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The rules that the page's table has, all at the default colour, rate and alpha.
std::vector<std::string> ShownVariants() {
  return {"none", "fep-plain", DefaultVariantName(), "mog2", "knn"};
}

/// Of a quick study the two short sequences.
std::vector<GhostCase> CasesOf(const Study& study) {
  std::vector<GhostCase> cases = StandardGhostCases();
  if (study.quick) {
    std::erase_if(cases, [](const GhostCase& one) { return *one.sequence.begin() != "sbi"; });
  }
  return cases;
}

Result<Json> RunGhosts(const Study& study, const CellRun& cell) {
  VANTAGE_ASSIGN_OR_RETURN(const GhostResults results,
                           RunGhostExperiment(study.data, CasesOf(study), StandardGhostVariants(),
                                              cell.threads, cell.control));
  VANTAGE_RETURN_IF_ERROR(WriteGhostReport(results, cell.product));
  const MixtureOptions defaults;
  Json json = {{"f1", Json::object()}, {"findings", Json::array()}};
  for (const GhostCaseResult& in : results.cases) {
    for (const std::string& variant : ShownVariants()) {
      const GhostRun* run =
          results.Find(in, variant, defaults.color, defaults.rate, defaults.alpha);
      if (run != nullptr) json["f1"][in.used.name][variant] = run->measures.f1;
    }
  }
  for (const GhostFinding& finding : GhostFindings(results)) {
    json["findings"].push_back(
        {{"thesis", finding.thesis}, {"here", finding.here}, {"holds", finding.holds}});
  }
  return json;
}

Status ReportGhosts(const Json& result, const std::string& folder, ReportPage& page,
                    ExperimentReport& report) {
  page.Paragraph(fmt::format(
      "F1 of the masks at the default colour, rate and alpha, on real sequences of CDnet and SBI. "
      "Every criterion in both colour spaces at both rates, with charts, is in {}/ghosts.html "
      "beside this page.",
      folder));
  PageTable table{.header = {"sequence"}};
  const std::vector<std::string> variants = ShownVariants();
  table.header.insert(table.header.end(), variants.begin(), variants.end());
  for (const auto& [name, row] : result.at("f1").items()) {
    std::vector<std::string>& cells = table.rows.emplace_back(std::vector<std::string>{name});
    for (const std::string& variant : variants) {
      const bool known = row.contains(variant) && row[variant].is_number();
      const double f1 = known ? row[variant].get<double>() : std::nan("");
      cells.push_back(known ? fmt::format("{:.4f}", f1) : "-");
      report.figures.push_back({.row = variant, .measure = "f1", .value = f1, .data = name});
    }
  }
  page.Table(table);
  for (const Json& one : result.at("findings")) {
    report.findings.push_back(
        {.thesis = one.at("thesis").get<std::string>(),
         .here = one.at("here").get<std::string>(),
         .verdict = one.at("holds").get<bool>() ? Verdict::kHolds : Verdict::kDoesNotHold});
  }
  return {};
}

Result<ExperimentPlan> PlanGhosts(const Study& study) {
  ExperimentPlan plan;
  plan.report = [](const CellResults&, ReportPage& page, ExperimentReport&) -> Status {
    page.Paragraph("Not run: none of its sequences is there.");
    return {};
  };
  Json inputs = {{"sequences", Json::object()}};
  std::set<std::string> missing;
  for (const GhostCase& one : CasesOf(study)) {
    const fs::path folder = study.data / one.sequence;
    std::error_code code;
    if (study.data.empty() || !fs::is_directory(folder, code)) {
      missing.insert(one.sequence.string());
    } else {
      VANTAGE_ASSIGN_OR_RETURN(inputs["sequences"][one.sequence.string()], DescribeData(folder));
    }
  }
  for (const std::string& sequence : missing) {
    plan.skipped.push_back(sequence + " is not in the data folder (--data)");
  }
  if (inputs["sequences"].empty()) return plan;
  RecordOptions(BackgroundOptions(), inputs["defaults"]);
  const std::string name = study.quick ? "ghosts-quick" : "ghosts";
  plan.cells.push_back(std::make_shared<const Cell>(
      Cell{.name = name,
           .inputs = std::move(inputs),
           .product = name,
           .alone = true,
           .run = [study](const CellRun& cell) { return RunGhosts(study, cell); }}));
  plan.report = [name](const CellResults& results, ReportPage& page, ExperimentReport& report) {
    return ReportGhosts(results.at(name), name, page, report);
  };
  return plan;
}

}  // namespace

Experiment GhostsExperiment() {
  return {.name = "ghosts",
          .title = "Ghost detection on labelled sequences",
          .summary =
              "Every ghost criterion in both colour spaces at both learning rates, beside "
              "OpenCV's MOG2 and KNN; real sequences only",
          .also = {},
          .plan = &PlanGhosts};
}

}  // namespace vantage
