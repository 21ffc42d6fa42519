// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "vantage/geometry/camera.h"

/// For tests only.

namespace vantage::testing {

inline cv::Mat Flat(ImageSize size, const cv::Scalar& bgr) {
  return cv::Mat(size.height, size.width, CV_8UC3, bgr);
}

/// Pixels that mostly show one colour, often a second one, sometimes any, all with noise.
inline std::vector<cv::Mat> FlickeringFrames(ImageSize size, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> level(0, 255);
  std::uniform_real_distribution<double> chance(0, 1);
  std::normal_distribution<double> noise(0, 4);
  const int values = size.width * size.height * 3;
  std::vector<int> first(static_cast<size_t>(values)), second(static_cast<size_t>(values));
  for (int& value : first) value = level(random);
  for (int& value : second) value = level(random);
  std::vector<cv::Mat> frames;
  for (int t = 0; t < count; ++t) {
    cv::Mat frame = Flat(size, {});
    for (int i = 0; i < values; i += 3) {
      const double which = chance(random);
      for (int c = i; c < i + 3; ++c) {
        const auto at = static_cast<size_t>(c);
        const int base = which < 0.7 ? first[at] : which < 0.93 ? second[at] : level(random);
        frame.data[c] = cv::saturate_cast<uchar>(base + noise(random));
      }
    }
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace vantage::testing
