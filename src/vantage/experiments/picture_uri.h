// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>

#include "vantage/base/result.h"

namespace vantage {

enum class PictureFormat {
  kJpeg,  ///< photographs
  kPng,   ///< masks, maps and drawings
};

/// A picture (8 bits a channel, 1 or 3 channels) as a data URI, for pages that stand alone and for
/// results of cells. Pictures wider than `max_width_px` are reduced to that. Fails on other types
/// and on an empty picture.
Result<std::string> PictureUri(const cv::Mat& picture, PictureFormat format,
                               int max_width_px = 640);

/// RFC 4648.
std::string Base64(std::string_view bytes);

}  // namespace vantage
