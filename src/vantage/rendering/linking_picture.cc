// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/linking_picture.h"

#include <algorithm>
#include <cmath>

#include "vantage/linking/track_builder.h"
#include "vantage/rendering/drawing.h"
#include "vantage/rendering/palette.h"

namespace vantage {
namespace {

using Eigen::Vector2d;

constexpr int kPlan_px = 1100;  // longer side

const cv::Scalar kDark = {12, 10, 8};
const cv::Scalar kGround = {38, 32, 27};
const cv::Scalar kHeat = {70, 220, 255};
const cv::Scalar kText = {235, 235, 235};

cv::Scalar ColorOfPath(std::size_t path) { return ColorOf(TrackId{static_cast<int>(path) + 1}); }

/// What a plan shows of the scene; the rectangle around the maps' area when it has none of its own.
Scene GroundOf(const Scene& scene, const OccupancyMaps& maps) {
  Scene ground;
  ground.area = scene.area;
  ground.doors = scene.doors;
  ground.obstacles = scene.obstacles;
  ground.cameras = scene.cameras;
  if (!scene.area.corners_m().empty()) return ground;
  const GroundGrid& grid = maps.grid;
  Vector2d low = LowOf(grid) + SideOf(grid);
  Vector2d high = LowOf(grid);
  const Vector2d half_cell = Vector2d::Constant(grid.cell_m / 2);
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    if (maps.in_area[static_cast<std::size_t>(cell)] == 0) continue;
    low = low.cwiseMin(grid.Center(cell) - half_cell);
    high = high.cwiseMax(grid.Center(cell) + half_cell);
  }
  if (low.x() >= high.x()) {
    low = LowOf(grid);
    high = low + SideOf(grid);
  }
  if (auto area = Polygon::Rectangle(low, high)) ground.area = *std::move(area);
  return ground;
}

/// The plan of the grid.
Plan PlanOf(const Scene& scene, const GroundGrid& grid) {
  const Vector2d side = SideOf(grid);
  const Vector2d size_px = (side / side.maxCoeff() * kPlan_px).cwiseMax(kPlan_px / 4.0);
  return {scene,
          LowOf(grid),
          LowOf(grid) + side,
          {static_cast<int>(size_px.x()), static_cast<int>(size_px.y())}};
}

/// Puts the lines above the picture, where they hide nothing.
cv::Mat WithCaption(const cv::Mat& plan, const std::vector<drawing::CaptionLine>& lines) {
  const int height_px = static_cast<int>(35 * lines.size() + 20);
  cv::Mat picture(plan.rows + height_px, plan.cols, CV_8UC3, kGround);
  plan.copyTo(picture.rowRange(height_px, picture.rows));
  cv::Mat above = picture.rowRange(0, height_px);
  double base = 0;
  for (const drawing::CaptionLine& line : lines) {
    drawing::Text(above, line.text, {16, base += 35},
                  {.height_px = 15, .color = line.color, .bold = true});
  }
  return picture;
}

/// A line of dashes of this length, `phase` of a dash and a gap being done already.
void DashedLine(cv::Mat& picture, cv::Point2d from, cv::Point2d to, const cv::Scalar& color,
                int thickness_px, double dash_px, double& phase_px) {
  const double length = cv::norm(to - from);
  for (double at = 0; at < length;) {
    const double within = std::fmod(phase_px, 2 * dash_px);
    const bool drawn = within < dash_px;
    const double next = std::min(at + (drawn ? dash_px : 2 * dash_px) - within + 1e-6, length);
    if (drawn) {
      drawing::Line(picture, from + at / length * (to - from), from + next / length * (to - from),
                    color, thickness_px);
    }
    phase_px += next - at;
    at = next;
  }
}

void Cross(cv::Mat& picture, cv::Point2d at, double radius_px, const cv::Scalar& color) {
  for (const auto& [color_now, thickness] : {std::pair(kDark, 5), {color, 3}}) {
    drawing::Line(picture, {at.x - radius_px, at.y - radius_px},
                  {at.x + radius_px, at.y + radius_px}, color_now, thickness);
    drawing::Line(picture, {at.x - radius_px, at.y + radius_px},
                  {at.x + radius_px, at.y - radius_px}, color_now, thickness);
  }
}

}  // namespace

LinkingPicture::LinkingPicture(const Scene& scene, const OccupancyMaps& maps,
                               const std::vector<LinkedPath>& paths, double support)
    : maps_(maps),
      paths_(paths),
      support_(support),
      name_(scene.name),
      plan_(PlanOf(GroundOf(scene, maps), maps.grid)) {}

cv::Point2d LinkingPicture::PixelOf(CellIndex cell) const {
  return plan_.PixelFromGround(maps_.grid.Center(cell));
}

double LinkingPicture::CellPx() const {
  const Vector2d low = LowOf(maps_.grid);
  return plan_.PixelFromGround(low + Vector2d(maps_.grid.cell_m, 0)).x -
         plan_.PixelFromGround(low).x;
}

cv::Mat LinkingPicture::DrawMap(std::span<const float> q) const {
  cv::Mat plan = plan_.Draw({});
  const double side_px = CellPx();
  for (CellIndex cell = 0; cell < maps_.grid.count(); ++cell) {
    const double probability = q[static_cast<std::size_t>(cell)];
    // By the square root: small probabilities are the map's second thoughts.
    const double share = std::sqrt(std::clamp(probability, 0.0, 1.0));
    if (share <= 0.12) continue;
    const cv::Point2d center = PixelOf(cell);
    drawing::FilledRectangle(plan,
                             {center.x - side_px / 2, center.y - side_px / 2, side_px, side_px},
                             kHeat, 0.8 * share);
  }
  return plan;
}

void LinkingPicture::DrawPath(cv::Mat& plan, std::size_t path, std::int64_t first,
                              std::int64_t last) const {
  const LinkedPath& linked = paths_[path];
  const cv::Scalar color = ColorOfPath(path);
  const std::int64_t path_last = linked.end_frame() - 1;
  const std::int64_t begin = std::max(first, linked.first_frame);
  const std::int64_t end = std::min(last, path_last);
  const auto cell_at = [&](std::int64_t frame) {
    return linked.cells[static_cast<std::size_t>(frame - linked.first_frame)];
  };
  const auto seen = [&](std::int64_t frame) {
    return IsSeen(maps_, frame, cell_at(frame), support_);
  };
  // The dark rim of the whole path lies under all of its colour.
  for (const bool rim : {true, false}) {
    double phase_px = 0;
    for (std::int64_t frame = begin; frame < end; ++frame) {
      const cv::Point2d from = PixelOf(cell_at(frame));
      const cv::Point2d to = PixelOf(cell_at(frame + 1));
      if (seen(frame) && seen(frame + 1)) {
        drawing::Line(plan, from, to, rim ? kDark : color, rim ? 5 : 3);
      } else if (!rim) {
        DashedLine(plan, from, to, color, 2, 5, phase_px);
      }
    }
  }
  const double radius_px = std::max(5.0, 0.45 * CellPx());
  if (linked.first_frame >= first) {
    drawing::Disc(plan, PixelOf(cell_at(begin)), radius_px, kDark, 5);
    drawing::Disc(plan, PixelOf(cell_at(begin)), radius_px, color, 3);
  }
  if (path_last <= last) Cross(plan, PixelOf(cell_at(end)), radius_px, color);
}

void LinkingPicture::DrawWeakStep(cv::Mat& plan, const PathInStretch& path) const {
  if (!path.weakest) return;
  const cv::Scalar color = ColorOfPath(path.path);
  const cv::Point2d at = 0.5 * (PixelOf(path.weakest->from) + PixelOf(path.weakest->to));
  const double r = std::max(6.0, 0.4 * CellPx());
  const std::vector<cv::Point2d> diamond = {
      {at.x, at.y - r}, {at.x + r, at.y}, {at.x, at.y + r}, {at.x - r, at.y}};
  drawing::Polygon(plan, diamond, kDark, 0, 0.8);
  drawing::Polygon(plan, diamond, color, 2);
  drawing::Text(plan, fmt::format("{:.3g}", path.weakest->margin), {at.x + r + 3, at.y + r},
                {.height_px = 10, .color = color, .halo_px = 2});
}

cv::Mat LinkingPicture::DrawFrame(std::int64_t frame, std::int64_t since) const {
  cv::Mat plan = DrawMap(maps_.Frame(frame));
  std::size_t there = 0;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const LinkedPath& path = paths_[i];
    const std::int64_t step = frame - path.first_frame;
    if (step < 0 || step >= std::ssize(path.cells)) continue;
    ++there;
    DrawPath(plan, i, since, frame);
    const CellIndex cell = path.cells[static_cast<std::size_t>(step)];
    const bool seen = IsSeen(maps_, frame, cell, support_);
    const double radius_px = std::max(6.0, 0.9 * CellPx());
    const cv::Point2d at = PixelOf(cell);
    drawing::Disc(plan, at, radius_px, ColorOfPath(i), seen ? 3 : 1);
    drawing::Text(plan, std::to_string(i + 1), {at.x + radius_px + 3, at.y - 0.3 * radius_px},
                  {.height_px = 15, .color = ColorOfPath(i), .halo_px = 2.5, .bold = true});
  }
  return WithCaption(
      plan,
      {{fmt::format("{}{}frame {}", name_, name_.empty() ? "" : ": ", maps_.first_frame + frame),
        kText},
       {fmt::format("{} paths", there), kText}});
}

cv::Mat LinkingPicture::DrawStretch(const Stretch& stretch,
                                    const Alternatives& alternatives) const {
  std::vector<float> highest(static_cast<std::size_t>(maps_.grid.count()), 0);
  for (std::int64_t frame = stretch.first_frame; frame <= stretch.last_frame; ++frame) {
    const std::span<const float> q = maps_.Frame(frame);
    for (std::size_t cell = 0; cell < highest.size(); ++cell) {
      highest[cell] = std::max(highest[cell], q[cell]);
    }
  }
  cv::Mat plan = DrawMap(highest);
  for (const PathInStretch& path : alternatives.paths) {
    DrawPath(plan, path.path, stretch.first_frame, stretch.last_frame);
  }
  for (const PathInStretch& path : alternatives.paths) {
    DrawWeakStep(plan, path);
    // People leave in the same places: every other number goes to the left.
    const bool left = path.path % 2 == 0;
    const cv::Point2d at = PixelOf(path.cells.back());
    drawing::Text(plan, std::to_string(path.path + 1), {at.x + (left ? -8 : 8), at.y - 8},
                  {.height_px = 15,
                   .color = ColorOfPath(path.path),
                   .anchor = left ? drawing::Anchor::kRight : drawing::Anchor::kLeft,
                   .halo_px = 2.5,
                   .bold = true});
  }
  const auto number = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.3g}", *value) : std::string("no");
  };
  std::optional<double> missing;
  if (alternatives.further) missing = alternatives.further->missing;
  return WithCaption(
      plan, {{fmt::format("{}{}frames {} to {}, {} paths", name_, name_.empty() ? "" : ": ",
                          maps_.first_frame + stretch.first_frame,
                          maps_.first_frame + stretch.last_frame, alternatives.paths.size()),
              kText},
             {fmt::format("next-best solution: {} more; one path more: {} more",
                          number(alternatives.next_best), number(missing)),
              kText},
             {"ring: begins   cross: ends   dashes: inferred   diamond: weakest step, its margin",
              kText}});
}

}  // namespace vantage
