// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string_view>

#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"

/// Internal to the video module: single pictures, checked before and after decoding.

namespace vantage::internal {

/// Fails unless the sides are 1 to 32768 pixels and the area is at most 100 million.
Status CheckPictureSize(std::string_view name, std::int64_t width, std::int64_t height);

/// Size that the header of a PNG, JPEG, BMP or PNM picture declares, checked as above, so that no
/// memory is spent on a hostile one.
Result<ImageSize> PictureSize(const std::filesystem::path& path);

/// Decodes a PNG, JPEG, BMP or PNM picture into 8-bit BGR (CV_8UC3): grey is spread over the three
/// channels, 16 bits are scaled to 8, transparency is dropped. Fails on a truncated picture.
Result<cv::Mat> ReadPicture(const std::filesystem::path& path);

/// The largest difference between two channels of a pixel of a CV_8UC3 picture: 0 when it is grey,
/// at most kChannelNoise when it was grey before lossy compression.
double LargestChannelDifference(const cv::Mat& picture);
constexpr double kChannelNoise = 16;

/// True for the names of pictures that ReadPicture may read (.png .jpg .jpeg .bmp .pgm .ppm).
bool HasPictureExtension(const std::filesystem::path& path);

}  // namespace vantage::internal
