// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/geometry/person.h"

#include <algorithm>
#include <array>

namespace vantage {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Footprint of the figure on the ground: corners of the square, or ends of the facing segment.
std::pair<std::array<Vector2d, 4>, int> Footprint(const Camera& camera, const Vector2d& foot_m,
                                                  const PersonOptions& person) {
  const double half = person.width_m / 2;
  if (person.shape == PersonOptions::Shape::kBox) {
    return {{foot_m + Vector2d(-half, -half), foot_m + Vector2d(half, -half),
             foot_m + Vector2d(half, half), foot_m + Vector2d(-half, half)},
            4};
  }
  const Vector2d view = foot_m - camera.center_m().head<2>();
  const double length = view.norm();
  // Straight under the camera every direction faces it.
  const Vector2d across =
      length > 1e-9 ? Vector2d(-view.y() / length, view.x() / length) : Vector2d(1, 0);
  return {{foot_m - half * across, foot_m + half * across}, 2};
}

}  // namespace

void VisitOptions(PersonOptions& o, OptionVisitor& v) {
  v.Number({"width", "m", "breadth of a person"}, o.width_m, Range::Between(0.05, 5));
  v.Number({"height", "m", "height of a person"}, o.height_m, Range::Between(0.1, 5));
  v.Choice({"shape", "", "box (square base) or flat (faces the camera)"}, o.shape,
           {{"box", PersonOptions::Shape::kBox}, {"flat", PersonOptions::Shape::kFlat}});
}

std::optional<PixelBox> PersonBox(const Camera& camera, const Vector2d& foot_m,
                                  const PersonOptions& person) {
  const auto [base, corners] = Footprint(camera, foot_m, person);
  std::optional<PixelBox> box;
  for (int i = 0; i < corners; ++i) {
    for (const double z_m : {0.0, person.height_m}) {
      const auto pixel = camera.ImageFromWorld(
          Vector3d(base[static_cast<size_t>(i)].x(), base[static_cast<size_t>(i)].y(), z_m));
      if (!pixel) return std::nullopt;
      if (!box) box = PixelBox{pixel->x(), pixel->y(), pixel->x(), pixel->y()};
      box->min_x = std::min(box->min_x, pixel->x());
      box->min_y = std::min(box->min_y, pixel->y());
      box->max_x = std::max(box->max_x, pixel->x());
      box->max_y = std::max(box->max_y, pixel->y());
    }
  }
  // A flat figure seen from straight above is a line.
  if (!box || !(box->width() > 0 && box->height() > 0)) return std::nullopt;
  return box;
}

}  // namespace vantage
