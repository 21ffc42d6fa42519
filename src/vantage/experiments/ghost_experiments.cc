// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/experiments/default_masks.h"
#include "vantage/experiments/ghost_cells.h"
#include "vantage/experiments/ghost_findings.h"
#include "vantage/experiments/ghost_report.h"
#include "vantage/experiments/mask_recordings.h"
#include "vantage/scene/scene.h"
#include "vantage/simulation/presets.h"
#include "vantage/video/open.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Result<ExperimentPlan> PlanFigure(const Study& study, int figure) {
  VANTAGE_ASSIGN_OR_RETURN(GhostPlan ghosts, PlanGhosts(study, [figure](const GhostCase& one) {
                             return one.figures.contains(figure);
                           }));
  ExperimentPlan plan{.cells = ghosts.cells, .skipped = ghosts.skipped, .report = {}};
  plan.report = [ghosts = std::move(ghosts), figure](const CellResults& cells, ReportPage& page,
                                                     ExperimentReport& report) -> Status {
    VANTAGE_ASSIGN_OR_RETURN(const GhostResults results, GhostResultsOf(ghosts, cells));
    AddGhostFigure(results, figure, page, report.figures);
    report.findings = GhostFindings(results, figure);
    return {};
  };
  return plan;
}

Experiment FigureExperiment(int figure, const std::string& on) {
  return {.name = fmt::format("fig{}", figure),
          .title = fmt::format("Figure {}: ghost detection on {}", figure, on),
          .summary = fmt::format("Ghost criteria on {}: recall, precision, F1", on),
          .also = {"ghosts"},
          .plan = [figure](const Study& study) { return PlanFigure(study, figure); }};
}

std::string DefaultsCellName(std::string_view preset) {
  return fmt::format("masks-defaults-{}", preset);
}

/// The default settings on every camera of a preset's recording.
Result<CellPtr> DefaultsCell(const Study& study, const std::string& preset) {
  VANTAGE_ASSIGN_OR_RETURN(const CellPtr recording, MaskRecording(study, preset));
  Cell cell{.name = DefaultsCellName(preset), .inputs = {}, .needs = {recording}, .run = {}};
  RecordOptions(BackgroundOptions(), cell.inputs["background"]);
  cell.run = [recording](const CellRun& run) -> Result<Json> {
    const fs::path folder = run.folder / recording->product;
    DefaultMasks sum;
    VANTAGE_ASSIGN_OR_RETURN(const Scene scene, LoadScene(folder / "scene.toml"));
    const auto cameras = static_cast<int>(scene.cameras.size());
    for (int camera = 0; camera < cameras; ++camera) {
      VANTAGE_ASSIGN_OR_RETURN(LabelledSequence sequence,
                               LabelledSequence::OpenRecording(folder, camera, {}));
      const BackgroundOptions options;
      VANTAGE_ASSIGN_OR_RETURN(
          BackgroundSubtractor subtractor,
          BackgroundSubtractor::Create(sequence.size(), options, scene.frames_per_second));
      const SceneCamera& filmed = scene.cameras[static_cast<std::size_t>(camera)];
      VANTAGE_ASSIGN_OR_RETURN(const auto pictures, OpenVideo(filmed.source.path));
      VANTAGE_RETURN_IF_ERROR(Rehearse(
          subtractor, *pictures,
          PlanRehearsal(options.rehearsal, pictures->info().frame_count, scene.frames_per_second),
          1, run.control));
      VANTAGE_ASSIGN_OR_RETURN(
          const DefaultMasks one,
          RunDefaultMasks(std::move(sequence), std::move(subtractor), run.control));
      sum += one;
    }
    const MaskMeasures measures = MeasureMasks(sum.counts);
    return Json{{"cameras", cameras},
                {"pictures", sum.counts.frames},
                {"recall", measures.recall},
                {"precision", measures.precision},
                {"f1", measures.f1},
                {"near_share", static_cast<double>(sum.near_false_positives) /
                                   static_cast<double>(sum.counts.false_positives)}};
  };
  return std::make_shared<const Cell>(std::move(cell));
}

Status AddDefaultsTable(const CellResults& cells, ReportPage& page, ExperimentReport& report) {
  page.Subheading("The default settings on the simulated presets");
  page.Paragraph(
      "All cameras and frames of each recording together, the first frames included, against its "
      "exact masks. Near: the share of the false positives within half a person's height of "
      "somebody, mostly shadows and reflections; the rest are ghosts, moving background and "
      "light.");
  PageTable table{.header = {"preset", "cameras", "pictures", "recall", "precision", "F1",
                             "false positives near people"}};
  for (const simulation::Preset& preset : simulation::Presets()) {
    const Json& found = cells.at(DefaultsCellName(preset.name));
    const auto number = [&](const char* key) {
      return found.at(key).is_number() ? found.at(key).get<double>() : std::nan("");
    };
    std::vector<std::string>& row = table.rows.emplace_back(std::vector<std::string>{
        std::string(preset.name), found.at("cameras").dump(), found.at("pictures").dump()});
    for (const char* key : {"recall", "precision", "f1"}) {
      row.push_back(fmt::format("{:.3f}", number(key)));
      report.figures.push_back({.row = "default settings",
                                .measure = key,
                                .value = number(key),
                                .data = std::string(preset.name),
                                .simulated = true});
    }
    row.push_back(fmt::format("{:.0f} %", 100 * number("near_share")));
  }
  page.Table(table);
  return {};
}

Result<ExperimentPlan> PlanDetails(const Study& study) {
  VANTAGE_ASSIGN_OR_RETURN(GhostPlan ghosts,
                           PlanGhosts(study, [](const GhostCase&) { return true; }));
  ExperimentPlan plan{.cells = ghosts.cells, .skipped = {}, .report = {}};
  for (const simulation::Preset& preset : simulation::Presets()) {
    VANTAGE_ASSIGN_OR_RETURN(CellPtr cell, DefaultsCell(study, std::string(preset.name)));
    plan.cells.push_back(std::move(cell));
  }
  plan.report = [ghosts = std::move(ghosts), output = study.output](
                    const CellResults& cells, ReportPage& page,
                    ExperimentReport& report) -> Status {
    VANTAGE_ASSIGN_OR_RETURN(const GhostResults results, GhostResultsOf(ghosts, cells));
    VANTAGE_RETURN_IF_ERROR(AddDefaultsTable(cells, page, report));
    AddGhostDetails(results, page);
    report.findings = GhostFindings(results, 0);
    VANTAGE_RETURN_IF_ERROR(WriteTextFile(output / "ghosts.csv", GhostCsv(results)));
    return WriteTextFile(output / "ghosts_frames.csv", GhostFramesCsv(results));
  };
  return plan;
}

}  // namespace

std::vector<Experiment> GhostExperiments() {
  return {FigureExperiment(8, "intermittent object motion"),
          FigureExperiment(9, "the change-detection set"),
          FigureExperiment(10, "floorball selection data"),
          FigureExperiment(11, "change detection and floorball together"),
          {.name = "ghosts",
           .title = "Masks and ghost detection in detail",
           .summary = "Every sequence of figures 8 to 11 in detail, beside OpenCV's MOG2 and KNN, "
                      "and the default settings on the simulated presets",
           .also = {},
           .plan = &PlanDetails}};
}

}  // namespace vantage
