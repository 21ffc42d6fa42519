// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/scene/scene.h"

namespace vantage {

/// What all sources of a scene (pictures or masks) deliver at one frame; empty where a camera has
/// nothing there.
Result<std::vector<cv::Mat>> FramePictures(const Scene& scene, FrameIndex frame, int threads);

}  // namespace vantage
