// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <string_view>

#include "vantage/base/result.h"

namespace vantage {

/// What edge-based rules ask of a background algorithm besides its mask: the picture of the
/// background inside a region, CV_8UC3 blue green red of the region's size; an empty picture or
/// function where the algorithm has none.
using BackgroundPicture = std::function<cv::Mat(const cv::Rect& region)>;

/// Fails, in the name of `part`, unless the picture is CV_8UC3 of that size: a caller's own
/// algorithm may be wrong.
Status CheckBackgroundPicture(std::string_view part, const cv::Mat& picture, cv::Size size);

}  // namespace vantage
