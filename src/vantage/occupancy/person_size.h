// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"
#include "vantage/geometry/person.h"
#include "vantage/geometry/polygon.h"

namespace vantage {

/// A length found from many samples, some of them wrong, by the shortest interval that holds half
/// of them (the "shorth": right samples are alike, wrong ones are scattered).
struct RobustLength {
  /// Median of the samples in that interval.
  double value_m = 0;
  /// Half the interval's length: in clean samples their median absolute deviation.
  double spread_m = 0;
};

/// What a rectangle must be wider than a person because people do not stand at the centres of
/// cells: a quarter of a cell on either side, which is enough for half of them.
inline double CellAllowance_m(double cell_m) { return 0.5 * cell_m; }

/// How large people are in the masks of a recording.
struct PersonSizeReport {
  /// Moments at which the masks were measured.
  std::int64_t frames = 0;
  /// One entry per camera: figures that were measured, and those of them that count.
  std::vector<std::int64_t> figures;
  std::vector<std::int64_t> counted;
  /// True when only figures count that another camera saw at the same place.
  bool confirmed = false;
  /// None when too few count.
  std::optional<RobustLength> width;
  std::optional<RobustLength> height;

  std::int64_t TotalCounted() const;
  /// Width of the rectangle that stands for a person in a grid of such cells; `width` must have a
  /// value. To the usual width comes the larger of two allowances, for what sticks out of the
  /// rectangle is explained by a second person beside the first, and one that is too wide only
  /// costs a little evidence: 2.5 times the width's spread (19 in 20 people are no wider, of a
  /// normal distribution), and CellAllowance_m.
  double RectangleWidth_m(double cell_m) const;
  /// Height of that rectangle; `height` must have a value. The usual height and 1.5 times its
  /// spread, for silhouettes lose feet and heads more often than they gain any.
  double RectangleHeight_m() const;
};

/// Measures people in masks, so that the rectangles of the occupancy stage have the size that
/// people have there: not of bodies, but of what a detector or background subtraction makes of
/// them.
///
/// A *figure* is a connected component of a mask that does not touch the picture's edge. Its
/// rectangle is the one that it fills best: of a silhouette's bounding box outer rows and columns
/// are left out that are mostly empty. Its foot (the middle of the lower edge) is on the ground
/// inside the area, and an upright figure between 0.8 and 2.6 m high, 0.15 to 0.8 times as wide,
/// would fill it.
///
/// Two people who hide each other make one component, and one person may fall into pieces. With
/// several cameras only those figures count that another camera saw no farther than 0.5 m away, and
/// equally high to 15 %, at the same moment; where such figures are too few (views that do not
/// overlap), all do. Of those that count the height is found as a RobustLength, and the width from
/// those within the half that gave the height: nearly half of the figures may be wrong.
class PersonSizeMeter {
 public:
  /// Fewer figures than this say nothing.
  static constexpr std::int64_t kFewest = 40;

  /// Each camera is of its masks' size.
  PersonSizeMeter(std::vector<Camera> cameras, Polygon area, PersonOptions::Shape shape);

  /// The masks of one moment, one per camera: CV_8UC1 of the camera's size, 128 and more is
  /// foreground; empty where a camera has none now. Fails when a mask is something else.
  Status Add(std::span<const cv::Mat> masks);

  /// What was found so far.
  PersonSizeReport Report() const;

 private:
  struct Figure {
    std::size_t camera = 0;
    PersonInBox person;
    bool confirmed = false;
  };

  std::vector<Camera> cameras_;
  Polygon area_;
  PersonOptions::Shape shape_;
  std::int64_t frames_ = 0;
  std::vector<Figure> figures_;
};

}  // namespace vantage
