// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>

#include "vantage/background/subtractor.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/experiments/labelled_sequence.h"
#include "vantage/metrics/mask_measures.h"

/// How hard the pictures are: the masks of the default settings against the truth.

namespace vantage {

struct DefaultMasks {
  MaskCounts counts;
  /// Of the false positives those that are near somebody: mostly shadows and reflections.
  std::int64_t near_false_positives = 0;

  DefaultMasks& operator+=(const DefaultMasks& other);
};

/// Pixels within half the height of something that moves, about 0.9 m around a person who stands:
/// 255 inside the boxes around the connected components of what is labelled as moving, grown by
/// half their height. CV_8UC1 of the labels' size.
cv::Mat NearMoving(const cv::Mat& labels);

/// Runs a background stage over a sequence, on one thread, and counts all frames that have truth.
Result<DefaultMasks> RunDefaultMasks(LabelledSequence sequence, BackgroundSubtractor subtractor,
                                     const RunControl& control = {});

}  // namespace vantage
