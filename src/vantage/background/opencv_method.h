// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "vantage/background/method.h"

namespace vantage {

/// Absorption for algorithms that offer none: keeps the colours of absorbed pixels beside the
/// algorithm's own model and takes them out of its masks until it has learnt them itself.
class AbsorbedColors {
 public:
  /// Takes `pixels` (CV_8UC1, not 0) of the frame `bgr` (CV_8UC3 of the same size).
  void Add(const cv::Mat& bgr, const cv::Mat& pixels);

  /// Clears what looks as it was absorbed from the algorithm's `mask` of the frame `bgr`. A pixel
  /// that the algorithm itself calls background is forgotten.
  void TakeFrom(const cv::Mat& bgr, cv::Mat& mask);

 private:
  cv::Mat colors_;  ///< CV_8UC3
  cv::Mat known_;   ///< CV_8UC1, 255 where a colour is kept; empty before the first
};

/// MOG2 or KNN of OpenCV at their defaults; what they call a shadow is background. They run on
/// OpenCV's own threads and cannot hold objects nor follow the light.
Result<std::unique_ptr<BackgroundMethod>> CreateOpenCvMethod(MethodKind kind, ImageSize size);

}  // namespace vantage
