// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/base/result.h"

namespace vantage {

/// Pixels of masks compared with labelled truth (video/sequence.h), one frame or many.
struct MaskCounts {
  std::int64_t frames = 0;
  std::int64_t true_positives = 0;          ///< TP: moving (255) and foreground
  std::int64_t false_positives = 0;         ///< FP: static or shadow (0, 50) and foreground
  std::int64_t false_negatives = 0;         ///< FN: moving and background
  std::int64_t true_negatives = 0;          ///< TN: static or shadow and background
  std::int64_t shadow_px = 0;               ///< with label 50; they are in FP or TN too
  std::int64_t shadow_false_positives = 0;  ///< SE: shadow and foreground; they are in FP too

  MaskCounts& operator+=(const MaskCounts& other);
  friend bool operator==(const MaskCounts&, const MaskCounts&) = default;
};

/// The seven measures of the change-detection benchmark (Goyette et al., 2012; Wang et al., 2014)
/// and its rate of false positives in shadow. Ratios whose denominator is 0 are NaN.
struct MaskMeasures {
  double recall = 0;       ///< TP / (TP + FN)
  double specificity = 0;  ///< TN / (TN + FP)
  double fpr = 0;          ///< FP / (FP + TN)
  double fnr = 0;          ///< FN / (TP + FN)
  double pwc = 0;          ///< percentage of wrong classifications, 100 (FN + FP) / all
  double precision = 0;    ///< TP / (TP + FP)
  /// 2 TP / (2 TP + FP + FN), the harmonic mean of precision and recall where both exist.
  double f1 = 0;
  double shadow_fpr = 0;  ///< SE / shadow
};

/// Compares one mask (CV_8UC1, 128 and above is foreground) with the labels of its truth (CV_8UC1)
/// of the same size. Labels 85 and 170 do not count, nor do pixels where `roi` (CV_8UC1, empty: no
/// restriction) is below 128. Fails on other types, on sizes that differ and on other labels.
Result<MaskCounts> CountMask(const cv::Mat& truth, const cv::Mat& mask,
                             const cv::Mat& roi = cv::Mat());

MaskMeasures MeasureMasks(const MaskCounts& counts);

/// Mean of every measure over the sequences where it is a number: the benchmark's way to put
/// sequences together, in which a small one weighs as much as a large one.
MaskMeasures MeanOf(const std::vector<MaskMeasures>& sequences);

}  // namespace vantage
