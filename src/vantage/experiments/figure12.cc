// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/figure12.h"

#include <algorithm>
#include <array>
#include <utility>

#include "vantage/experiments/picture_uri.h"
#include "vantage/experiments/track_cell.h"
#include "vantage/occupancy/peaks.h"
#include "vantage/pipeline/ground.h"
#include "vantage/rendering/occupancy_picture.h"
#include "vantage/rendering/overlay.h"
#include "vantage/rendering/people.h"
#include "vantage/scene/frame_pictures.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

/// Enough for the shares of time; what the pictures show is of the last one.
constexpr FrameIndex kFrames = 200;
constexpr double kTrail_s = 3;

/// What each stage gives at the last frame.
Result<Json> StagePictures(const Scene& scene, const StageOptions& options,
                           const TrackingResult& tracked, const std::vector<cv::Mat>& masks,
                           FrameIndex frame, int threads) {
  const PersonOptions& person = tracked.report.maps.person.used;
  VANTAGE_ASSIGN_OR_RETURN(Ground ground, LayOutGround(scene, person, options.occupancy));
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<cv::Mat> pictures,
                           FramePictures(scene, frame, threads));
  if (pictures[0].empty()) return Fail("the first camera has no picture at frame {}", frame);
  const std::span<const float> q = tracked.maps.Frame(frame - scene.first_frame);
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<Peak> peaks, FindPeaks(ground.grid, q, {}));
  const OccupancyPicture draw(scene, person, ground.grid, std::move(ground.views),
                              ground.extension);
  cv::Mat view = pictures[0].clone();
  const auto trail = static_cast<FrameIndex>(kTrail_s * scene.frames_per_second);
  DrawPeople(view, scene.cameras[0].camera, PeopleAt(tracked.tracks, frame, trail), person);
  Json json;
  VANTAGE_ASSIGN_OR_RETURN(json["pictures"], PictureUri(pictures[0], PictureFormat::kJpeg, 480));
  VANTAGE_ASSIGN_OR_RETURN(json["masks"], PictureUri(masks[0], PictureFormat::kPng, 480));
  VANTAGE_ASSIGN_OR_RETURN(json["maps"],
                           PictureUri(draw.DrawMap(q, peaks), PictureFormat::kPng, 480));
  VANTAGE_ASSIGN_OR_RETURN(json["tracks"], PictureUri(view, PictureFormat::kJpeg, 480));
  return json;
}

Result<Json> RunStages(const TrackRecording& recording, const CellRun& run) {
  VANTAGE_ASSIGN_OR_RETURN(Scene scene, recording.scene(run.folder));
  scene.frame_count = std::min(kFrames, recording.frames.value_or(kFrames));
  const FrameIndex shown = scene.first_frame + *scene.frame_count - 1;
  std::vector<cv::Mat> masks;
  const MaskSink sink = [&](FrameIndex frame, const std::vector<cv::Mat>& all) -> Status {
    if (frame == shown) {
      for (const cv::Mat& mask : all) masks.push_back(mask.clone());
    }
    return {};
  };
  const StageOptions options = DefaultsFor(recording);
  VANTAGE_ASSIGN_OR_RETURN(const TrackingResult tracked,
                           TrackPeople(scene, options, run.threads, run.control, sink));
  if (masks.empty()) return Fail("the recording ends before frame {}", shown);
  Json json;
  VANTAGE_ASSIGN_OR_RETURN(json["shown"],
                           StagePictures(scene, options, tracked, masks, shown, run.threads));
  json["frame"] = shown;
  json["frames"] = tracked.report.maps.frames;
  json["cameras"] = scene.cameras.size();
  json["threads"] = run.threads;
  const MapsReport& maps = tracked.report.maps;
  json["seconds"] = {{"read", maps.read_secs},
                     {"background", maps.background_secs},
                     {"occupancy", maps.occupancy_secs},
                     {"linking", tracked.report.linking.linking.seconds},
                     {"hold", maps.hold_secs}};
  return json;
}

Result<ExperimentPlan> PlanFigure12(const Study& study) {
  ExperimentPlan plan;
  VANTAGE_ASSIGN_OR_RETURN(const TrackRecording recording, FloorballRecording(study));
  Json inputs = InputsOf(recording, {.name = "", .options = DefaultsFor(recording)}, false);
  inputs["frames"] = kFrames;
  const auto cell = std::make_shared<const Cell>(
      Cell{.name = "stages-" + recording.name,
           .inputs = std::move(inputs),
           .needs = recording.Needs(),
           .alone = true,
           .run = [recording](const CellRun& run) { return RunStages(recording, run); }});
  plan.cells = {cell};
  plan.report = [recording, cell](const CellResults& results, ReportPage& page,
                                  ExperimentReport&) -> Status {
    const Json& result = results.at(cell->name);
    page.Paragraph(fmt::format(
        "From the program's own stages with the default options: {}, the first {} frames, on {} "
        "threads. The pictures are of frame {} and the first camera; seconds are wall-clock, all "
        "cameras together.",
        recording.title, NumberAt(result, "frames"), NumberAt(result, "threads"),
        NumberAt(result, "frame")));
    page.Figure({StagesSvg(result)}, "As the thesis's figure 12.");
    return {};
  };
  return plan;
}

}  // namespace

std::string StagesSvg(const Json& result) {
  constexpr double kPicture = 200;  // width; 4:3 at most
  constexpr double kStep = 320;
  constexpr double kTop = 40;
  constexpr double kHeight = 150;
  const Json& seconds = result.at("seconds");
  double total = 0;
  for (const auto& [stage, secs] : seconds.items()) total += secs.get<double>();
  const double frames = NumberAt(result, "frames");
  const auto share = [&](const std::string& stage) {
    const double secs = NumberAt(seconds, stage);
    return std::array<std::string, 2>{
        fmt::format("{:.2f} s, {:.0f} %", secs, 100 * secs / std::max(total, 1e-9)),
        fmt::format("{:.0f} frames/s", frames / std::max(secs, 1e-9))};
  };
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1180 260\" role=\"img\" "
      "aria-label=\"Stages of the system\" font-family=\"system-ui, sans-serif\" "
      "font-size=\"12\" fill=\"#1a1a1a\" style=\"flex: 1 1 100%; max-width: 100%\">\n"
      "<defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"8\" "
      "markerHeight=\"8\" orient=\"auto\"><path d=\"M0 0 L8 4 L0 8 z\" fill=\"#0072b2\"/>"
      "</marker></defs>\n";
  const auto text = [&](double x, double y, std::string_view words, std::string_view more = "") {
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\"{}>{}</text>\n", x, y, more,
                       EscapeMarkup(words));
  };
  constexpr std::array<const char*, 4> kShown = {"pictures", "masks", "maps", "tracks"};
  constexpr std::array<std::array<const char*, 2>, 3> kStages = {
      {{"background", "background"}, {"occupancy", "occupancy"}, {"linking", "linking"}}};
  for (std::size_t i = 0; i < kShown.size(); ++i) {
    const double left = 10 + kStep * static_cast<double>(i);
    text(left + kPicture / 2, kTop - 12, kShown[i], " font-weight=\"bold\"");
    svg += fmt::format("<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" href=\"{}\"/>\n", left,
                       kTop, kPicture, kHeight,
                       EscapeMarkup(result.at("shown").at(kShown[i]).get<std::string>()));
    if (i == kStages.size()) break;
    const double middle = left + (kPicture + kStep) / 2;
    svg += fmt::format(
        "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"#0072b2\" stroke-width=\"2\" "
        "marker-end=\"url(#tip)\"/>\n",
        left + kPicture + 6, kTop + kHeight / 2, left + kStep - 6, kTop + kHeight / 2);
    const auto figures = share(kStages[i][1]);
    text(middle, kTop + kHeight / 2 - 10, kStages[i][0], " font-weight=\"bold\"");
    text(middle, kTop + kHeight / 2 + 20, figures[0]);
    text(middle, kTop + kHeight / 2 + 36, figures[1]);
  }
  const auto reading = share("read");
  text(10 + kPicture / 2, kTop + kHeight + 20, "reading: " + reading[0] + ", " + reading[1]);
  // The way back: what stands is held in the masks.
  const double from = 10 + 2 * kStep + kPicture / 2;
  const double to = 10 + kPicture + (kStep - kPicture) / 2;
  svg += fmt::format(
      "<path d=\"M{} {} v26 H{} V{}\" fill=\"none\" stroke=\"#0072b2\" stroke-width=\"2\" "
      "stroke-dasharray=\"5 4\" marker-end=\"url(#tip)\"/>\n",
      from, kTop + kHeight + 6, to, kTop + kHeight / 2 + 46);
  text((from + to) / 2, kTop + kHeight + 50,
       "hold: people who stand stay in the foreground: " + share("hold")[0]);
  return svg + "</svg>\n";
}

Experiment Figure12Experiment() {
  return {.name = "fig12",
          .title = "Figure 12: the stages of the system",
          .summary = "Diagram of the stages with their pictures of one frame and their seconds",
          .also = {},
          .plan = &PlanFigure12};
}

}  // namespace vantage
