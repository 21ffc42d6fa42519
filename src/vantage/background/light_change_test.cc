// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/light_change.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

constexpr int kWidth = 120;
constexpr int kHeight = 88;

cv::Mat TexturedPicture() {
  cv::RNG random(3);
  cv::Mat coarse(kHeight / 8, kWidth / 8, CV_8UC3), picture, noise(kHeight, kWidth, CV_8UC3);
  random.fill(coarse, cv::RNG::UNIFORM, 40, 160);
  random.fill(noise, cv::RNG::UNIFORM, 0, 4);
  cv::resize(coarse, picture, noise.size(), 0, 0, cv::INTER_CUBIC);
  return picture + noise;
}

using Light = std::function<double(int x, int y, int c, double level)>;
cv::Mat InLight(const cv::Mat& picture, const Light& light) {
  cv::Mat lit(picture.size(), CV_8UC3);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        lit.at<cv::Vec3b>(y, x)[c] =
            cv::saturate_cast<std::uint8_t>(light(x, y, c, picture.at<cv::Vec3b>(y, x)[c]));
      }
    }
  }
  return lit;
}

const cv::Mat kAll(kHeight, kWidth, CV_8UC1, cv::Scalar(255));

/// Median over the picture of |gain B - I|.
double MedianError(const LightChange& change, const cv::Mat& background, const cv::Mat& lit) {
  const cv::Mat gain = GainPicture(change, background);
  std::vector<float> errors;
  for (int y = 0; y < lit.rows; ++y) {
    for (int x = 0; x < lit.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        errors.push_back(std::abs(gain.at<cv::Vec3f>(y, x)[c] * background.at<cv::Vec3b>(y, x)[c] -
                                  lit.at<cv::Vec3b>(y, x)[c]));
      }
    }
  }
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  return errors[errors.size() / 2];
}

TEST(LightChange, SamplesStandInTheMiddleOfTheirCells) {
  cv::Mat picture(7, 10, CV_8UC1);
  for (int i = 0; i < 70; ++i) picture.data[i] = static_cast<std::uint8_t>(i);
  const cv::Mat samples = SamplePixels(picture, 3);
  ASSERT_EQ(samples.size(), cv::Size(3, 2));
  EXPECT_EQ(samples.at<std::uint8_t>(0, 0), 11);
  EXPECT_EQ(samples.at<std::uint8_t>(1, 2), 47);
  EXPECT_EQ(cv::norm(SamplePixels(picture, 1), picture, cv::NORM_INF), 0);
}

TEST(LightChange, FindsGainOffsetColourAndSlopeOfTheLight) {
  const cv::Mat background = TexturedPicture();
  const Light lights[] = {
      [](int, int, int, double level) { return 0.5 * level; },
      [](int, int, int, double level) { return 1.4 * level; },
      [](int, int, int, double level) { return level + 40; },
      [](int, int, int c, double level) { return (0.6 + 0.35 * c) * level; },
      [](int x, int, int, double level) { return (1.6 - x / 120.0) * level; },
      [](int x, int y, int, double level) { return (0.5 + (x + y) / 300.0) * level + 10; },
  };
  for (const Light& light : lights) {
    const int which = static_cast<int>(&light - lights);
    const cv::Mat lit = InLight(background, light);
    const LightChange change = EstimateLightChange(lit, background, kAll, cv::Mat());
    EXPECT_LT(MedianError(change, background, lit), 3) << "light " << which;
    EXPECT_GT(change.explained, 0.95) << "light " << which;
    EXPECT_GT(change.changed, 0.6) << "light " << which;
    EXPECT_GT(change.structure, 0.9) << "light " << which;
  }
}

TEST(LightChange, PeopleInFrontAreOutvoted) {
  const cv::Mat background = TexturedPicture();
  const cv::Mat alone =
      InLight(background, [](int, int, int, double level) { return 0.6 * level; });
  cv::Mat lit = alone.clone();
  for (const int x : {6, 40, 90}) lit(cv::Rect(x, 20, 18, 60)) = cv::Scalar(20, 15, 90);
  const LightChange change = EstimateLightChange(lit, background, kAll, cv::Mat());
  // What stands behind the people is predicted, not they.
  const cv::Mat gain = GainPicture(change, background);
  for (const int x : {15, 49, 99}) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(gain.at<cv::Vec3f>(50, x)[c], 0.6, 0.06) << x;
  }
}

TEST(LightChange, AnotherViewIsNoLight) {
  const cv::Mat background = TexturedPicture();
  cv::Mat other;
  cv::flip(background, other, -1);
  EXPECT_LT(EstimateLightChange(other, background, kAll, cv::Mat()).structure, 0.3);
  const cv::Mat flat(background.size(), CV_8UC3, cv::Scalar(60, 70, 190));
  EXPECT_LT(EstimateLightChange(flat, background, kAll, cv::Mat()).structure, 0.3);
  EXPECT_EQ(EstimateLightChange(background, background, kAll, cv::Mat()).changed, 0);
}

TEST(LightChange, GainsStayFiniteWhereNothingCanBeSaid) {
  const cv::Mat black = cv::Mat::zeros(16, 16, CV_8UC3);
  const cv::Mat white(16, 16, CV_8UC3, cv::Scalar::all(255));
  const cv::Mat mask(16, 16, CV_8UC1, cv::Scalar(255));
  for (const auto& [frame, background] : {std::pair{black, white}, std::pair{white, black},
                                          std::pair{black, black}, std::pair{white, white}}) {
    for (const cv::Mat& ignored : {cv::Mat(), mask}) {
      const LightChange change = EstimateLightChange(frame, background, mask, ignored);
      EXPECT_EQ(change.explained, 0);
      EXPECT_TRUE(cv::checkRange(GainPicture(change, background), true, nullptr, 1.0 / 64, 64));
    }
  }
}

}  // namespace
}  // namespace vantage
