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
  enum class Shape { kBox, kCylinder, kFlat };
  /// Breadth in metres, 0.05 <= width <= 5.
  double width_m = 0.5;
  /// Height in metres, 0.1 <= height <= 5.
  double height_m = 1.75;
  /// kBox: bounding rectangle of an upright box with a square base, sides along the world's axes.
  /// kCylinder: of an upright cylinder; the same from every side.
  /// kFlat: bounding rectangle of a flat figure that faces the camera.
  Shape shape = Shape::kFlat;
};
void VisitOptions(PersonOptions& options, OptionVisitor& visitor);

/// The person that a scene asks for (table [person]): the same ranges; a length that is not given
/// ("auto") is found from the recording.
struct PersonSpec {
  std::optional<double> width_m = std::nullopt;
  std::optional<double> height_m = std::nullopt;
  PersonOptions::Shape shape = PersonOptions().shape;

  bool IsGiven() const { return width_m && height_m; }
  /// With these lengths where the spec leaves them open.
  PersonOptions Or(double open_width_m, double open_height_m) const;
  /// With the lengths of PersonOptions where the spec leaves them open.
  PersonOptions OrDefault() const;
};
void VisitOptions(PersonSpec& options, OptionVisitor& visitor);

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

/// An upright figure that would fill a rectangle of a picture.
struct PersonInBox {
  Eigen::Vector2d foot_m = Eigen::Vector2d::Zero();
  double width_m = 0;
  double height_m = 0;
};

/// The inverse of PersonBox: the figure of this shape whose bounding rectangle is `box` (to 1e-3 of
/// its sides). None when there is none (the lower edge is not on the ground in front of the camera,
/// or the view is so steep that a box as flat as this one needs no height).
std::optional<PersonInBox> PersonFromBox(const Camera& camera, const PixelBox& box,
                                         PersonOptions::Shape shape);

}  // namespace vantage
