// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/picture_uri.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace vantage {

std::string Base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      group = group << 8 | (i < count ? static_cast<unsigned char>(bytes[at + i]) : 0u);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      text += i <= count ? kDigits[group >> (18 - 6 * i) & 63u] : '=';
    }
  }
  return text;
}

Result<std::string> PictureUri(const cv::Mat& picture, PictureFormat format, int max_width_px) {
  if (picture.empty() || (picture.type() != CV_8UC1 && picture.type() != CV_8UC3)) {
    return Fail("a picture for a page must have 8 bits a channel and 1 or 3 channels");
  }
  cv::Mat shown = picture;
  if (picture.cols > max_width_px) {
    const double factor = static_cast<double>(max_width_px) / picture.cols;
    const int height = std::max(1, cvRound(picture.rows * factor));
    cv::resize(picture, shown, {max_width_px, height}, 0, 0, cv::INTER_AREA);
  }
  std::vector<unsigned char> bytes;
  const bool jpeg = format == PictureFormat::kJpeg;
  try {
    const std::vector<int> settings = {
        jpeg ? cv::IMWRITE_JPEG_QUALITY : cv::IMWRITE_PNG_COMPRESSION, jpeg ? 85 : 9};
    if (!cv::imencode(jpeg ? ".jpg" : ".png", shown, bytes, settings)) {
      return Fail("a picture for a page cannot be encoded");
    }
  } catch (const cv::Exception& error) {
    return Fail("a picture for a page cannot be encoded: {}", error.what());
  }
  return fmt::format("data:image/{};base64,{}", jpeg ? "jpeg" : "png",
                     Base64(std::string(bytes.begin(), bytes.end())));
}

}  // namespace vantage
