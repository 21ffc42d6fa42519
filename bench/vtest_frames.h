// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/geometry/camera.h"

namespace vantage::bench {

/// Frames of vtest.avi of Debian's package opencv-doc: PETS 2009 S2.L1 View_001.
constexpr ImageSize kVideoSize = {768, 576};
/// The same frames, mirrored at the right and the lower edge until they are as large: that keeps
/// the noise of the camera, which resizing would smooth.
constexpr ImageSize kLargeSize = {960, 768};
/// Enough that a frame is long out of the caches when its turn comes again.
constexpr std::size_t kFrames = 100;

/// Frames of this width; fewer than kFrames where the video is absent.
const std::vector<cv::Mat>& FramesOf(int width);

}  // namespace vantage::bench
