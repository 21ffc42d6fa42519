// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"

namespace vantage {

/// Writes a mask (CV_8UC1) as the PNG file <folder>/<frame as %06d>.png, which OpenMasks reads
/// back. The folder must exist; give a StagedDirectory's so that a set of masks appears whole or
/// not at all. Fails on another type of picture, a negative frame, and when the bytes cannot be
/// written.
Status WriteMask(const std::filesystem::path& folder, FrameIndex frame, const cv::Mat& mask);

}  // namespace vantage
