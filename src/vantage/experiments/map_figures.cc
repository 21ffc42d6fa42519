// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/map_figures.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "vantage/experiments/picture_uri.h"
#include "vantage/experiments/track_cell.h"
#include "vantage/pipeline/ground.h"
#include "vantage/rendering/occupancy_picture.h"
#include "vantage/rendering/overlay.h"
#include "vantage/scene/frame_pictures.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

/// Frames among which the clearest are looked for.
constexpr FrameIndex kFrames = 200;

/// Outlines of cells on a camera's picture.
void DrawCells(cv::Mat& picture, const Camera& camera, const GroundGrid& grid,
               const cv::Scalar& color) {
  const Eigen::Vector2d low = LowOf(grid), high = low + SideOf(grid);
  for (int column = 0; column <= grid.columns; ++column) {
    const double x = low.x() + column * grid.cell_m;
    DrawGroundLine(picture, camera, {x, low.y()}, {x, high.y()}, color, 1, 0.6);
  }
  for (int row = 0; row <= grid.rows; ++row) {
    const double y = low.y() + row * grid.cell_m;
    DrawGroundLine(picture, camera, {low.x(), y}, {high.x(), y}, color, 1, 0.6);
  }
}

Result<Json> DrawGrids(const TrackRecording& recording, const CellRun& run) {
  VANTAGE_ASSIGN_OR_RETURN(Scene scene, recording.scene(run.folder));
  const FrameIndex frame = recording.frames.value_or(1) / 2;
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<cv::Mat> pictures,
                           FramePictures(scene, frame, run.threads));
  if (pictures[0].empty()) return Fail("the first camera has no picture at frame {}", frame);
  const Camera& camera = scene.cameras[0].camera;
  const cv::Scalar white(255, 255, 255), amber(60, 190, 255);
  const OccupancyOptions options;
  scene.grid.extension_m = 0;
  VANTAGE_ASSIGN_OR_RETURN(const Ground inside, LayOutGround(scene, {}, options));
  scene.grid.extension_m = std::nullopt;
  VANTAGE_ASSIGN_OR_RETURN(const Ground extended, LayOutGround(scene, {}, options));

  cv::Mat area = pictures[0].clone();
  DrawGround(area, camera, scene.area, false);
  cv::Mat cells = area.clone();
  DrawCells(cells, camera, inside.grid, white);
  cv::Mat beyond = area.clone();
  DrawCells(beyond, camera, extended.grid, amber);
  DrawCells(beyond, camera, inside.grid, white);
  Json json = {{"frame", frame}, {"cell_m", scene.grid.cell_m}, {"pictures", Json::array()}};
  for (const cv::Mat& picture : {area, cells, beyond}) {
    VANTAGE_ASSIGN_OR_RETURN(const std::string uri, PictureUri(picture, PictureFormat::kJpeg));
    json["pictures"].push_back(uri);
  }
  return json;
}

/// Maps of a recording under one rule.
struct Ruled {
  Scene scene;
  StageOptions options;
  MapsResult result;

  Result<std::vector<Peak>> Peaks(std::int64_t index) const {
    return FindPeaks(result.maps.grid, result.maps.Frame(index), {});
  }
  Result<OccupancyPicture> Picture() const {
    const PersonOptions& person = result.report.person.used;
    VANTAGE_ASSIGN_OR_RETURN(Ground ground, LayOutGround(scene, person, options.occupancy));
    return OccupancyPicture(scene, person, ground.grid, std::move(ground.views), ground.extension);
  }
};

Result<Ruled> MapsUnder(const TrackRecording& recording, const CellPtr& masks, bool extended,
                        Visibility visibility, const CellRun& run) {
  TrackSetting setting{.name = "", .options = PlainOptionsFor(recording)};
  setting.options.occupancy.visibility = visibility;
  if (!extended) setting.extension_m = 0;
  VANTAGE_ASSIGN_OR_RETURN(Scene scene, SceneFor(recording, setting, masks, run.folder));
  scene.frame_count = std::min(kFrames, recording.frames.value_or(kFrames));
  VANTAGE_ASSIGN_OR_RETURN(MapsResult result,
                           ComputeMaps(scene, setting.options, run.threads, run.control));
  return Ruled{std::move(scene), setting.options, std::move(result)};
}

/// The frame in which the first rule has most false detections more than the second.
struct Clearest {
  std::int64_t frame = 0;
  std::int64_t worse = 0, better = 0;  ///< false detections there
};

Result<Clearest> FindClearest(const Ruled& worse, const Ruled& better, const Tracks& truth) {
  Clearest clearest;
  std::int64_t most = std::numeric_limits<std::int64_t>::min();
  for (std::int64_t i = 0; i < worse.result.maps.frame_count(); ++i) {
    const std::vector<Person> people = PeopleAt(truth, worse.result.maps.first_frame + i, 0);
    VANTAGE_ASSIGN_OR_RETURN(const std::vector<Peak> a, worse.Peaks(i));
    VANTAGE_ASSIGN_OR_RETURN(const std::vector<Peak> b, better.Peaks(i));
    const std::int64_t fa = FalsePeaks(a, people, worse.scene.area);
    const std::int64_t fb = FalsePeaks(b, people, better.scene.area);
    if (fa - fb <= most) continue;
    most = fa - fb;
    clearest = {.frame = i, .worse = fa, .better = fb};
  }
  return clearest;
}

/// What an ideal map would be: everybody at the cell of the true position.
Result<cv::Mat> IdealMap(const Ruled& rule, const std::vector<Person>& people) {
  const GroundGrid& grid = rule.result.maps.grid;
  std::vector<float> q(static_cast<std::size_t>(grid.count()), 0.0F);
  std::vector<Peak> peaks;
  for (const Person& person : people) {
    const std::optional<CellIndex> cell = grid.CellAt(person.position_m);
    if (!cell) continue;
    peaks.push_back({.cell = *cell, .position_m = person.position_m, .probability = 1});
    if (rule.scene.area.Contains(person.position_m)) q[static_cast<std::size_t>(*cell)] = 1;
  }
  VANTAGE_ASSIGN_OR_RETURN(const OccupancyPicture draw, rule.Picture());
  return draw.DrawMap(q, peaks);
}

Result<cv::Mat> MapOf(const Ruled& rule, std::int64_t frame) {
  VANTAGE_ASSIGN_OR_RETURN(const OccupancyPicture draw, rule.Picture());
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<Peak> peaks, rule.Peaks(frame));
  return draw.DrawMap(rule.result.maps.Frame(frame), peaks);
}

/// The camera in which somebody true is cut off by the picture's edge the most, but not wholly.
std::size_t CameraOfEdge(const Scene& scene, const PersonOptions& figure,
                         const std::vector<Person>& people) {
  std::size_t found = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < scene.cameras.size(); ++c) {
    const Camera& camera = scene.cameras[c].camera;
    for (const Person& person : people) {
      if (!scene.area.Contains(person.position_m)) continue;
      const auto box = PersonBox(camera, person.position_m, figure);
      if (!box) continue;
      const auto seen = [](double low, double high, double end) {
        return std::max(0.0, std::min(high, end) - std::max(low, 0.0)) / std::max(high - low, 1e-9);
      };
      const double share = seen(box->min_x, box->max_x, camera.size().width) *
                           seen(box->min_y, box->max_y, camera.size().height);
      // Half of the person is what the two rules differ most about.
      if (share <= 0 || share >= 0.99 || std::abs(share - 0.6) >= nearest) continue;
      nearest = std::abs(share - 0.6);
      found = c;
    }
  }
  return found;
}

Result<cv::Mat> PeaksInView(const Ruled& rule, std::int64_t index, std::size_t camera,
                            const std::vector<cv::Mat>& pictures,
                            const std::vector<cv::Mat>& masks) {
  VANTAGE_ASSIGN_OR_RETURN(const OccupancyPicture draw, rule.Picture());
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<Peak> peaks, rule.Peaks(index));
  return draw.DrawPeaks(camera, pictures[camera], masks[camera], peaks);
}

Status AddUri(const Result<cv::Mat>& picture, PictureFormat format, Json& to) {
  if (!picture) return tl::unexpected(picture.error());
  VANTAGE_ASSIGN_OR_RETURN(const std::string uri, PictureUri(*picture, format));
  to.push_back(uri);
  return {};
}

Json CountsOf(const Clearest& clearest) {
  return {{"frame", clearest.frame},
          {"worse", clearest.worse},
          {"better", clearest.better},
          {"pictures", Json::array()}};
}

Result<Json> DrawMaps(const TrackRecording& recording, const CellPtr& masks_cell,
                      const CellRun& run) {
  const auto maps = [&](bool extended, Visibility visibility) {
    return MapsUnder(recording, masks_cell, extended, visibility, run);
  };
  VANTAGE_ASSIGN_OR_RETURN(const Ruled original, maps(false, Visibility::kCentre));
  VANTAGE_ASSIGN_OR_RETURN(const Ruled extended, maps(true, Visibility::kCentre));
  VANTAGE_ASSIGN_OR_RETURN(const Ruled complete, maps(true, Visibility::kComplete));
  VANTAGE_ASSIGN_OR_RETURN(const Tracks truth, recording.Truth(run.folder));

  VANTAGE_ASSIGN_OR_RETURN(const Clearest outside, FindClearest(original, extended, truth));
  Json fig14 = CountsOf(outside);
  Json& maps14 = fig14["pictures"];
  VANTAGE_RETURN_IF_ERROR(
      AddUri(IdealMap(extended, PeopleAt(truth, outside.frame, 0)), PictureFormat::kPng, maps14));
  VANTAGE_RETURN_IF_ERROR(AddUri(MapOf(original, outside.frame), PictureFormat::kPng, maps14));
  VANTAGE_RETURN_IF_ERROR(AddUri(MapOf(extended, outside.frame), PictureFormat::kPng, maps14));

  VANTAGE_ASSIGN_OR_RETURN(const Clearest edge, FindClearest(complete, extended, truth));
  const std::size_t camera = CameraOfEdge(extended.scene, extended.result.report.person.used,
                                          PeopleAt(truth, edge.frame, 0));
  VANTAGE_ASSIGN_OR_RETURN(const Scene colour, recording.scene(run.folder));
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<cv::Mat> pictures,
                           FramePictures(colour, edge.frame, run.threads));
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<cv::Mat> masks,
                           FramePictures(extended.scene, edge.frame, run.threads));
  Json fig15 = CountsOf(edge);
  fig15["camera"] = colour.cameras[camera].name;
  for (const Ruled* rule : {&complete, &extended}) {
    VANTAGE_RETURN_IF_ERROR(AddUri(PeaksInView(*rule, edge.frame, camera, pictures, masks),
                                   PictureFormat::kJpeg, fig15["pictures"]));
  }
  return Json{{"fig14", fig14}, {"fig15", fig15}};
}

std::vector<std::string> Pictures(const Json& json) {
  return json.at("pictures").get<std::vector<std::string>>();
}

struct Figures {
  TrackRecording grid_of, maps_of;
  CellPtr grids, maps;
};

Status Report(const Figures& figures, const CellResults& results, ReportPage& page,
              ExperimentReport&) {
  const Json& grids = results.at(figures.grids->name);
  page.Subheading("Figure 13");
  page.Pictures({.columns = {"area", "its cells", "its extension"},
                 .rows = {{.name = "", .pictures = Pictures(grids)}},
                 .caption = fmt::format("{}, frame {}: the area, its cells of {} m, and the cells "
                                        "of the extension that the cameras need.",
                                        figures.grid_of.title, NumberAt(grids, "frame"),
                                        NumberAt(grids, "cell_m"))});
  const Json& fig14 = results.at(figures.maps->name).at("fig14");
  page.Subheading("Figure 14");
  page.Pictures(
      {.columns = {"ideal", "original area", "extended area"},
       .rows = {{.name = "", .pictures = Pictures(fig14)}},
       .caption = fmt::format(
           "{}, frame {}, where the extension removes the most false detections: {} without it, "
           "{} with it. Ideal: the truth; thin rings stand outside the area.",
           figures.maps_of.title, NumberAt(fig14, "frame"), NumberAt(fig14, "worse"),
           NumberAt(fig14, "better"))});
  const Json& fig15 = results.at(figures.maps->name).at("fig15");
  page.Subheading("Figure 15");
  page.Pictures(
      {.columns = {"complete rule", "centre rule"},
       .rows = {{.name = "", .pictures = Pictures(fig15)}},
       .caption = fmt::format(
           "{}, frame {}, {}: where the complete rule has the most false detections more: {} "
           "against {} of the centre rule.",
           figures.maps_of.title, NumberAt(fig15, "frame"), fig15.at("camera").get<std::string>(),
           NumberAt(fig15, "worse"), NumberAt(fig15, "better"))});
  return {};
}

Result<ExperimentPlan> PlanMapFigures(const Study& study) {
  ExperimentPlan plan;
  VANTAGE_ASSIGN_OR_RETURN(TrackRecording floorball, FloorballRecording(study));
  VANTAGE_ASSIGN_OR_RETURN(TrackRecording campus, CampusRecording(study));
  // The real pictures where they are, as the thesis has them.
  std::vector<std::string> absent;
  VANTAGE_ASSIGN_OR_RETURN(std::optional<TrackRecording> video, PetsVideoRecording(study, absent));
  Figures figures{
      .grid_of = video ? *video : campus, .maps_of = floorball, .grids = {}, .maps = {}};
  const TrackSetting defaults{.name = "", .options = PlainOptionsFor(floorball)};
  figures.grids =
      std::make_shared<const Cell>(Cell{.name = "grids-" + figures.grid_of.name,
                                        .inputs = InputsOf(figures.grid_of, defaults, true),
                                        .needs = figures.grid_of.Needs(),
                                        .run = [recording = figures.grid_of](const CellRun& run) {
                                          return DrawGrids(recording, run);
                                        }});
  const CellPtr masks = MasksCell(floorball, "defaults", defaults.options.background);
  std::vector<CellPtr> needs = floorball.Needs();
  needs.push_back(masks);
  Json inputs = InputsOf(floorball, defaults, true);
  inputs["frames"] = kFrames;
  figures.maps = std::make_shared<const Cell>(Cell{
      .name = "maps-" + floorball.name,
      .inputs = std::move(inputs),
      .needs = std::move(needs),
      .run = [floorball, masks](const CellRun& run) { return DrawMaps(floorball, masks, run); }});
  plan.cells = {figures.grids, figures.maps};
  plan.report = [figures](const CellResults& results, ReportPage& page, ExperimentReport& report) {
    return Report(figures, results, page, report);
  };
  return plan;
}

}  // namespace

std::int64_t FalsePeaks(const std::vector<Peak>& peaks, const std::vector<Person>& people,
                        const Polygon& area, double distance_m) {
  std::vector<bool> taken(people.size(), false);
  std::int64_t count = 0;
  for (const Peak& peak : peaks) {  // the strongest first
    if (!area.Contains(peak.position_m)) continue;
    std::size_t nearest = people.size();
    double least_m = distance_m;
    for (std::size_t i = 0; i < people.size(); ++i) {
      const double d_m = (people[i].position_m - peak.position_m).norm();
      if (taken[i] || d_m > least_m) continue;
      least_m = d_m;
      nearest = i;
    }
    if (nearest == people.size()) {
      ++count;
    } else {
      taken[nearest] = true;
    }
  }
  return count;
}

Experiment MapFiguresExperiment() {
  return {.name = "fig13",
          .title = "Figures 13 to 15: area, extension and the edges of pictures",
          .summary =
              "The grid on a picture; maps with people outside the area and at the edge of "
              "a picture",
          .also = {"fig14", "fig15"},
          .plan = &PlanMapFigures};
}

}  // namespace vantage
