// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/camera_cells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"
#include "vantage/occupancy/test_problems.h"

namespace vantage {
namespace {

using internal::CameraCells;
using internal::MakeCameraCells;
using internal::MakeForeground;
using testing::PlainAreaAverage;
using testing::RandomNumbers;

cv::Mat RandomMask(RandomNumbers& random, ImageSize size, bool binary) {
  cv::Mat mask(size.height, size.width, CV_8UC1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      mask.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>(binary ? 255 * random.Int(0, 1) : random.Int(0, 255));
    }
  }
  return mask;
}

double LargestDifference(const cv::Mat& image, const cv::Mat_<double>& expected) {
  cv::Mat_<double> converted;
  image.convertTo(converted, CV_64F);
  return cv::norm(converted, expected, cv::NORM_INF);
}

TEST(MakeForeground, AveragesMasksOverExactAreas) {
  RandomNumbers random(1);
  // By 1 to 9 and 300, with each of the fast paths, and by fractions.
  const std::vector<std::pair<ImageSize, ImageSize>> sizes = {
      {{7, 5}, {7, 5}},    {{14, 10}, {7, 5}},  {{21, 15}, {7, 5}},  {{28, 20}, {7, 5}},
      {{40, 24}, {5, 3}},  {{36, 18}, {4, 2}},  {{64, 48}, {13, 9}}, {{50, 31}, {33, 30}},
      {{96, 64}, {6, 16}}, {{300, 600}, {1, 2}}};
  for (const auto& [mask_size, size] : sizes) {
    for (const bool binary : {true, false}) {
      const CameraView view{mask_size, size, {cv::Rect(0, 0, 1, 1)}};
      const CameraCells camera = *MakeCameraCells(view, 0, 1);
      EXPECT_EQ(camera.pixels, size.width * size.height);
      const cv::Mat mask = RandomMask(random, mask_size, binary);
      cv::Mat_<double> shares;
      mask.convertTo(shares, CV_64F, 1.0 / 255);
      const auto foreground = MakeForeground(camera, 0, mask);
      ASSERT_TRUE(foreground && foreground->given());
      EXPECT_LT(LargestDifference(foreground->image, PlainAreaAverage(shares, size)), 2e-6)
          << mask_size.width << " to " << size.width;
    }
  }
}

TEST(MakeForeground, CountsNoBlindPixel) {
  RandomNumbers random(2);
  for (const ImageSize size : {ImageSize{24, 18}, ImageSize{12, 9}, ImageSize{10, 7}}) {
    CameraView view{{24, 18}, size, {cv::Rect(0, 0, 2, 2), cv::Rect(2, 2, 5, 5)}};
    view.informative = RandomMask(random, view.mask_size, true);
    view.informative.setTo(7, view.informative > 0);  // anything above 0 is informative
    const CameraCells camera = *MakeCameraCells(view, 0, 2);
    cv::Mat_<double> informative;
    cv::Mat(view.informative > 0).convertTo(informative, CV_64F, 1.0 / 255);
    const cv::Mat_<double> share = PlainAreaAverage(informative, size);
    EXPECT_LT(LargestDifference(camera.informative_share, share), 2e-6);
    EXPECT_NEAR(camera.pixels, cv::sum(share)[0], 1e-3);
    for (const CameraCells::Cell& c : camera.cells) {
      EXPECT_NEAR(c.area, cv::sum(share(c.rectangle))[0], 1e-4);
    }
    const cv::Mat mask = RandomMask(random, view.mask_size, false);
    cv::Mat_<double> b;
    mask.convertTo(b, CV_64F, 1.0 / 255);
    const cv::Mat image = MakeForeground(camera, 0, mask)->image;
    EXPECT_LT(LargestDifference(image, PlainAreaAverage(b.mul(informative), size)), 2e-6);
    // What the mask says in a blind pixel changes nothing.
    cv::Mat other = mask.clone();
    other.setTo(255, view.informative == 0);
    EXPECT_EQ(cv::norm(MakeForeground(camera, 0, other)->image, image, cv::NORM_INF), 0);
  }
}

TEST(MakeCameraCells, KeepsTheCellsOfWhichItSeesAnything) {
  CameraView view{{20, 10}, {20, 10}, std::vector<cv::Rect>(4, cv::Rect(2, 2, 4, 5))};
  view.rectangles[1] = cv::Rect();
  view.rectangles[3] = cv::Rect(10, 2, 4, 5);
  view.weights = {0.5F, 1, 0, 1};
  view.informative = cv::Mat(10, 20, CV_8UC1, cv::Scalar(255));
  view.informative(cv::Rect(10, 0, 4, 10)) = 0;
  const CameraCells camera = *MakeCameraCells(view, 0, 4);
  ASSERT_EQ(camera.cells.size(), 1U) << "1 is not visible, 2 counts nothing, 3 is blind";
  EXPECT_EQ(camera.cells[0].cell, 0);
  EXPECT_EQ(camera.cells[0].weight, 0.5F);
  EXPECT_EQ(camera.cells[0].rectangle, view.rectangles[0]);
  EXPECT_EQ(camera.pixels, 160);
}

}  // namespace
}  // namespace vantage
