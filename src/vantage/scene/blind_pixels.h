// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/geometry/camera.h"
#include "vantage/scene/toml_table.h"

namespace vantage::internal {

/// Reads the key `blind` of a [[cameras]] table: polygons in pixels, or the path of a picture that
/// is not black where the camera is blind (relative to `folder`; added to `inputs`). CV_8UC1 of
/// `size`, 255 where blind; empty when no pixel is. A pixel that a polygon covers or touches is
/// blind. Fails on a picture of another size, on a polygon with fewer than 3 corners or one outside
/// the picture, and when no pixel is left to see by.
Result<cv::Mat> ReadBlindPixels(const TableReader& table, const std::filesystem::path& folder,
                                ImageSize size, std::vector<std::filesystem::path>& inputs);

}  // namespace vantage::internal
