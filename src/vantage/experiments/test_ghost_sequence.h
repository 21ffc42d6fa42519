// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "vantage/video/sequence.h"

/// For tests only: a drawn sequence with a ghost.

namespace vantage::testing {

/// A striped box stands before a textured wall from the first frame on and walks off from frame 35:
/// it leaves a ghost. In CDnet's layout, with a region of interest and a temporal range from frame
/// 20 on.
struct GhostSequence {
  static constexpr int kFrames = 80;
  static constexpr int kWidth = 120;
  static constexpr int kHeight = 72;

  static cv::Rect Box(int frame) { return {20 + 2 * std::max(0, frame - 34), 20, 14, 30}; }
  static cv::Mat Truth(int frame) {
    cv::Mat truth(kHeight, kWidth, CV_8UC1, cv::Scalar(TruthLabel::kStatic));
    truth(Box(frame) & cv::Rect(0, 0, kWidth, kHeight)) = TruthLabel::kMoving;
    return truth;
  }
  static cv::Mat Region() {
    cv::Mat region(kHeight, kWidth, CV_8UC1, cv::Scalar(255));
    region.rowRange(0, 4) = 0;
    return region;
  }
  static cv::Mat Picture(int frame) {
    cv::RNG wall_rng(1), rng(static_cast<std::uint64_t>(frame) + 2);
    cv::Mat wall(kHeight, kWidth, CV_8UC3), noise(kHeight, kWidth, CV_8UC3);
    wall_rng.fill(wall, cv::RNG::UNIFORM, 0, 255);
    cv::GaussianBlur(wall, wall, {0, 0}, 6);
    cv::Mat box = wall(Box(frame) & cv::Rect(0, 0, kWidth, kHeight));
    for (int y = 0; y < box.rows; ++y) {
      box.row(y) = y % 10 < 5 ? cv::Scalar(20, 40, 220) : cv::Scalar(230, 60, 30);
    }
    rng.fill(noise, cv::RNG::UNIFORM, 0, 4);
    return wall + noise;
  }

  static void WritePicture(const std::filesystem::path& path, const cv::Mat& picture) {
    EXPECT_TRUE(cv::imwrite(path.string(), picture)) << path;
  }
  static void Write(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder / "input");
    std::filesystem::create_directories(folder / "groundtruth");
    for (int frame = 0; frame < kFrames; ++frame) {
      WritePicture(folder / fmt::format("input/in{:06}.png", frame + 1), Picture(frame));
      WritePicture(folder / fmt::format("groundtruth/gt{:06}.png", frame + 1), Truth(frame));
    }
    WritePicture(folder / "ROI.bmp", Region());
    std::ofstream(folder / "temporalROI.txt") << "21 80";
  }
};

}  // namespace vantage::testing
