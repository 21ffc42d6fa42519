// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/mask_pictures.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "vantage/experiments/chart.h"
#include "vantage/experiments/mask_grid.h"
#include "vantage/experiments/mask_recordings.h"
#include "vantage/experiments/recordings.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Where a figure's pictures come from.
struct Material {
  std::string text;        ///< for readers
  CellPtr recording = {};  ///< simulated; null: real
  fs::path video = {};     ///< real
  Json data = nullptr;     ///< what is known of the video
  FrameSpan span = {};
};

Result<Material> Simulated(const Study& study, const std::string& preset, const FrameSpan& span) {
  Material material{.text = fmt::format("simulated preset {}, camera 1", preset), .span = span};
  VANTAGE_ASSIGN_OR_RETURN(material.recording, MaskRecording(study, preset));
  return material;
}

/// PETS 2009 S2.L1 as View_001 shows it, where there is a video or a folder of its pictures.
std::optional<fs::path> FindView1(const fs::path& data) {
  std::vector<fs::path> places = {"/usr/share/doc/opencv-doc/examples/data/vtest.avi"};
  if (!data.empty()) {
    places = {data / "pets2009/View_001", data / "pets2009/vtest.avi", data / "vtest.avi",
              places[0]};
  }
  std::error_code code;
  const auto found =
      std::ranges::find_if(places, [&](const fs::path& place) { return fs::exists(place, code); });
  return found == places.end() ? std::nullopt : std::optional(*found);
}

Result<Material> Pets(const Study& study, const FrameSpan& span) {
  const std::optional<fs::path> video = FindView1(study.data);
  if (!video) return Simulated(study, "campus", span);
  Material material{.text = "real video PETS 2009 S2.L1 View_001", .video = *video, .span = span};
  VANTAGE_ASSIGN_OR_RETURN(material.data, DescribeData(*video));
  return material;
}

CellPtr GridCell(const std::string& name, const Material& from, const MaskGridPlan& plan) {
  Json rows = Json::array();
  for (const MaskGridRow& row : plan.rows) {
    Json& one = rows.emplace_back(Json{{"name", row.name}, {"background", row.background}});
    RecordOptions(row.options, one["options"]);
  }
  Cell cell{.name = name,
            .inputs = {{"data", from.data},
                       {"begin", from.span.begin},
                       {"last", from.span.last},
                       {"columns", plan.columns},
                       {"width_px", plan.width_px},
                       {"rows", std::move(rows)}},
            .run = {}};
  if (from.recording) cell.needs = {from.recording};
  cell.run = [from, plan](const CellRun& run) -> Result<Json> {
    VANTAGE_ASSIGN_OR_RETURN(
        LabelledSequence sequence,
        from.recording
            ? LabelledSequence::OpenRecording(run.folder / from.recording->product, 0, from.span)
            : LabelledSequence::OpenUnlabelled(from.video, from.span));
    return DrawMaskGrid(std::move(sequence), plan, run.control);
  };
  return std::make_shared<const Cell>(std::move(cell));
}

PictureGrid GridOf(const Json& found, const std::string& caption,
                   const std::function<bool(const std::string&)>& shows) {
  PictureGrid grid{.columns = found.at("columns"), .rows = {}, .caption = caption};
  for (const Json& row : found.at("rows")) {
    const std::string name = row.at("name");
    if (shows(name)) grid.rows.push_back({name, row.at("pictures")});
  }
  return grid;
}

constexpr const char* kColors =
    "White: found people and objects. With truth: red, false (ghosts, shadows, noise); blue, "
    "missed; grey, not counted.";

/// Mean pixels a frame of a row's series.
double MeanPixels(const Json& series) {
  double sum = 0;
  for (const Json& one : series.at("frames")) sum += one.at(1).get<double>();
  return sum / static_cast<double>(std::max<std::size_t>(series.at("frames").size(), 1));
}

// Figure 1.

MaskGridRow RateRow(const char* name, LearningRate rate) {
  MaskGridRow row{.name = name, .background = true};
  row.options.mixture.rate = rate;
  row.options.ghosts.rule.criterion = GhostCriterion::kNone;
  return row;
}

std::string RateChart(FrameIndex frames) {
  const double alpha = MixtureOptions().alpha;
  LineChart chart{.title = "Learning coefficient", .x_label = "frame"};
  LineSeries& modified = chart.series.emplace_back(LineSeries{.name = "modified rate"});
  for (FrameIndex t = 0; t < frames; ++t) {
    modified.points.emplace_back(t,
                                 std::max(alpha, 1.0 / (1.0 + static_cast<double>(t))));  // eq. 6
  }
  // The first frame fills the model in any case.
  chart.series.push_back({.name = "original rate",
                          .points = {{0, 1}, {1, alpha}, {static_cast<double>(frames), alpha}}});
  return ToSvg(chart);
}

Result<ExperimentPlan> PlanFigure1(const Study& study) {
  constexpr FrameIndex kFrames = 200;
  VANTAGE_ASSIGN_OR_RETURN(const Material from,
                           Simulated(study, "floorball", {.last = kFrames - 1}));
  const CellPtr cell = GridCell("masks-fig1", from,
                                {.rows = {RateRow("modified rate", LearningRate::kModified),
                                          RateRow("original rate", LearningRate::kOriginal)},
                                 .columns = {0, 5, 15, 50, 100, kFrames - 1}});
  ExperimentPlan plan{.cells = {cell}, .skipped = {}, .report = {}};
  plan.report = [text = from.text](const CellResults& cells, ReportPage& page,
                                   ExperimentReport& report) -> Status {
    const Json& found = cells.at("masks-fig1");
    page.Paragraph(
        "No empty picture is at hand: the background must be learnt from pictures with people in "
        "them. At the original rate the first picture is the background until it is outweighed, so "
        "that everybody in it leaves a ghost; the modified rate begins as a mean of the pictures.");
    page.Pictures(GridOf(found, fmt::format("Figure 1 here: {}. {}", text, kColors),
                         [](const std::string&) { return true; }));
    LineChart chart{.title = "False foreground pixels per frame", .x_label = "frame"};
    std::vector<double> means;
    for (const Json& series : found.at("foreground")) {
      LineSeries& line = chart.series.emplace_back(LineSeries{.name = series.at("name")});
      for (const Json& one : series.at("frames")) line.points.emplace_back(one.at(0), one.at(1));
      means.push_back(MeanPixels(series));
      report.figures.push_back({.row = line.name,
                                .measure = "false_pixels_per_frame",
                                .value = means.back(),
                                .data = text,
                                .simulated = true});
    }
    const auto frames = static_cast<FrameIndex>(chart.series.at(0).points.size());
    page.Figure({RateChart(frames), ToSvg(chart)},
                "The learning coefficient, and what it does to the masks.");
    report.findings.push_back(
        {.thesis = "The modified learning coefficient reflects the information of the first frames "
                   "better (3.3.1, figure 1)",
         .here = fmt::format("false pixels per frame of the first {}: {:.0f} at the modified rate, "
                             "{:.0f} at the original one (simulated)",
                             frames, means.at(0), means.at(1)),
         .verdict = means.at(0) < means.at(1) ? Verdict::kHolds : Verdict::kDoesNotHold});
    return {};
  };
  return plan;
}

// Figures 5 to 7.

/// No detection, then every criterion judged plainly and our way.
std::vector<MaskGridRow> CriterionRows(LearningRate rate, bool with_fer) {
  std::vector<MaskGridRow> rows;
  for (const GhostCriterion criterion :
       {GhostCriterion::kNone, GhostCriterion::kFep, GhostCriterion::kFer, GhostCriterion::kNb,
        GhostCriterion::kEpd, GhostCriterion::kCb}) {
    if (criterion == GhostCriterion::kFer && !with_fer) continue;
    for (const GhostJudgement judgement : {GhostJudgement::kPlain, GhostJudgement::kStill}) {
      MaskGridRow row{.name = std::string(NameOf(criterion))};
      row.options.mixture.rate = rate;
      row.options.ghosts.rule.criterion = criterion;
      row.options.ghosts.judgement = judgement;
      if (criterion != GhostCriterion::kNone && judgement == GhostJudgement::kPlain) {
        row.name += "-plain";
      }
      if (criterion != GhostCriterion::kNone || rows.empty()) rows.push_back(std::move(row));
    }
  }
  return rows;
}

ExperimentPlan CriterionGrid(int figure, const Material& from, const MaskGridPlan& plan,
                             const std::string& note) {
  const std::string name = fmt::format("masks-fig{}", figure);
  ExperimentPlan made{.cells = {GridCell(name, from, plan)}, .skipped = {}, .report = {}};
  made.report = [=, text = from.text](const CellResults& cells, ReportPage& page,
                                      ExperimentReport& report) -> Status {
    const Json& found = cells.at(name);
    page.Paragraph(note);
    for (const bool plain : {true, false}) {
      page.Pictures(
          GridOf(found,
                 fmt::format("Figure {} here: {}; {}. {}", figure, text,
                             plain ? "every component judged whole in every frame, as in the thesis"
                                   : "judged our way",
                             kColors),
                 [plain](const std::string& row) {
                   return row == "picture" || row == "none" || row.ends_with("-plain") == plain;
                 }));
    }
    for (const Json& series : found.at("foreground")) {
      report.figures.push_back(
          {.row = series.at("name"),
           .measure = from.recording ? "false_pixels_per_frame" : "foreground_pixels_per_frame",
           .value = MeanPixels(series),
           .data = text,
           .simulated = from.recording != nullptr});
    }
    return {};
  };
  return made;
}

Result<ExperimentPlan> PlanFigure5(const Study& study) {
  // The car stands there until frame 500 and is out of the picture at about 560.
  const FrameIndex begin = study.frames ? 0 : 350;
  VANTAGE_ASSIGN_OR_RETURN(const Material from,
                           Simulated(study, "ghosts", {.begin = begin, .last = begin + 300}));
  return CriterionGrid(5, from,
                       {.rows = CriterionRows(LearningRate::kModified, true),
                        .columns = {5, 140, 175, 200, 230, 300}},
                       "The thesis's parking video is not to be had. In the simulated one a car "
                       "that has become background drives off, while people come and go.");
}

Result<ExperimentPlan> PlanFigure6(const Study& study) {
  const FrameIndex begin = study.quick || study.frames ? 0 : 500;
  VANTAGE_ASSIGN_OR_RETURN(const Material from,
                           Simulated(study, "floorball", {.begin = begin, .last = begin + 150}));
  return CriterionGrid(
      6, from,
      {.rows = CriterionRows(LearningRate::kModified, true), .columns = {1, 5, 15, 40, 80, 150}},
      "Learning begins in the middle of the match, with players everywhere.");
}

Result<ExperimentPlan> PlanFigure7(const Study& study) {
  FrameIndex last = 200;
  if (study.quick) last = 40;
  if (study.frames) last = std::min(last, *study.frames - 1);
  VANTAGE_ASSIGN_OR_RETURN(const Material from, Pets(study, {.last = last}));
  return CriterionGrid(
      7, from,
      {.rows = CriterionRows(LearningRate::kOriginal, false), .columns = {1, 10, 20, 40, 100, 200}},
      "At the original learning rate, so that the people of the first picture are "
      "background and leave ghosts, as in the thesis. There is no truth for the "
      "masks of the real video: foreground is white, ghosts included.");
}

}  // namespace

std::vector<Experiment> MaskPictureExperiments() {
  return {{.name = "fig1",
           .title = "Figure 1: the background at the start",
           .summary = "How the background comes about at the modified and the original rate",
           .also = {},
           .plan = &PlanFigure1},
          {.name = "fig5",
           .title = "Figure 5: masks where a parked car drives off",
           .summary = "Masks of every ghost criterion as pictures, simulated ghosts",
           .also = {},
           .plan = &PlanFigure5},
          {.name = "fig6",
           .title = "Figure 6: masks of floorball",
           .summary = "The same on simulated floorball",
           .also = {},
           .plan = &PlanFigure6},
          {.name = "fig7",
           .title = "Figure 7: masks of PETS 2009",
           .summary = "The same on View_001 of PETS 2009, at the original rate",
           .also = {},
           .plan = &PlanFigure7}};
}

}  // namespace vantage
