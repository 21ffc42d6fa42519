// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/shadows.h"

#include <gmock/gmock.h>

#include <cstdint>
#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;

const ShadowOptions kOn{.enabled = true, .tau = 0.5, .color_levels = 10};

/// Whether a foreground pixel of colour `seen` before `behind` is taken out as a shadow.
bool TakenOut(const cv::Vec3b& seen, const cv::Vec3b& behind, const ShadowOptions& options = kOn) {
  const cv::Mat frame(1, 1, CV_8UC3, cv::Scalar(seen));
  const cv::Mat background(1, 1, CV_8UC3, cv::Scalar(behind));
  cv::Mat mask(1, 1, CV_8UC1, cv::Scalar(255));
  const auto taken = RejectShadows(
      frame, mask, [&](const cv::Rect&) { return background; }, options);
  EXPECT_TRUE(taken) << MessageOf(taken);
  EXPECT_EQ(taken.value_or(-1), mask.at<std::uint8_t>(0, 0) == 0 ? 1 : 0);
  return mask.at<std::uint8_t>(0, 0) == 0;
}

TEST(Shadows, AShadowIsADarkerBackgroundOfTheSameColour) {
  EXPECT_TRUE(TakenOut({70, 84, 98}, {100, 120, 140}));
  EXPECT_FALSE(TakenOut({40, 48, 56}, {100, 120, 140})) << "too dark";
  EXPECT_FALSE(TakenOut({110, 132, 154}, {100, 120, 140})) << "brighter";
  EXPECT_FALSE(TakenOut({98, 84, 70}, {100, 120, 140})) << "of another colour";
  EXPECT_FALSE(TakenOut({100, 120, 140}, {100, 120, 140})) << "as bright: a = 1";
}

TEST(Shadows, BlackBackgroundAndBlackPixelsStay) {
  EXPECT_FALSE(TakenOut({0, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(TakenOut({30, 30, 30}, {0, 0, 0}));
  EXPECT_FALSE(TakenOut({0, 0, 0}, {90, 90, 90}));
}

TEST(Shadows, OffByOption) {
  ShadowOptions off = kOn;
  off.enabled = false;
  EXPECT_FALSE(TakenOut({70, 84, 98}, {100, 120, 140}, off));
}

/// Against a plain loop over random pictures; only foreground is asked about.
TEST(Shadows, AgreesWithThePlainFormula) {
  cv::RNG random(7);
  cv::Mat background(90, 150, CV_8UC3), shade(90, 150, CV_32FC1), mask(90, 150, CV_8UC1);
  random.fill(background, cv::RNG::UNIFORM, 0, 256);
  random.fill(shade, cv::RNG::UNIFORM, 0.2, 1.3);
  random.fill(mask, cv::RNG::UNIFORM, 0, 2);
  mask *= 255;
  mask(cv::Rect(0, 0, 64, 64)) = 0;
  cv::Mat frame(background.size(), CV_8UC3);
  cv::Mat expected = mask.clone();
  for (int y = 0; y < frame.rows; ++y) {
    for (int x = 0; x < frame.cols; ++x) {
      const cv::Vec3d b = background.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) {
        frame.at<cv::Vec3b>(y, x)[c] =
            cv::saturate_cast<std::uint8_t>(shade.at<float>(y, x) * b[c] + random.uniform(-8, 9));
      }
      const cv::Vec3d i = frame.at<cv::Vec3b>(y, x);
      if (b.dot(b) == 0) continue;
      const double a = i.dot(b) / b.dot(b);
      if (a > kOn.tau && a < 1 && cv::norm(i - a * b) < kOn.color_levels) {
        expected.at<std::uint8_t>(y, x) = 0;
      }
    }
  }
  const int foreground = cv::countNonZero(mask);
  const auto taken = RejectShadows(
      frame, mask,
      [&](const cv::Rect& region) {
        EXPECT_FALSE(region.x == 0 && region.y == 0) << "nothing is foreground there";
        return background(region);
      },
      kOn);
  ASSERT_TRUE(taken) << MessageOf(taken);
  EXPECT_EQ(cv::norm(mask, expected, cv::NORM_INF), 0);
  EXPECT_EQ(*taken, foreground - cv::countNonZero(expected));
  EXPECT_GT(*taken, 1000);
}

TEST(Shadows, RefusesWhatIsNotAFrameAMaskAndABackground) {
  const auto background = [](const cv::Rect& region) { return cv::Mat(region.size(), CV_8UC3); };
  cv::Mat mask(4, 5, CV_8UC1, cv::Scalar(255));
  EXPECT_THAT(MessageOf(RejectShadows(cv::Mat(4, 4, CV_8UC3), mask, background, kOn)),
              HasSubstr("must be of one size"));
  cv::Mat none;
  EXPECT_THAT(MessageOf(RejectShadows(cv::Mat(4, 5, CV_8UC3), none, background, kOn)),
              HasSubstr("must be of one size"));
  EXPECT_THAT(MessageOf(RejectShadows(
                  cv::Mat(4, 5, CV_8UC3), mask, [](const cv::Rect&) { return cv::Mat(); }, kOn)),
              HasSubstr("must be 5x4 px"));
  ShadowOptions wrong = kOn;
  wrong.tau = 1;
  EXPECT_EQ(MessageOf(RejectShadows(cv::Mat(4, 5, CV_8UC3), mask, background, wrong)),
            "background.shadow_tau is 1; it must be above 0 and below 1");
}

}  // namespace
}  // namespace vantage
