// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

namespace vantage::drawing {
namespace {

const cv::Scalar kWhite = {255, 255, 255};

cv::Mat Black(int width, int height) {
  return cv::Mat(height, width, CV_8UC3, cv::Scalar(0, 0, 0));
}
int At(const cv::Mat& image, int x, int y) { return image.at<cv::Vec3b>(y, x)[0]; }
bool Untouched(const cv::Mat& image) { return cv::countNonZero(image.reshape(1)) == 0; }

TEST(Drawing, LineHasItsOpacity) {
  cv::Mat image = Black(40, 20);
  Line(image, {5, 10}, {35, 10}, kWhite, 3, 0.5);
  EXPECT_NEAR(At(image, 20, 10), 127, 3);
  EXPECT_EQ(At(image, 20, 15), 0);
  EXPECT_EQ(At(image, 20, 5), 0);
}

TEST(Drawing, FadingLineGrowsStronger) {
  cv::Mat image = Black(100, 20);
  std::vector<cv::Point2d> points;
  std::vector<double> opacity;
  for (int i = 0; i <= 10; ++i) {
    points.emplace_back(5 + 9 * i, 10);
    opacity.push_back(0.1 * i);
  }
  FadingLine(image, points, opacity, kWhite, 2);
  EXPECT_LT(At(image, 10, 10), At(image, 50, 10));
  EXPECT_LT(At(image, 50, 10), At(image, 90, 10));
}

TEST(Drawing, AnUnknownPointInterruptsTheLine) {
  cv::Mat image = Black(100, 20);
  const double nowhere = std::nan("");
  FadingLine(image, {{5, 10}, {30, 10}, {nowhere, nowhere}, {60, 10}, {95, 10}}, {1, 1, 1, 1, 1},
             kWhite, 2);
  EXPECT_GT(At(image, 20, 10), 200);
  EXPECT_EQ(At(image, 45, 10), 0);
  EXPECT_GT(At(image, 80, 10), 200);
}

TEST(Drawing, WhatCrossesThePictureFromFarOutsideIsRight) {
  cv::Mat image = Black(40, 40);
  Line(image, {-1e9, 20}, {1e9, 20}, kWhite, 2);
  EXPECT_GT(At(image, 0, 20), 200);
  EXPECT_GT(At(image, 39, 20), 200);
  EXPECT_EQ(At(image, 20, 30), 0);
}

TEST(Drawing, NothingIsDrawnFarOutsideOrNowhere) {
  cv::Mat image = Black(40, 40);
  constexpr double kFar = 1e12;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double nowhere = std::nan("");
  for (const double x : {-kFar, -500.0, 500.0, kFar, kInfinity, nowhere}) {
    for (const double y : {-kFar, 20.0, kFar, nowhere}) {
      Line(image, {x, y}, {x, y + 1}, kWhite, 5);
      Rectangle(image, {x, y, 10, 10}, kWhite, 3);
      FilledRectangle(image, {x, y, 10, 10}, kWhite);
      Disc(image, {x, y}, 10, kWhite);
      Polygon(image, {{x, y}, {x + 5, y}, {x, y + 5}}, kWhite, 0);
      Polygon(image, {{x, y}, {x + 5, y}, {x, y + 5}}, kWhite, 2);
      Text(image, "text", {x, y}, {.halo_px = 2});
    }
  }
  EXPECT_TRUE(Untouched(image));
  FadingLine(image, {}, {}, kWhite, 2);
  EXPECT_TRUE(Untouched(image));
}

TEST(Drawing, PartsOutsideAreClipped) {
  for (const cv::Point2d& at : {cv::Point2d(0, 0), {39, 0}, {0, 39}, {39, 39}}) {
    cv::Mat image = Black(40, 40);
    Disc(image, at, 12, kWhite);
    Text(image, "8888", at, {.anchor = Anchor::kCenter, .halo_px = 2});
    FilledRectangle(image, {at.x - 4, at.y - 4, 8, 8}, kWhite);
    EXPECT_GT(At(image, int(at.x), int(at.y)), 200);
    EXPECT_EQ(At(image, 20, 20), 0);
  }
}

TEST(Drawing, FilledRectangleCoversItsPixels) {
  cv::Mat image = Black(20, 20);
  FilledRectangle(image, {5, 6, 4, 3}, kWhite);
  EXPECT_EQ(cv::countNonZero(image.reshape(1)), 3 * 4 * 3);
  EXPECT_EQ(At(image, 5, 6), 255);
  EXPECT_EQ(At(image, 8, 8), 255);
}

TEST(Drawing, TextStandsOnItsBaseLineAtItsAnchor) {
  const TextStyle style{.height_px = 14, .color = kWhite};
  const double width = TextWidth("HELLO", style);
  EXPECT_GT(width, 40);
  const auto bounds = [&](Anchor anchor) {
    cv::Mat image = Black(200, 60);
    TextStyle anchored = style;
    anchored.anchor = anchor;
    Text(image, "HELLO", {100, 40}, anchored);
    cv::Mat found;
    cv::extractChannel(image, found, 0);
    cv::Mat points;
    cv::findNonZero(found > 100, points);
    double low = 1e9, high = -1e9, top = 1e9, bottom = -1e9;
    for (int i = 0; i < points.rows; ++i) {
      const cv::Point p = points.at<cv::Point>(i);
      low = std::min<double>(low, p.x);
      high = std::max<double>(high, p.x);
      top = std::min<double>(top, p.y);
      bottom = std::max<double>(bottom, p.y);
    }
    EXPECT_NEAR(bottom, 40, 1.5);
    EXPECT_NEAR(top, 26, 1.5);
    return std::pair(low, high);
  };
  EXPECT_NEAR(bounds(Anchor::kLeft).first, 100, 3);
  EXPECT_NEAR(bounds(Anchor::kRight).second, 100, 5);
  const auto [low, high] = bounds(Anchor::kCenter);
  EXPECT_NEAR((low + high) / 2, 100, 2);
}

TEST(Drawing, MultiplesCoverTheRangeWithItsEnds) {
  EXPECT_THAT(Multiples(2, -4, 5), ::testing::ElementsAre(-4, -2, 0, 2, 4));
  EXPECT_THAT(Multiples(0.5, 0.6, 1), ::testing::ElementsAre(1));
  EXPECT_TRUE(Multiples(10, 1, 9).empty());
}

TEST(Drawing, AnyBytesAreText) {
  cv::Mat image = Black(400, 40);
  Text(image, "caf\xc3\xa9 \xff\x01\n", {10, 30}, {.halo_px = 1});
  EXPECT_FALSE(Untouched(image));
  EXPECT_GT(TextWidth("\xc3\xa9", {}), 0);
}

}  // namespace
}  // namespace vantage::drawing
