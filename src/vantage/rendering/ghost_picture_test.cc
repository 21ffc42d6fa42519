// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/ghost_picture.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace vantage {
namespace {

JudgedComponent Judged(const cv::Rect& box, bool ghost) {
  cv::Mat pixels(box.size(), CV_8UC1, cv::Scalar(255));
  return {.component = {.box = box, .area_px = box.area(), .window = box, .pixels = pixels},
          .value = ghost ? 0.01 : 0.42,
          .ghost = ghost};
}

/// How often a colour occurs, exactly.
int CountOf(const cv::Mat& picture, const cv::Scalar& color) {
  cv::Mat found;
  cv::inRange(picture, color, color, found);
  return cv::countNonZero(found);
}

TEST(GhostPicture, OutlinesObjectsGhostsAndAbsorbedOnesInTheirColours) {
  const cv::Scalar valid(90, 200, 60), ghost(0, 165, 255), absorbed(60, 60, 230);
  for (const cv::Size size : {cv::Size(320, 200), cv::Size(800, 600)}) {
    const int scale = size.width < 640 ? 2 : 1;
    const cv::Mat frame(size, CV_8UC3, cv::Scalar(100, 100, 100));
    const cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
    GhostVerdict verdict;
    verdict.judged = {Judged({40, 60, 20, 50}, false)};
    cv::Mat picture = DrawGhosts(frame, mask, verdict);
    EXPECT_EQ(picture.size(), size * scale);
    EXPECT_GE(CountOf(picture, valid), 2 * (20 + 50) * scale - 4);
    EXPECT_EQ(CountOf(picture, ghost) + CountOf(picture, absorbed), 0);

    verdict.judged.push_back(Judged({120, 60, 20, 50}, true));
    picture = DrawGhosts(frame, mask, verdict);
    EXPECT_GE(CountOf(picture, ghost), 2 * (20 + 50) * scale - 4);
    EXPECT_EQ(CountOf(picture, absorbed), 0);

    verdict.ghosts = mask.clone();
    verdict.ghosts(cv::Rect(120, 60, 20, 50)) = 255;
    picture = DrawGhosts(frame, mask, verdict);
    EXPECT_EQ(CountOf(picture, ghost), 0);
    EXPECT_GE(CountOf(picture, absorbed), 2 * (20 + 50) * scale - 4);
  }
}

TEST(GhostPicture, TintsTheForegroundOnly) {
  const cv::Mat frame(60, 80, CV_8UC3, cv::Scalar(100, 100, 100));
  cv::Mat mask = cv::Mat::zeros(60, 80, CV_8UC1);
  mask(cv::Rect(10, 10, 20, 20)) = 255;
  const cv::Mat picture = DrawGhosts(frame, mask, {});
  EXPECT_EQ(CountOf(picture, {100, 100, 100}), 4 * (60 * 80 - 400));
}

}  // namespace
}  // namespace vantage
