// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/components.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <random>

namespace vantage {
namespace {

TEST(Components, LargeOnesInOrderWithTheirWindows) {
  cv::Mat mask = cv::Mat::zeros(40, 60, CV_8UC1);
  mask(cv::Rect(50, 2, 10, 6)) = 255;  // at the picture's edge
  mask(cv::Rect(5, 10, 4, 5)) = 255;
  mask.at<std::uint8_t>(15, 9) = 255;  // touches it at a corner
  mask(cv::Rect(30, 30, 3, 3)) = 255;  // too small
  const std::vector<Component> found = FindComponents(mask, 10, 3);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].box, cv::Rect(50, 2, 10, 6));
  EXPECT_EQ(found[0].window, cv::Rect(47, 0, 13, 11));
  EXPECT_EQ(found[0].area_px, 60);
  EXPECT_EQ(found[1].box, cv::Rect(5, 10, 5, 6));
  EXPECT_EQ(found[1].area_px, 21);
  EXPECT_EQ(found[1].pixels.size(), found[1].window.size());
  EXPECT_EQ(cv::countNonZero(found[1].pixels), 21);
}

TEST(Components, NoneInEmptyMasksAndOneInFullOnes) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(7, 3)}) {
    EXPECT_TRUE(FindComponents(cv::Mat::zeros(size, CV_8UC1), 1, 3).empty());
    const auto found = FindComponents(cv::Mat(size, CV_8UC1, cv::Scalar(255)), 1, 3);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].window, cv::Rect({}, size));
    EXPECT_EQ(cv::countNonZero(BorderOf(found[0], 1).expanded), 0) << "nothing lies outside";
  }
}

/// The definitions of section 2, pixel by pixel.
TEST(Components, BorderRegionsAreAsDefined) {
  std::mt19937 random(5);
  for (int round = 0; round < 40; ++round) {
    cv::Mat mask(12, 14, CV_8UC1);
    for (int i = 0; i < 12 * 14; ++i) mask.data[i] = random() % 100 < 62 ? 255 : 0;
    const int half_width_px = 1 + round % 3;
    for (const Component& component : FindComponents(mask, 1, half_width_px + 1)) {
      const BorderRegions regions = BorderOf(component, half_width_px);
      const cv::Mat& c = component.pixels;
      const cv::Rect inside({}, c.size());
      cv::Mat true_border = cv::Mat::zeros(c.size(), CV_8UC1);
      cv::Mat expanded = cv::Mat::zeros(c.size(), CV_8UC1);
      for (int y = 0; y < c.rows; ++y) {
        for (int x = 0; x < c.cols; ++x) {
          if (c.at<std::uint8_t>(y, x) == 0) continue;
          for (int ny = y - 1; ny <= y + 1; ++ny) {
            for (int nx = x - 1; nx <= x + 1; ++nx) {
              if (inside.contains({nx, ny}) && c.at<std::uint8_t>(ny, nx) == 0) {
                true_border.at<std::uint8_t>(y, x) = 255;
              }
            }
          }
          if (true_border.at<std::uint8_t>(y, x) == 0) continue;
          const int side_px = 2 * half_width_px + 1;
          expanded(cv::Rect(x - half_width_px, y - half_width_px, side_px, side_px) & inside) = 255;
        }
      }
      EXPECT_EQ(cv::norm(regions.true_border, true_border, cv::NORM_INF), 0);
      EXPECT_EQ(cv::norm(regions.expanded, expanded, cv::NORM_INF), 0);
      EXPECT_EQ(cv::norm(regions.expansion, expanded - true_border, cv::NORM_INF), 0);
    }
  }
}

}  // namespace
}  // namespace vantage
