// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/geometry/person.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vantage {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr OptionInfo kWidth = {"width", "m", "breadth of a person"};
constexpr OptionInfo kHeight = {"height", "m", "height of a person"};
constexpr Range kWidthRange = {.low = 0.05, .high = 5};
constexpr Range kHeightRange = {.low = 0.1, .high = 5};

void VisitShape(PersonOptions::Shape& shape, OptionVisitor& v) {
  v.Choice({"shape", "", "box (square base), cylinder, or flat (faces the camera)"}, shape,
           {{"box", PersonOptions::Shape::kBox},
            {"cylinder", PersonOptions::Shape::kCylinder},
            {"flat", PersonOptions::Shape::kFlat}});
}

constexpr std::size_t kCirclePoints = 16;

/// Points of the figure's footprint; its outline at the top is the same.
struct Footprint {
  std::array<Vector2d, kCirclePoints> points;
  std::size_t count = 0;
};

/// Corners of the square, points around the circle, or ends of the facing segment.
Footprint FootprintOf(const Camera& camera, const Vector2d& foot_m, const PersonOptions& person) {
  const double half = person.width_m / 2;
  Footprint footprint;
  const auto add = [&](const Vector2d& offset) {
    footprint.points[footprint.count++] = foot_m + half * offset;
  };
  switch (person.shape) {
    case PersonOptions::Shape::kBox:
      for (const double x : {-1, 1}) {
        for (const double y : {-1, 1}) add({x, y});
      }
      break;
    case PersonOptions::Shape::kCylinder:
      for (std::size_t i = 0; i < kCirclePoints; ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kCirclePoints;
        add({std::cos(angle), std::sin(angle)});
      }
      break;
    case PersonOptions::Shape::kFlat: {
      const Vector2d view = foot_m - camera.center_m().head<2>();
      const double length = view.norm();
      // Straight under the camera every direction faces it.
      const Vector2d across =
          length > 1e-9 ? Vector2d(-view.y() / length, view.x() / length) : Vector2d(1, 0);
      add(across);
      add(-across);
      break;
    }
  }
  return footprint;
}

/// Largest value of a smooth periodic function that is known at equal steps: of the parabola
/// through the largest sample and its neighbours.
double PeakOnCircle(const std::array<double, kCirclePoints>& values) {
  const auto peak = static_cast<std::size_t>(std::ranges::max_element(values) - values.begin());
  const double before = values[(peak + kCirclePoints - 1) % kCirclePoints];
  const double at = values[peak];
  const double after = values[(peak + 1) % kCirclePoints];
  const double curvature = before - 2 * at + after;
  return curvature < 0 ? at - (after - before) * (after - before) / (8 * curvature) : at;
}

/// Bounding rectangle of a circle's picture, from points around it.
PixelBox BoxOfCircle(const std::array<Vector2d, kCirclePoints>& pixels) {
  std::array<double, 4> peaks{};  // right, below, left, above
  const std::array<Vector2d, 4> directions = {Vector2d(1, 0), Vector2d(0, 1), Vector2d(-1, 0),
                                              Vector2d(0, -1)};
  for (std::size_t i = 0; i < directions.size(); ++i) {
    std::array<double, kCirclePoints> values{};
    std::ranges::transform(pixels, values.begin(),
                           [&](const Vector2d& pixel) { return directions[i].dot(pixel); });
    peaks[i] = PeakOnCircle(values);
  }
  return {.min_x = -peaks[2], .min_y = -peaks[3], .max_x = peaks[0], .max_y = peaks[1]};
}

PixelBox BoxOfPoints(const std::array<Vector2d, kCirclePoints>& pixels, std::size_t count) {
  PixelBox box{pixels[0].x(), pixels[0].y(), pixels[0].x(), pixels[0].y()};
  for (std::size_t i = 1; i < count; ++i) {
    box.min_x = std::min(box.min_x, pixels[i].x());
    box.min_y = std::min(box.min_y, pixels[i].y());
    box.max_x = std::max(box.max_x, pixels[i].x());
    box.max_y = std::max(box.max_y, pixels[i].y());
  }
  return box;
}

/// The ground under the middle of the rectangle's lower edge.
std::optional<Vector2d> GroundBelow(const Camera& camera, const PixelBox& box) {
  const auto ground_m = camera.WorldFromImage({(box.min_x + box.max_x) / 2, box.max_y});
  if (!ground_m) return std::nullopt;
  return ground_m->head<2>();
}

}  // namespace

void VisitOptions(PersonOptions& o, OptionVisitor& v) {
  v.Number(kWidth, o.width_m, kWidthRange);
  v.Number(kHeight, o.height_m, kHeightRange);
  VisitShape(o.shape, v);
}

void VisitOptions(PersonSpec& o, OptionVisitor& v) {
  v.NumberOr(kWidth, o.width_m, "auto", kWidthRange);
  v.NumberOr(kHeight, o.height_m, "auto", kHeightRange);
  VisitShape(o.shape, v);
}

PersonOptions PersonSpec::Or(double open_width_m, double open_height_m) const {
  return {.width_m = width_m.value_or(open_width_m),
          .height_m = height_m.value_or(open_height_m),
          .shape = shape};
}

PersonOptions PersonSpec::OrDefault() const {
  const PersonOptions standard;
  return Or(standard.width_m, standard.height_m);
}

std::optional<PixelBox> PersonBox(const Camera& camera, const Vector2d& foot_m,
                                  const PersonOptions& person) {
  const Footprint footprint = FootprintOf(camera, foot_m, person);
  std::optional<PixelBox> box;
  for (const double z_m : {0.0, person.height_m}) {
    std::array<Vector2d, kCirclePoints> pixels;
    pixels.fill(Vector2d::Zero());
    for (std::size_t i = 0; i < footprint.count; ++i) {
      const Vector2d& point = footprint.points[i];
      const auto pixel = camera.ImageFromWorld(Vector3d(point.x(), point.y(), z_m));
      if (!pixel) return std::nullopt;
      pixels[i] = *pixel;
    }
    const PixelBox outline = person.shape == PersonOptions::Shape::kCylinder
                                 ? BoxOfCircle(pixels)
                                 : BoxOfPoints(pixels, footprint.count);
    box = box ? PixelBox{std::min(box->min_x, outline.min_x), std::min(box->min_y, outline.min_y),
                         std::max(box->max_x, outline.max_x), std::max(box->max_y, outline.max_y)}
              : outline;
  }
  // A flat figure seen from straight above is a line.
  if (!box || !(box->width() > 0 && box->height() > 0)) return std::nullopt;
  return box;
}

std::optional<PersonInBox> PersonFromBox(const Camera& camera, const PixelBox& box,
                                         PersonOptions::Shape shape) {
  constexpr int kMaxIterations = 60;
  constexpr double kTolerance = 1e-3;
  if (!(box.width() > 0 && box.height() > 0)) return std::nullopt;
  const std::optional<Vector2d> below_m = GroundBelow(camera, box);
  if (!below_m) return std::nullopt;
  PersonOptions person{.width_m = 0.5, .height_m = 1.75, .shape = shape};
  Vector2d foot_m = *below_m;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const std::optional<PixelBox> found = PersonBox(camera, foot_m, person);
    if (!found) return std::nullopt;
    if (std::max(std::abs(found->min_x - box.min_x), std::abs(found->max_x - box.max_x)) <=
            kTolerance * box.width() &&
        std::max(std::abs(found->min_y - box.min_y), std::abs(found->max_y - box.max_y)) <=
            kTolerance * box.height()) {
      return PersonInBox{foot_m, person.width_m, person.height_m};
    }
    const std::optional<Vector2d> found_below_m = GroundBelow(camera, *found);
    if (!found_below_m) return std::nullopt;
    foot_m += *below_m - *found_below_m;
    person.width_m *= box.width() / found->width();
    // Part of the rectangle's height is the depth of the figure: this closes in from one side.
    person.height_m *= box.height() / found->height();
    if (!(person.width_m < 100 && person.height_m > 1e-3 && person.height_m < 100)) break;
  }
  return std::nullopt;
}

}  // namespace vantage
