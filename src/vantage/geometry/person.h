// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "vantage/base/options.h"
#include "vantage/geometry/camera.h"

namespace vantage {

/// The upright figure that stands for a person (algorithms.md section 3; thesis 4.4.2).
struct PersonOptions {
  enum class Shape { kBox, kFlat };
  /// Breadth in metres, 0.05 <= width <= 5.
  double width_m = 0.5;
  /// Height in metres, 0.1 <= height <= 5.
  double height_m = 1.75;
  /// kBox: bounding rectangle of an upright box with a square base, sides along the world's axes.
  /// kFlat: bounding rectangle of a flat figure that faces the camera.
  Shape shape = Shape::kFlat;
};
void VisitOptions(PersonOptions& options, OptionVisitor& visitor);

/// Axis-parallel rectangle in pixels, real-valued, not clipped to the picture; max > min.
struct PixelBox {
  double min_x = 0;
  double min_y = 0;
  double max_x = 0;
  double max_y = 0;
  double width() const { return max_x - min_x; }
  double height() const { return max_y - min_y; }
};

/// Bounding rectangle of a person who stands at `foot_m`. None when any part of the figure cannot
/// be projected (behind the camera, or outside the cone of the lens), or when the rectangle has no
/// extent (a flat figure straight below the camera).
std::optional<PixelBox> PersonBox(const Camera& camera, const Eigen::Vector2d& foot_m,
                                  const PersonOptions& person);

}  // namespace vantage
