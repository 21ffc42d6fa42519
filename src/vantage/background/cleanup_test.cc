// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/cleanup.h"

#include <gmock/gmock.h>

#include <cstdint>
#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;

cv::Mat PersonAndSpecks() {
  cv::Mat mask = cv::Mat::zeros(100, 80, CV_8UC1);
  mask(cv::Rect(20, 10, 20, 60)) = 255;
  mask(cv::Rect(20, 30, 20, 2)) = 0;    // cut in two by a belt
  mask.at<std::uint8_t>(90, 70) = 255;  // a speck
  mask(cv::Rect(60, 20, 5, 5)) = 255;   // a blob
  return mask;
}

TEST(Cleanup, DefaultsRemoveNoiseAndKeepAPersonWhole) {
  cv::Mat mask = PersonAndSpecks();
  ASSERT_TRUE(CleanMask(mask, {}));
  EXPECT_EQ(mask.at<std::uint8_t>(90, 70), 0);
  EXPECT_EQ(mask.at<std::uint8_t>(22, 62), 0);
  EXPECT_EQ(mask.at<std::uint8_t>(31, 30), 255);
  EXPECT_NEAR(cv::countNonZero(mask), 20 * 60, 20);
}

TEST(Cleanup, EachStepCanBeOff) {
  const CleanupOptions off{.open_px = 0, .close_px = 0, .min_area_px = 0};
  cv::Mat mask = PersonAndSpecks();
  ASSERT_TRUE(CleanMask(mask, off));
  EXPECT_EQ(cv::norm(mask, PersonAndSpecks(), cv::NORM_INF), 0);

  CleanupOptions options = off;
  options.open_px = 1;
  ASSERT_TRUE(CleanMask(mask, options));
  EXPECT_EQ(mask.at<std::uint8_t>(90, 70), 0);
  EXPECT_EQ(mask.at<std::uint8_t>(22, 62), 255);
  EXPECT_EQ(mask.at<std::uint8_t>(31, 30), 0);

  mask = PersonAndSpecks();
  options = off;
  options.close_px = 2;
  ASSERT_TRUE(CleanMask(mask, options));
  EXPECT_EQ(mask.at<std::uint8_t>(90, 70), 255);
  EXPECT_EQ(mask.at<std::uint8_t>(31, 30), 255);

  mask = PersonAndSpecks();
  options = off;
  options.min_area_px = 26;
  ASSERT_TRUE(CleanMask(mask, options));
  EXPECT_EQ(mask.at<std::uint8_t>(90, 70), 0);
  EXPECT_EQ(mask.at<std::uint8_t>(22, 62), 0);
  EXPECT_EQ(cv::countNonZero(mask), 20 * 58);
}

TEST(Cleanup, TakesOnePixelAndRefusesWhatIsNoMask) {
  cv::Mat pixel(1, 1, CV_8UC1, cv::Scalar(255));
  EXPECT_TRUE(CleanMask(pixel, {}));
  cv::Mat colored(4, 4, CV_8UC3);
  EXPECT_THAT(MessageOf(CleanMask(colored, {})), HasSubstr("type CV_8UC3; it must be"));
  cv::Mat empty;
  EXPECT_THAT(MessageOf(CleanMask(empty, {})), HasSubstr("0x0 px"));
  EXPECT_EQ(MessageOf(CleanMask(pixel, {.open_px = -1})),
            "background.open is -1; it must be between 0 and 50 px");
}

}  // namespace
}  // namespace vantage
