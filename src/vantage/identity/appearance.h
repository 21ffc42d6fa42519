// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/geometry/camera.h"
#include "vantage/geometry/person.h"
#include "vantage/occupancy/peaks.h"

namespace vantage {

/// A person's rectangle in a view is cut into this many bands of equal height: feet first, then up
/// to the head.
inline constexpr int kAppearanceBands = 6;

/// Median L*, a*, b* of the person's pixels in each band, lowest band first, on OpenCV's 8-bit
/// scales (0 to 255, a* and b* from 128). NaN: the band is hidden, or nothing of it is foreground.
using BandColors = std::array<float, std::size_t{3} * kAppearanceBands>;

/// How one camera saw one person at one moment.
struct Appearance {
  std::int64_t frame = 0;  ///< counts from the first map
  CellIndex cell = 0;      ///< where the person stood
  int camera = 0;
  BandColors colors = {};
};

/// In ascending order of frames.
using Appearances = std::vector<Appearance>;

/// Gathers colours of people while their pictures are at hand (algorithms.md section 6).
class AppearanceSampler {
 public:
  /// What is known of a camera. `informative` as in CameraView.
  struct View {
    Camera camera;
    cv::Mat informative = {};
  };
  AppearanceSampler(std::vector<View> views, const PersonOptions& person);

  /// Appends the colours of `people` in frame `frame`: of the foreground pixels in each rectangle
  /// that no nearer person's rectangle covers. Pictures (CV_8UC3, BGR) and masks (CV_8UC1, 128 and
  /// more is foreground) are of the cameras' sizes; a camera whose picture or mask is empty has
  /// seen nobody, nor has one anybody whose rectangle is not wholly inside the picture. May be
  /// called by several threads at once.
  void Look(std::int64_t frame, std::span<const cv::Mat> pictures, std::span<const cv::Mat> masks,
            std::span<const Peak> people, Appearances& appearances) const;

 private:
  std::vector<View> views_;
  PersonOptions person_;
};

}  // namespace vantage
