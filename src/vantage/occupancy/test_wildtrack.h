// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "vantage/geometry/camera.h"
#include "vantage/geometry/grid.h"
#include "vantage/occupancy/peaks.h"

/// The WILDTRACK recording (T. Chavdarova et al., CVPR 2018) as perfect silhouettes: the annotated
/// boxes, filled, in all views at once. For tests and benchmarks only; not installed.

namespace vantage::testing {

struct WildtrackFrame {
  /// One for each camera, CV_8UC1 of the cameras' size, 0 or 255.
  std::vector<cv::Mat> masks;
  std::vector<Eigen::Vector2d> people_m;
};

class WildtrackData {
 public:
  /// `folder` holds calibrations/ and annotations_positions/; the sides of the masks are those of
  /// the pictures (1920 x 1080) divided by `reduction`, a divisor of 120. Throws where the data are
  /// not what they should be.
  WildtrackData(const std::filesystem::path& folder, int reduction);

  /// Seven, of the size of the masks.
  const std::vector<Camera>& cameras() const { return cameras_; }
  std::size_t frame_count() const { return files_.size(); }
  WildtrackFrame Frame(std::size_t index) const;

  /// The 12 x 36 m on which people are annotated.
  static GroundGrid Grid(double cell_m);

 private:
  int reduction_;
  std::vector<Camera> cameras_;
  std::vector<std::filesystem::path> files_;
};

/// Size of the largest one-to-one matching of detections to people nearer than distance_m.
int CountMatches(std::span<const Peak> peaks, std::span<const Eigen::Vector2d> people_m,
                 double distance_m);

}  // namespace vantage::testing
