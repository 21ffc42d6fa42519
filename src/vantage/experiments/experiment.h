// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/experiments/cell.h"
#include "vantage/experiments/report_page.h"
#include "vantage/simulation/recording.h"

/// The thesis's tables and figures as experiments. An experiment says which cells it is made of
/// and, when these are there, puts what they found on a page beside what the thesis found.

namespace vantage {

/// What all experiments of a run share.
struct Study {
  std::filesystem::path output;  ///< the working folder: cells/, data/, masks/ and the reports
  std::filesystem::path data;    ///< folder of the research data; empty: none
  bool quick = false;            ///< few, short and small recordings, to see that all works
  /// At most so many frames of every recording, >= 1.
  std::optional<FrameIndex> frames = std::nullopt;
  bool force = false;  ///< keep no cell
  int threads = 1;
  /// Makes simulated recordings; simulation::RecordScene but in tests.
  std::function<Result<simulation::RecordReport>(const simulation::RecordOptions& options,
                                                 const std::filesystem::path& folder, int threads,
                                                 const RunControl& control)>
      record = {};
};

/// One figure of figures.csv.
struct Figure {
  std::string experiment = {};  ///< set by RunStudy
  std::string row;              ///< the setting
  std::string measure;
  double value = 0;                             ///< NaN: not defined
  std::optional<double> thesis = std::nullopt;  ///< what the thesis has there
  std::string data = {};                        ///< the recording
  bool simulated = false;
};

enum class Verdict { kHolds, kDoesNotHold, kNotDecided };
std::string_view NameOf(Verdict verdict);

/// A sentence of the thesis and what is found here, computed from cells.
struct Finding {
  std::string experiment = {};  ///< set by RunStudy
  std::string thesis;
  std::string here;  ///< with figures
  Verdict verdict = Verdict::kNotDecided;
};

/// What an experiment reports beside its part of the page.
struct ExperimentReport {
  std::vector<Figure> figures = {};  ///< no seconds: the same for every number of threads
  std::vector<Finding> findings = {};
};

struct ExperimentPlan {
  /// Their results are given to `report`; what they need besides is run without being named.
  std::vector<CellPtr> cells = {};
  /// What is left out for want of data, one line each.
  std::vector<std::string> skipped = {};
  /// Fills the experiment's part of the page, whose headings are Subheadings.
  std::function<Status(const CellResults& results, ReportPage& page, ExperimentReport& report)>
      report = {};
};

struct Experiment {
  std::string name;                    ///< as users type it
  std::string title;                   ///< heading of its part of the page
  std::string summary;                 ///< one line for the help, no full stop
  std::vector<std::string> also = {};  ///< other names: figures that are part of it
  /// Opens no recording and runs nothing; looks whether data are there.
  std::function<Result<ExperimentPlan>(const Study& study)> plan;
};

/// All experiments, in the order of the page.
const std::vector<Experiment>& Experiments();

/// Those with these names, each once, in the order of the page; "all" means all of them. Fails on
/// an unknown name, naming those that exist.
Result<std::vector<Experiment>> ChooseExperiments(const std::vector<std::string>& names);

struct StudyReport {
  std::vector<Figure> figures;
  std::vector<Finding> findings;
  std::vector<std::string> skipped;
  std::vector<std::string> notes;  ///< CellsReport::notes
  std::int64_t cells_kept = 0;
  std::int64_t cells_computed = 0;
  std::filesystem::path page, csv;  ///< report.html and figures.csv in the working folder
};

/// Plans the experiments, runs their cells, and writes report.html and figures.csv for these
/// experiments. The working folder is new, empty or one that an earlier run made (it holds
/// reproduce.json); progress counts cells. Fails as RunCells does, on another folder, and when the
/// output lies in the data or the data in the output, and when there is no cell to run at all.
Result<StudyReport> RunStudy(std::span<const Experiment> experiments, const Study& study,
                             const RunControl& control = {});

/// Header and lines of figures.csv.
std::string FiguresCsv(const std::vector<Figure>& figures);

/// Figures, findings and counts.
nlohmann::ordered_json JsonOf(const StudyReport& report);

}  // namespace vantage
