// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/linking/alternatives.h"
#include "vantage/linking/linker.h"
#include "vantage/occupancy/maps.h"
#include "vantage/rendering/plan.h"
#include "vantage/scene/scene.h"

namespace vantage {

/// Explains how paths were found: the maps from above (yellow, opacity by the square root of the
/// probability) and the paths through them, numbered from 1, in the colours of these numbers.
/// A path is a solid line between the cells where the maps show somebody, a dashed one where it was
/// inferred; a ring is its beginning, a cross its end. Pictures are CV_8UC3.
class LinkingPicture {
 public:
  /// `scene`: its area, doors and obstacles are drawn; a scene without an area: the maps' own.
  /// `maps` and `paths` must outlive the picture; the paths fit the maps. `support` as in
  /// TrackOptions.
  LinkingPicture(const Scene& scene, const OccupancyMaps& maps,
                 const std::vector<LinkedPath>& paths, double support);

  /// One frame, counted from the maps' first: a ring around everybody, thin where inferred, and the
  /// ways since `since`.
  cv::Mat DrawFrame(std::int64_t frame, std::int64_t since) const;

  /// The stretch that `alternatives` are about: of every cell its highest probability, the paths,
  /// and where each is weakest, as a diamond with the margin.
  cv::Mat DrawStretch(const Stretch& stretch, const Alternatives& alternatives) const;

 private:
  cv::Mat DrawMap(std::span<const float> q) const;
  void DrawPath(cv::Mat& plan, std::size_t path, std::int64_t first, std::int64_t last) const;
  void DrawWeakStep(cv::Mat& plan, const PathInStretch& path) const;
  cv::Point2d PixelOf(CellIndex cell) const;
  double CellPx() const;

  const OccupancyMaps& maps_;
  const std::vector<LinkedPath>& paths_;
  double support_;
  std::string name_;
  Plan plan_;
};

}  // namespace vantage
