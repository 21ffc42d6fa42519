// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/overlay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "vantage/rendering/drawing.h"
#include "vantage/rendering/palette.h"

namespace vantage {
namespace {

using Eigen::Vector2d;

const cv::Scalar kDark = {12, 10, 8};

/// Sizes follow the picture's: 1 for pictures 600 pixels high.
double UnitOf(const cv::Mat& picture) { return picture.rows / 600.0; }
int Thickness(double px) { return std::max(1, static_cast<int>(std::lround(px))); }

cv::Point2d Project(const Camera& camera, const Vector2d& ground_m) {
  const auto pixel = camera.ImageFromWorld({ground_m.x(), ground_m.y(), 0});
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  return pixel ? cv::Point2d(pixel->x(), pixel->y()) : cv::Point2d(kNowhere, kNowhere);
}

bool Overlaps(const PixelBox& box, const cv::Mat& picture) {
  return box.max_x >= 0 && box.max_y >= 0 && box.min_x <= picture.cols - 1 &&
         box.min_y <= picture.rows - 1;
}

void DrawTrail(cv::Mat& picture, const Camera& camera, const Person& person) {
  std::vector<cv::Point2d> points;
  std::vector<double> color_opacity, rim_opacity;
  for (const TrailPoint& point : person.trail) {
    points.push_back(Project(camera, point.position_m));
    color_opacity.push_back(0.95 * (1 - point.age));
    rim_opacity.push_back(0.45 * (1 - point.age));
  }
  const int thickness = Thickness(2.4 * UnitOf(picture));
  drawing::FadingLine(picture, points, rim_opacity, kDark, thickness + 2);
  drawing::FadingLine(picture, points, color_opacity, ColorOf(person.id), thickness);
}

/// The number on a tag of the person's colour.
struct Tag {
  std::string number;
  cv::Scalar color;
  drawing::TextStyle style;
  double pad_px;
  cv::Rect2d place;
};

/// The tag stands on the box, or inside it at the picture's upper edge; higher where that place is
/// taken, so that no number hides another.
Tag PlaceTag(const cv::Mat& picture, const Person& person, const PixelBox& box,
             const std::vector<Tag>& placed) {
  Tag tag;
  tag.number = std::to_string(static_cast<std::int64_t>(person.id));
  tag.color = ColorOf(person.id);
  tag.style = {.height_px = std::max(11 * UnitOf(picture), 7.5),
               .color = TextColorOn(tag.color),
               .anchor = drawing::Anchor::kCenter,
               .bold = true};
  tag.pad_px = std::round(0.42 * tag.style.height_px);
  const double height = std::round(tag.style.height_px + 2 * tag.pad_px);
  const double width =
      std::round(std::max(drawing::TextWidth(tag.number, tag.style) + 2 * tag.pad_px, height));
  const double center = std::clamp((box.min_x + box.max_x) / 2, width / 2,
                                   std::max(width / 2, picture.cols - width / 2));
  const double bottom = std::max(box.min_y, height);
  tag.place = {std::round(center - width / 2), std::round(bottom - height), width, height};
  const auto taken = [&] {
    return std::any_of(placed.begin(), placed.end(),
                       [&](const Tag& other) { return (other.place & tag.place).area() > 0; });
  };
  while (taken() && tag.place.y >= height) tag.place.y -= std::round(height / 2);
  return tag;
}

void DrawTag(cv::Mat& picture, const Tag& tag) {
  const cv::Rect2d& place = tag.place;
  drawing::FilledRectangle(picture, {place.x - 1, place.y - 1, place.width + 2, place.height + 2},
                           kDark, 0.55);
  drawing::FilledRectangle(picture, place, tag.color);
  drawing::Text(picture, tag.number,
                {place.x + place.width / 2 - 0.5, place.y + place.height - tag.pad_px - 0.5},
                tag.style);
}

}  // namespace

void DrawGroundLine(cv::Mat& picture, const Camera& camera, const Vector2d& from,
                    const Vector2d& to, const cv::Scalar& color, int thickness_px, double opacity) {
  // Short enough that the lens may bend it and that what cannot be projected drops out alone.
  const int pieces = std::clamp(static_cast<int>((to - from).norm() / 0.25), 1, 2000);
  std::vector<cv::Point2d> points;
  for (int i = 0; i <= pieces; ++i) {
    points.push_back(Project(camera, from + (to - from) * i / pieces));
  }
  drawing::FadingLine(picture, points, std::vector<double>(points.size(), opacity), color,
                      thickness_px);
}

void DrawGround(cv::Mat& picture, const Camera& camera, const Polygon& area, bool with_grid) {
  const double unit = UnitOf(picture);
  if (with_grid) {
    const Vector2d low = area.min_m();
    const Vector2d high = area.max_m();
    // At most about a hundred lines, whatever the area's size.
    const double step = std::max(1.0, std::ceil((high - low).maxCoeff() / 50));
    const cv::Scalar color = {96, 86, 78};
    for (const double x : drawing::Multiples(step, low.x(), high.x())) {
      DrawGroundLine(picture, camera, {x, low.y()}, {x, high.y()}, color, 1, 0.6);
    }
    for (const double y : drawing::Multiples(step, low.y(), high.y())) {
      DrawGroundLine(picture, camera, {low.x(), y}, {high.x(), y}, color, 1, 0.6);
    }
  }
  const auto& corners = area.corners_m();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    DrawGroundLine(picture, camera, corners[i], corners[(i + 1) % corners.size()], {255, 255, 255},
                   Thickness(1.2 * unit), 0.35);
  }
}

void DrawPeople(cv::Mat& picture, const Camera& camera, const std::vector<Person>& people,
                const PersonOptions& figure) {
  std::vector<std::pair<const Person*, PixelBox>> seen;
  for (const Person& person : people) {
    const auto box = PersonBox(camera, person.position_m, figure);
    if (box && Overlaps(*box, picture)) seen.emplace_back(&person, *box);
  }
  // Far to near: whoever stands in front is drawn in front.
  const Vector2d center_m = camera.center_m().head<2>();
  std::stable_sort(seen.begin(), seen.end(), [&](const auto& a, const auto& b) {
    return (a.first->position_m - center_m).norm() > (b.first->position_m - center_m).norm();
  });
  const double unit = UnitOf(picture);
  for (const auto& [person, box] : seen) DrawTrail(picture, camera, *person);
  for (const auto& [person, box] : seen) {
    const cv::Rect2d frame(box.min_x, box.min_y, box.width(), box.height());
    const int thickness = Thickness(2 * unit);
    // A filled-in position shows paler.
    const double opacity = person->inferred ? 0.45 : 1;
    drawing::Rectangle(picture, frame, kDark, thickness + 2, 0.5 * opacity);
    drawing::Rectangle(picture, frame, ColorOf(person->id), thickness, opacity);
  }
  std::vector<Tag> tags;
  for (auto it = seen.rbegin(); it != seen.rend(); ++it) {  // the nearest keeps its place
    tags.push_back(PlaceTag(picture, *it->first, it->second, tags));
  }
  for (const Tag& tag : tags) DrawTag(picture, tag);
}

}  // namespace vantage
