// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "vantage/background/mixture.h"
#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"

namespace vantage {

/// What the background stage asks of an algorithm: the mask, "absorb these pixels", and, for the
/// ghost criteria FEP, FER and NB, the background picture. Ghost detection, the answers to
/// disturbances and the clean-up then work around it unchanged. One object per camera; never used
/// from two threads at once. examples/own_subtractor.cc is one.
class BackgroundMethod {
 public:
  virtual ~BackgroundMethod() = default;

  /// One step. `bgr` is CV_8UC3, always of one size; `mask` becomes CV_8UC1 of that size, 255
  /// foreground, else 0. `held` is empty or CV_8UC1 of that size, not 0 where an object is known to
  /// stand, which should not fade into the background; a method that cannot hold it ignores it.
  virtual Status Apply(const cv::Mat& bgr, const cv::Mat& held, cv::Mat& mask, int threads) = 0;

  /// The colours that the last frame has where `pixels` (CV_8UC1) is not 0 are background from the
  /// next frame on.
  virtual Status Absorb(const cv::Mat& pixels) = 0;

  /// The background inside `region`, CV_8UC3 blue green red; empty where the method has none.
  virtual cv::Mat BackgroundImage(const cv::Rect& region) const;

  /// After a sudden change of light: multiplies the background's levels by `gain` (CV_32FC3). False
  /// where the method cannot; it is then restarted.
  virtual Result<bool> Relight(const cv::Mat& gain, int threads);

  /// Forgets all: the next frame is the first. Does nothing where the method cannot.
  virtual void Restart();
};

enum class MethodKind {
  kMixture,  ///< MixtureModel
  kMog2,     ///< OpenCV's MOG2 at its defaults (Zivkovic 2004)
  kKnn,      ///< OpenCV's KNN at its defaults (Zivkovic and van der Heijden 2006)
};

/// `options` are for the mixture.
Result<std::unique_ptr<BackgroundMethod>> CreateMethod(MethodKind kind, ImageSize size,
                                                       const MixtureOptions& options);

}  // namespace vantage
