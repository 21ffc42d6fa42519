// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/experiment.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/base/version.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kMarkName = "reproduce.json";

/// Nothing but an earlier run's work may be written over.
Status CheckFolders(const Study& study) {
  const fs::path& folder = study.output;
  if (folder.empty()) return Fail("the name of the output folder is empty");
  if (!study.data.empty()) {
    std::error_code code;
    if (!fs::is_directory(study.data, code)) {
      return Fail("{}: no such folder; --data names the one that holds the research data",
                  study.data.string());
    }
    if (IsInside(folder, study.data) || IsInside(study.data, folder)) {
      return Fail("{}: the output and the data {} must not lie in each other; name another folder",
                  folder.string(), study.data.string());
    }
  }
  std::error_code code;
  const fs::path mark = folder / kMarkName;
  if (fs::exists(folder, code) && !fs::exists(mark, code)) {
    if (!fs::is_directory(folder, code)) {
      return Fail("{}: is a file; name a folder to write", folder.string());
    }
    const bool empty = fs::is_empty(folder, code);
    if (code) return Fail("{}: cannot be read: {}", folder.string(), code.message());
    if (!empty) {
      return Fail(
          "{}: already holds files, and not those of an earlier run; name an empty or new "
          "folder",
          folder.string());
    }
  }
  return {};
}

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string CsvNumber(double value) {
  return std::isfinite(value) ? fmt::format("{:.7g}", value) : "";
}

ReportPage PageOf(const Study& study, const StudyReport& report,
                  const std::vector<ReportPage>& sections) {
  ReportPage page("The thesis's experiments, repeated");
  page.Paragraph(fmt::format(
      "Written by vantage {} (vantage reproduce). Beside each figure stands the thesis's own, from "
      "its own recordings. Here they are real where the text says so and simulated otherwise; "
      "figures of different recordings cannot be compared one by one, their order can.",
      kVersion));
  if (study.quick || study.frames) {
    page.Paragraph(
        "This is a small version: short recordings, few cameras, small pictures, and clean-up of "
        "masks that is reduced with them. It shows that all works; its figures and verdicts mean "
        "little.");
  }
  if (!report.skipped.empty()) {
    page.Paragraph("Not run:");
    page.List(report.skipped);
  }
  if (!report.findings.empty()) {
    page.Heading("What the thesis found, and what is found here");
    PageTable table{.header = {"", "the thesis", "here", "verdict"}, .words = true};
    for (const Finding& finding : report.findings) {
      table.rows.push_back(
          {finding.experiment, finding.thesis, finding.here, std::string(NameOf(finding.verdict))});
    }
    page.Table(table);
  }
  for (const ReportPage& section : sections) page.Append(section);
  return page;
}

}  // namespace

std::string_view NameOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kHolds:
      return "holds";
    case Verdict::kDoesNotHold:
      return "does not hold";
    case Verdict::kNotDecided:
      break;
  }
  return "not decided";
}

Result<std::vector<Experiment>> ChooseExperiments(const std::vector<std::string>& names) {
  std::vector<bool> chosen(Experiments().size(), false);
  for (const std::string& name : names) {
    bool known = name == "all";
    std::string list = "all";
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const Experiment& one = Experiments()[i];
      list += ", " + one.name;
      if (name == "all" || name == one.name || std::ranges::count(one.also, name) > 0) {
        chosen[i] = known = true;
      }
    }
    if (!known) return Fail("{}: no such experiment; there are {}", name, list);
  }
  std::vector<Experiment> experiments;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i]) experiments.push_back(Experiments()[i]);
  }
  if (experiments.empty()) return Fail("no experiment is named; all means all of them");
  return experiments;
}

Result<StudyReport> RunStudy(std::span<const Experiment> experiments, const Study& study,
                             const RunControl& control) {
  if (study.frames && *study.frames < 1)
    return Fail("frames is {}; it must be at least 1", *study.frames);
  VANTAGE_RETURN_IF_ERROR(CheckFolders(study));
  StudyReport report;
  std::vector<ExperimentPlan> plans;
  std::vector<CellPtr> cells;
  for (const Experiment& experiment : experiments) {
    VANTAGE_ASSIGN_OR_RETURN(ExperimentPlan plan, experiment.plan(study));
    cells.insert(cells.end(), plan.cells.begin(), plan.cells.end());
    for (const std::string& skipped : plan.skipped) {
      report.skipped.push_back(experiment.name + ": " + skipped);
    }
    plans.push_back(std::move(plan));
  }
  if (cells.empty()) {
    return Fail("nothing can be run: {}",
                report.skipped.empty() ? "no experiment has cells" : report.skipped.front());
  }
  VANTAGE_RETURN_IF_ERROR(
      WriteTextFile(study.output / kMarkName, Json{{"vantage", kVersion}}.dump() + "\n"));
  VANTAGE_ASSIGN_OR_RETURN(CellsReport done,
                           RunCells(study.output, cells, study.threads, study.force, control));
  std::vector<ReportPage> sections;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    ReportPage& section = sections.emplace_back(experiments[i].title);
    ExperimentReport part;
    try {
      VANTAGE_RETURN_IF_ERROR(plans[i].report(done.results, section, part));
    } catch (const Json::exception& error) {
      // Somebody edited a kept result.
      return Fail("{}: a result of {} cannot be used ({}); run with --force",
                  (study.output / "cells").string(), experiments[i].name, error.what());
    }
    for (Figure& figure : part.figures) {
      figure.experiment = experiments[i].name;
      report.figures.push_back(std::move(figure));
    }
    for (Finding& finding : part.findings) {
      finding.experiment = experiments[i].name;
      report.findings.push_back(std::move(finding));
    }
  }
  report.notes = std::move(done.notes);
  report.cells_kept = done.kept;
  report.cells_computed = done.computed;
  report.page = study.output / "report.html";
  report.csv = study.output / "figures.csv";
  VANTAGE_RETURN_IF_ERROR(WriteTextFile(report.csv, FiguresCsv(report.figures)));
  VANTAGE_RETURN_IF_ERROR(WriteTextFile(report.page, PageOf(study, report, sections).Html()));
  return report;
}

std::string FiguresCsv(const std::vector<Figure>& figures) {
  std::string csv = "experiment,row,measure,value,thesis,data,simulated\n";
  for (const Figure& figure : figures) {
    csv += fmt::format("{},{},{},{},{},{},{}\n", CsvField(figure.experiment), CsvField(figure.row),
                       CsvField(figure.measure), CsvNumber(figure.value),
                       figure.thesis ? CsvNumber(*figure.thesis) : "", CsvField(figure.data),
                       figure.simulated ? 1 : 0);
  }
  return csv;
}

Json JsonOf(const StudyReport& report) {
  Json json = {{"vantage", kVersion},
               {"cells_kept", report.cells_kept},
               {"cells_computed", report.cells_computed},
               {"skipped", report.skipped},
               {"notes", report.notes},
               {"page", report.page.string()},
               {"csv", report.csv.string()},
               {"figures", Json::array()},
               {"findings", Json::array()}};
  for (const Figure& figure : report.figures) {
    json["figures"].push_back({{"experiment", figure.experiment},
                               {"row", figure.row},
                               {"measure", figure.measure},
                               {"value", figure.value},
                               {"thesis", figure.thesis ? Json(*figure.thesis) : Json()},
                               {"data", figure.data},
                               {"simulated", figure.simulated}});
  }
  for (const Finding& finding : report.findings) {
    json["findings"].push_back({{"experiment", finding.experiment},
                                {"thesis", finding.thesis},
                                {"here", finding.here},
                                {"verdict", std::string(NameOf(finding.verdict))}});
  }
  return json;
}

}  // namespace vantage
