// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/occupancy_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "vantage/rendering/drawing.h"
#include "vantage/rendering/overlay.h"
#include "vantage/rendering/palette.h"

namespace vantage {
namespace {

using Eigen::Vector2d;

constexpr int kPlan_px = 1100;   // longer side of the plan
constexpr int kNarrow_px = 640;  // narrower pictures come out twice as large

const cv::Scalar kDarkGround = {38, 32, 27};
const cv::Scalar kArea = {240, 236, 232};
const cv::Scalar kExtension = {40, 170, 250};
const cv::Scalar kUnseen = {40, 30, 150};
const cv::Scalar kUnseenText = {90, 80, 230};
const cv::Scalar kForeground = {255, 160, 60};
const cv::Scalar kHeat = {70, 220, 255};
const cv::Scalar kText = {235, 235, 235};

cv::Scalar CameraColor(std::size_t camera) {
  return ColorOf(TrackId{static_cast<int>(camera) + 1});
}

/// The grid and this share of its longer side around it.
Plan PlanOf(const Scene& scene, const GroundGrid& grid, double around) {
  const Vector2d margin = Vector2d::Constant(around * SideOf(grid).maxCoeff());
  const Vector2d low = LowOf(grid) - margin;
  const Vector2d high = LowOf(grid) + SideOf(grid) + margin;
  const Vector2d size_px =
      ((high - low) / (high - low).maxCoeff() * kPlan_px).cwiseMax(kPlan_px / 4.0);
  return {scene, low, high, {static_cast<int>(size_px.x()), static_cast<int>(size_px.y())}};
}

/// The camera whose pictures are drawn into.
Camera Drawn(const Camera& camera) {
  const int scale = camera.size().width < kNarrow_px ? 2 : 1;
  return camera.Scaled({scale * camera.size().width, scale * camera.size().height})
      .value_or(camera);
}

/// Mixes a share of `color` into the pixels of `mask`.
void Tint(cv::Mat& picture, const cv::Mat& mask, const cv::Scalar& color, double share) {
  cv::Mat mixed;
  cv::addWeighted(picture, 1 - share, cv::Mat(picture.size(), CV_8UC3, color), share, 0, mixed);
  mixed.copyTo(picture, mask);
}

}  // namespace

OccupancyPicture::OccupancyPicture(const Scene& scene, const PersonOptions& person,
                                   const GroundGrid& grid, std::vector<CameraView> views,
                                   const ExtensionReport& extension)
    : area_(scene.area),
      figure_(person),
      scene_name_(scene.name),
      grid_(grid),
      views_(std::move(views)),
      visible_(VisibleCells(views_)),
      extension_(extension),
      plan_(PlanOf(scene, grid, 0.3)),
      map_plan_(PlanOf(scene, grid, 0.03)) {
  for (const SceneCamera& camera : scene.cameras) {
    cameras_.push_back(Drawn(camera.camera));
    names_.push_back(camera.name);
  }
  for (CellIndex cell = 0; cell < grid_.count(); ++cell) {
    in_area_.push_back(area_.Contains(grid_.Center(cell)) ? 1 : 0);
  }
}

std::array<OccupancyPicture::Border, 2> OccupancyPicture::Borders() const {
  const Vector2d low = LowOf(grid_);
  const Vector2d high = low + SideOf(grid_);
  return {{{{low, {high.x(), low.y()}, high, {low.x(), high.y()}}, kExtension},
           {area_.corners_m(), kArea}}};
}

void OccupancyPicture::DrawBorders(cv::Mat& picture, const Plan& plan) const {
  for (const Border& border : Borders()) {
    std::vector<cv::Point2d> corners;
    for (const Vector2d& corner : border.corners_m) {
      corners.push_back(plan.PixelFromGround(corner));
    }
    drawing::Polygon(picture, corners, border.color, 2);
  }
}

void OccupancyPicture::DrawFieldOfView(cv::Mat& plan, std::size_t camera) const {
  cv::Mat1b seen(plan.size(), uchar{0});
  for (int y = 0; y < seen.rows; ++y) {
    for (int x = 0; x < seen.cols; ++x) {
      const Vector2d ground_m = plan_.GroundFromPixel(cv::Point2d(x, y));
      const auto pixel = cameras_[camera].ImageFromWorld({ground_m.x(), ground_m.y(), 0});
      if (pixel && cameras_[camera].InPicture(*pixel)) seen(y, x) = 255;
    }
  }
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(seen, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  for (const auto& contour : contours) {
    const std::vector<cv::Point2d> line(contour.begin(), contour.end());
    drawing::Polygon(plan, line, CameraColor(camera), 2, 0.9);
  }
}

void OccupancyPicture::DrawSideLabels(cv::Mat& plan) const {
  const double height_px = std::max(9.0, plan.rows / 80.0);
  const Vector2d low = LowOf(grid_);
  const Vector2d high = low + SideOf(grid_);
  const Vector2d middle = (low + high) / 2;
  const std::array<Vector2d, 4> places = {Vector2d(low.x(), middle.y()),
                                          {high.x(), middle.y()},
                                          {middle.x(), low.y()},
                                          {middle.x(), high.y()}};
  const std::array<cv::Point2d, 4> shifts = {
      {{-0.8 * height_px, 0}, {0.8 * height_px, 0}, {0, 1.8 * height_px}, {0, -2.6 * height_px}}};
  const std::array<drawing::Anchor, 4> anchors = {drawing::Anchor::kRight, drawing::Anchor::kLeft,
                                                  drawing::Anchor::kCenter,
                                                  drawing::Anchor::kCenter};
  for (std::size_t i = 0; i < 4; ++i) {
    const ExtensionSide& side = extension_.sides[i];
    const cv::Point2d at = plan_.PixelFromGround(places[i]) + shifts[i];
    drawing::TextStyle style{.height_px = height_px,
                             .color = kExtension,
                             .anchor = anchors[i],
                             .halo_px = 2.5,
                             .bold = true};
    drawing::Text(plan, fmt::format("{:.6g} m", side.extension_m), at, style);
    style.bold = false;
    const std::string who = side.camera ? names_[*side.camera] + ": " : "";
    drawing::Text(plan, fmt::format("{}{}", who, NameOf(side.reason)),
                  {at.x, at.y + 1.6 * height_px}, style);
  }
}

cv::Rect2d OccupancyPicture::BoxOf(CellIndex cell, const Plan& plan) const {
  const Vector2d half = Vector2d::Constant(grid_.cell_m / 2);
  return {plan.PixelFromGround(grid_.Center(cell) - half),
          plan.PixelFromGround(grid_.Center(cell) + half)};
}

void OccupancyPicture::DrawCameras(cv::Mat& picture, const Plan& plan) const {
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
    plan.DrawCamera(picture, cameras_[camera], names_[camera], CameraColor(camera));
  }
}

cv::Mat OccupancyPicture::DrawPlan() const {
  cv::Mat plan = plan_.Draw({});
  for (CellIndex cell = 0; cell < grid_.count(); ++cell) {
    const auto index = static_cast<std::size_t>(cell);
    const bool visible = visible_[index] != 0;
    const cv::Scalar& color = in_area_[index] != 0 ? kArea : kExtension;
    drawing::FilledRectangle(plan, BoxOf(cell, plan_), visible ? color : kUnseen,
                             visible ? 0.2 : 0.6);
  }
  const cv::Rect2d first = BoxOf(0, plan_), last = BoxOf(grid_.count() - 1, plan_);
  if (first.width >= 4) {
    for (int i = 1; i < grid_.columns; ++i) {
      const double x = std::round(first.x + i * first.width);
      drawing::Line(plan, {x, last.y}, {x, first.br().y}, kDarkGround, 1, 0.45);
    }
    for (int i = 1; i < grid_.rows; ++i) {
      const double y = std::round(last.y + i * first.height);
      drawing::Line(plan, {first.x, y}, {last.br().x, y}, kDarkGround, 1, 0.45);
    }
  }
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) DrawFieldOfView(plan, camera);
  DrawBorders(plan, plan_);
  DrawCameras(plan, plan_);
  DrawSideLabels(plan);
  std::vector<drawing::CaptionLine> lines = {{fmt::format("{}: {} x {} cells of {} m", scene_name_,
                                                          grid_.columns, grid_.rows, grid_.cell_m),
                                              kText},
                                             {"area", kArea},
                                             {"extension", kExtension}};
  if (std::ranges::count(visible_, 0) > 0) lines.push_back({"seen by nobody", kUnseenText});
  drawing::Caption(plan, lines);
  return plan;
}

cv::Mat OccupancyPicture::Canvas(std::size_t camera, const cv::Mat& picture,
                                 double brightness) const {
  const ImageSize size = cameras_[camera].size();
  cv::Mat canvas(cv::Size(size.width, size.height), CV_8UC3, kDarkGround);
  if (picture.empty()) return canvas;
  cv::Mat fitted;
  cv::resize(picture, fitted, canvas.size(), 0, 0, cv::INTER_NEAREST);
  if (fitted.type() == CV_8UC3) {
    fitted.convertTo(canvas, CV_8UC3, brightness);
  } else if (fitted.type() == CV_8UC1) {
    Tint(canvas, fitted >= 128, kForeground, 0.5);
  }
  return canvas;
}

void OccupancyPicture::DrawBordersInView(cv::Mat& view, std::size_t camera) const {
  const int thickness = std::max(1, view.rows / 280);
  for (const Border& border : Borders()) {
    const auto& corners = border.corners_m;
    for (const bool rim : {true, false}) {
      for (std::size_t i = 0; i < corners.size(); ++i) {
        DrawGroundLine(view, cameras_[camera], corners[i], corners[(i + 1) % corners.size()],
                       rim ? kDarkGround : border.color, thickness + (rim ? 2 : 0),
                       rim ? 0.5 : 0.95);
      }
    }
  }
}

void OccupancyPicture::DrawCellsInView(cv::Mat& view, std::size_t camera) const {
  cv::Mat1b area(view.size(), uchar{0}), extension(view.size(), uchar{0});
  for (CellIndex cell = 0; cell < grid_.count(); ++cell) {
    const auto index = static_cast<std::size_t>(cell);
    if (views_[camera].rectangles[index].empty()) continue;
    std::vector<cv::Point> corners;
    for (const auto& [x, y] : {std::pair(-0.5, -0.5), {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}) {
      const Vector2d corner = grid_.Center(cell) + grid_.cell_m * Vector2d(x, y);
      const auto pixel = cameras_[camera].ImageFromWorld({corner.x(), corner.y(), 0});
      // Corners beside a camera's foot lie beyond all coordinates.
      if (!pixel || pixel->cwiseAbs().maxCoeff() > 1e5) break;
      corners.emplace_back(static_cast<int>(std::lround(pixel->x())),
                           static_cast<int>(std::lround(pixel->y())));
    }
    if (corners.size() == 4) {
      cv::fillConvexPoly(in_area_[index] != 0 ? area : extension, corners, 255);
    }
  }
  Tint(view, area, kArea, 0.22);
  Tint(view, extension, kExtension, 0.22);
  const Vector2d low = LowOf(grid_);
  const Vector2d high = low + SideOf(grid_);
  // Where the cells are too many to tell apart, every few of them.
  const int step = std::max(grid_.columns, grid_.rows) / 200 + 1;
  for (int column = 0; column <= grid_.columns; column += step) {
    const double x = low.x() + column * grid_.cell_m;
    DrawGroundLine(view, cameras_[camera], {x, low.y()}, {x, high.y()}, kText, 1, 0.22);
  }
  for (int row = 0; row <= grid_.rows; row += step) {
    const double y = low.y() + row * grid_.cell_m;
    DrawGroundLine(view, cameras_[camera], {low.x(), y}, {high.x(), y}, kText, 1, 0.22);
  }
}

void OccupancyPicture::DrawFiguresInView(cv::Mat& view, std::size_t camera) const {
  // In a lattice over area and extension, so that they tell near from far without hiding the rest.
  const int thickness = std::max(1, view.rows / 380);
  for (const double row : {0.06, 0.35, 0.65, 0.94}) {
    for (const double column : {0.06, 0.35, 0.65, 0.94}) {
      const CellIndex cell =
          grid_.Index(static_cast<int>(column * grid_.columns), static_cast<int>(row * grid_.rows));
      const auto index = static_cast<std::size_t>(cell);
      if (views_[camera].rectangles[index].empty()) continue;
      const Vector2d foot_m = grid_.Center(cell);
      const auto box = PersonBox(cameras_[camera], foot_m, figure_);
      const auto foot = cameras_[camera].ImageFromWorld({foot_m.x(), foot_m.y(), 0});
      if (!box || !foot) continue;
      const cv::Scalar color = in_area_[index] != 0 ? kArea : kExtension;
      const cv::Rect2d frame(box->min_x, box->min_y, box->width(), box->height());
      drawing::Rectangle(view, frame, kDarkGround, thickness + 2, 0.5);
      drawing::Rectangle(view, frame, color, thickness);
      drawing::Disc(view, {foot->x(), foot->y()}, 1.5 * thickness + 1, color);
    }
  }
}

cv::Mat OccupancyPicture::DrawView(std::size_t camera, const cv::Mat& picture) const {
  cv::Mat view = Canvas(camera, picture, 0.75);
  DrawCellsInView(view, camera);
  DrawBordersInView(view, camera);
  DrawFiguresInView(view, camera);
  std::array<std::int64_t, 2> cells = {}, spoken_for = {};  // of the extension, of the area
  for (std::size_t i = 0; i < in_area_.size(); ++i) {
    ++cells[in_area_[i]];
    if (!views_[camera].rectangles[i].empty()) ++spoken_for[in_area_[i]];
  }
  drawing::Caption(
      view, {{names_[camera], CameraColor(camera)},
             {fmt::format("speaks for {} of {} cells of the area", spoken_for[1], cells[1]), kArea},
             {fmt::format("and {} of {} of its extension", spoken_for[0], cells[0]), kExtension}});
  return view;
}

std::vector<Person> OccupancyPicture::PeopleOf(const std::vector<Peak>& peaks) const {
  std::vector<Person> people;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    // Whoever is outside the area is drawn as the plan draws positions of less account.
    people.push_back({.id = TrackId{static_cast<int>(i) + 1},
                      .position_m = peaks[i].position_m,
                      .inferred = in_area_[static_cast<std::size_t>(peaks[i].cell)] == 0,
                      .trail = {}});
  }
  return people;
}

cv::Mat OccupancyPicture::DrawMap(std::span<const float> q, const std::vector<Peak>& peaks) const {
  cv::Mat plan = map_plan_.Draw({});
  for (CellIndex cell = 0; cell < grid_.count(); ++cell) {
    const double probability = q[static_cast<std::size_t>(cell)];
    // By the square root: small probabilities are the map's second thoughts.
    const double share = std::sqrt(std::clamp(probability, 0.0, 1.0));
    if (share > 0.12) drawing::FilledRectangle(plan, BoxOf(cell, map_plan_), kHeat, share);
  }
  DrawBorders(plan, map_plan_);
  DrawCameras(plan, map_plan_);
  const double radius_px = std::max(6.0, 1.1 * BoxOf(0, map_plan_).width);
  for (const Person& person : PeopleOf(peaks)) {
    const cv::Point2d at = map_plan_.PixelFromGround(person.position_m);
    const cv::Scalar color = ColorOf(person.id);
    drawing::Disc(plan, at, radius_px, color, person.inferred ? 1 : 3);
    drawing::Text(plan, std::to_string(static_cast<std::int64_t>(person.id)),
                  {at.x + radius_px + 4, at.y - 0.3 * radius_px},
                  {.height_px = 15, .color = color, .halo_px = 2.5, .bold = true});
  }
  drawing::Caption(plan, {{scene_name_, kText}, {fmt::format("{} found", peaks.size()), kHeat}});
  return plan;
}

cv::Mat OccupancyPicture::DrawPeaks(std::size_t camera, const cv::Mat& picture, const cv::Mat& mask,
                                    const std::vector<Peak>& peaks) const {
  cv::Mat view = Canvas(camera, picture, 0.75);
  if (!mask.empty()) {
    cv::Mat fitted;
    cv::resize(mask, fitted, view.size(), 0, 0, cv::INTER_NEAREST);
    Tint(view, fitted >= 128, kForeground, 0.35);
  }
  DrawBordersInView(view, camera);
  DrawPeople(view, cameras_[camera], PeopleOf(peaks), figure_);
  drawing::Caption(view, {{names_[camera], CameraColor(camera)}});
  return view;
}

}  // namespace vantage
