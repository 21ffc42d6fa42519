// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command.h"
#include "vantage/experiments/experiment.h"

namespace vantage::app {
namespace {

struct Flags {
  std::vector<std::string> names;
  Study study;
  FrameIndex frames = 0;  ///< 0: all
};

std::string ListOfExperiments() {
  std::string list = "Experiments:\n";
  for (const Experiment& one : Experiments()) {
    std::string names = one.name;
    for (const std::string& other : one.also) names += ", " + other;
    list += fmt::format("  {:<28} {}\n", names, one.summary);
  }
  return list + fmt::format("  {:<28} {}\n", "all", "All of them, on one page");
}

void PrintStudy(const StudyReport& report, const CommonFlags& common) {
  if (common.json) {
    fmt::print("{}\n",
               JsonOf(report).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  std::vector<ReportRow> rows = {
      {"cells", fmt::format("{} computed, {} kept", report.cells_computed, report.cells_kept)}};
  for (const Finding& finding : report.findings) {
    rows.push_back({finding.experiment, fmt::format("{}: {} ({})", finding.thesis,
                                                    NameOf(finding.verdict), finding.here)});
  }
  for (const std::string& skipped : report.skipped) rows.push_back({"not run", skipped});
  for (const std::string& note : report.notes) rows.push_back({"note", note});
  rows.push_back({"figures", report.csv.string()});
  rows.push_back({"page", report.page.string()});
  PrintTable(rows);
}

Status Run(const Flags& flags, const CommonFlags& common) {
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<Experiment> experiments,
                           ChooseExperiments(flags.names));
  Study study = flags.study;
  study.threads = common.threads;
  if (flags.frames > 0) study.frames = flags.frames;
  study.record = &simulation::RecordScene;
  VANTAGE_ASSIGN_OR_RETURN(
      const StudyReport report,
      RunStudy(experiments, study, MakeRunControl(common, "reproduce", "cells")));
  PrintStudy(report, common);
  return {};
}

}  // namespace

Command ReproduceCommand() {
  return {.name = "reproduce",
          .summary = "The thesis's experiments on the data at hand, as a page with plots and CSV",
          .define = [](CLI::App& app) -> Action {
            const auto flags = std::make_shared<Flags>();
            app.footer(ListOfExperiments());
            app.add_option("experiment", flags->names, "What to run, one or more of those below")
                ->type_name("NAME")
                ->required();
            app.add_option("-o,--output", flags->study.output,
                           "Working folder: report.html, figures.csv, and what was computed, which "
                           "the next run there keeps")
                ->type_name("DIR")
                ->required();
            app.add_option(
                   "--data", flags->study.data,
                   "Folder of the research data: pets2009/, cdnet/, sbi/; what is absent is "
                   "left out or simulated, and the page says so")
                ->type_name("DIR");
            app.add_flag("--quick", flags->study.quick,
                         "A small version in minutes: few, short and small recordings");
            app.add_option("--frames", flags->frames,
                           "At most so many frames of each recording; 0: all")
                ->check(CLI::Range(0, 1'000'000))
                ->capture_default_str();
            app.add_flag("--force", flags->study.force, "Compute all anew, keeping nothing");
            return [flags](const CommonFlags& common) { return Run(*flags, common); };
          }};
}

}  // namespace vantage::app
