// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>

#include "vantage/geometry/camera.h"

/// For tests only.

namespace vantage::testing {

/// Somebody stands at `kStart` from the first frame to `stays`, walks right and waves there; in
/// frame stays + 25 the old place has been empty for ten frames and more.
struct LeavingPerson {
  static constexpr ImageSize kSize{96, 72};
  static inline const cv::Rect kStart{8, 20, 16, 30};

  int stays = 20;

  cv::Rect At(int t) const {
    if (t <= stays) return kStart;
    const int walked_px = std::min(3 * (t - stays), 42);
    return kStart + cv::Point(walked_px + (walked_px == 42 ? t * 3 % 21 : 0), 0);
  }

  cv::Mat FrameAt(int t) const {
    cv::Mat frame(kSize.height, kSize.width, CV_8UC3, cv::Scalar(120, 130, 125));
    frame(cv::Rect(0, 60, 96, 12)) = cv::Scalar(80, 110, 70);
    frame(At(t)) = cv::Scalar(40, 30, 60);
    cv::Mat noise(frame.size(), CV_8UC3);
    cv::RNG random(static_cast<std::uint64_t>(t + 1));
    random.fill(noise, cv::RNG::NORMAL, 10, 2);
    return frame + noise - cv::Scalar::all(10);
  }
};

/// Share of `where` that is foreground.
inline double ForegroundShare(const cv::Mat& mask, const cv::Rect& where) {
  return static_cast<double>(cv::countNonZero(mask(where))) / where.area();
}

}  // namespace vantage::testing
