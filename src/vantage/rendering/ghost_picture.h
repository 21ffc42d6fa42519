// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include "vantage/background/ghosts.h"

namespace vantage {

/// Why ghosts are ghosts: the frame `bgr` (CV_8UC3) with its foreground `mask` (CV_8UC1 of its
/// size, before the ghosts were taken out) tinted and every judged component outlined, valid
/// objects green, ghosts orange and, once they are absorbed, red, each with the rule's value.
/// Pictures narrower than 640 px come out twice as large, so that the figures can be read.
cv::Mat DrawGhosts(const cv::Mat& bgr, const cv::Mat& mask, const GhostVerdict& verdict);

}  // namespace vantage
