// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <vector>

#include "vantage/background/mixture.h"
#include "vantage/background/test_frames.h"
#include "vantage/base/test_support.h"

/// What others tell the model: pixels that are held, a change of light, a new start.

namespace vantage {
namespace {

using testing::Flat;
using testing::FlickeringFrames;
using ::testing::HasSubstr;
using testing::MessageOf;

TEST(MixtureControl, WhatIsHeldStaysForegroundUntilItIsLetGo) {
  for (const LearningRate rate : {LearningRate::kModified, LearningRate::kOriginal}) {
    MixtureOptions options;
    options.rate = rate;
    options.alpha = 0.02;  // takes 35 frames to absorb
    const ImageSize size{40, 2};
    auto model = MixtureModel::Create(size, options);
    ASSERT_TRUE(model);
    const cv::Rect place(10, 0, 11, 2);
    const cv::Mat floor = Flat(size, {90, 90, 90});
    cv::Mat person = floor.clone();
    person(place) = cv::Scalar(200, 180, 90);
    cv::Mat held(2, 40, CV_8UC1, cv::Scalar(0));
    held(place) = 1;
    cv::Mat mask;
    for (int t = 0; t < 200; ++t) ASSERT_TRUE(model->Apply(floor, mask, 1, held));
    for (int t = 0; t < 1500; ++t) {  // the scale of the weights is renewed on the way
      ASSERT_TRUE(model->Apply(person, mask, 1, held));
      ASSERT_EQ(cv::countNonZero(mask), place.area()) << t;
      ASSERT_EQ(cv::countNonZero(mask(place)), place.area()) << t;
    }
    EXPECT_EQ(cv::norm(model->BackgroundImage(), floor, cv::NORM_INF), 0);
    MixtureModel unveiled = *model;
    ASSERT_TRUE(unveiled.Apply(floor, mask, 1, held));
    EXPECT_EQ(cv::countNonZero(mask), 0) << "the floor is still known";
    int foreground = 0;
    for (mask = 255; cv::countNonZero(mask) > 0 && foreground < 100; ++foreground) {
      ASSERT_TRUE(model->Apply(person, mask, 1));
    }
    // From the initial weight, as if the person had come just now.
    EXPECT_NEAR(foreground, std::log(0.5 * 1.05) / std::log(0.98), 4);
  }
}

TEST(MixtureControl, BackgroundThatIsHeldLearnsAsEverywhere) {
  auto model = MixtureModel::Create({4, 1}, {});
  ASSERT_TRUE(model);
  const cv::Mat held(1, 4, CV_8UC1, cv::Scalar(255));
  cv::Mat mask;
  for (int t = 0; t < 2000; ++t) {
    const cv::Mat frame = Flat({4, 1}, cv::Scalar::all(t < 10 ? 100 : 106));
    ASSERT_TRUE(model->Apply(frame, mask, 1, held));
    ASSERT_EQ(cv::countNonZero(mask), 0);
  }
  EXPECT_EQ(model->BackgroundImage().data[0], 106);
}

TEST(MixtureControl, RelightMultipliesTheLevelsOfTheModel) {
  for (const ColorSpace color : {ColorSpace::kLuv, ColorSpace::kRgb}) {
    MixtureOptions options;
    options.color = color;
    const ImageSize size{37, 11};
    const std::vector<cv::Mat> frames = FlickeringFrames(size, 40, 3);
    auto model = MixtureModel::Create(size, options);
    ASSERT_TRUE(model);
    cv::Mat mask;
    for (const cv::Mat& frame : frames) ASSERT_TRUE(model->Apply(frame, mask, 1));
    const cv::Mat before = model->BackgroundImage();
    cv::Mat gain(11, 37, CV_32FC3, cv::Scalar(1.5, 0.8, 1.2));
    gain.colRange(20, 37) = cv::Scalar::all(1);
    MixtureModel other = *model;
    ASSERT_TRUE(model->Relight(gain, 1));
    ASSERT_TRUE(other.Relight(gain, 2));
    const cv::Mat after = model->BackgroundImage();
    EXPECT_EQ(cv::norm(after, other.BackgroundImage(), cv::NORM_INF), 0);
    cv::Mat expected;
    before.convertTo(expected, CV_32F);
    cv::multiply(expected, gain, expected);
    expected.convertTo(expected, CV_8U);
    EXPECT_LE(cv::norm(after, expected, cv::NORM_INF), 2);
    EXPECT_LE(cv::norm(after.colRange(20, 37), before.colRange(20, 37), cv::NORM_INF), 0);
    cv::Mat lit;
    frames.back().convertTo(lit, CV_32F);
    cv::multiply(lit, gain, lit);
    lit.convertTo(lit, CV_8U);
    cv::Mat lit_mask;
    ASSERT_TRUE(model->Apply(lit, lit_mask, 1));
    ASSERT_TRUE(MixtureModel(other).Apply(frames.back(), mask, 1));
    EXPECT_GT(cv::countNonZero(mask.colRange(0, 20)),
              2 * cv::countNonZero(lit_mask.colRange(0, 20)));
  }
}

TEST(MixtureControl, RelightRefusesWhatNoLightDoes) {
  auto model = MixtureModel::Create({8, 6}, {});
  ASSERT_TRUE(model);
  EXPECT_EQ(MessageOf(model->Relight(cv::Mat(6, 7, CV_32FC3, cv::Scalar::all(1)), 1)),
            "background: the factors of the light are 7x6 px of type CV_32FC3; they must be 8x6 px "
            "of type CV_32FC3");
  EXPECT_THAT(MessageOf(model->Relight(cv::Mat(), 1)), HasSubstr("8x6 px"));
  for (const double wrong : {-0.5, std::nan(""), double{std::numeric_limits<float>::infinity()}}) {
    cv::Mat gain(6, 8, CV_32FC3, cv::Scalar::all(1));
    gain.at<cv::Vec3f>(3, 5)[1] = static_cast<float>(wrong);
    EXPECT_THAT(MessageOf(model->Relight(gain, 1)), HasSubstr("the light at (5, 3)"));
  }
}

TEST(MixtureControl, RestartMakesTheModelNew) {
  const ImageSize size{23, 5};
  auto model = MixtureModel::Create(size, {});
  ASSERT_TRUE(model);
  cv::Mat mask, fresh_mask;
  for (const cv::Mat& frame : FlickeringFrames(size, 50, 1)) {
    ASSERT_TRUE(model->Apply(frame, mask, 1));
  }
  model->Restart();
  auto fresh = MixtureModel::Create(size, {});
  ASSERT_TRUE(fresh);
  for (const cv::Mat& frame : FlickeringFrames(size, 50, 2)) {
    ASSERT_TRUE(model->Apply(frame, mask, 1));
    ASSERT_TRUE(fresh->Apply(frame, fresh_mask, 1));
    ASSERT_EQ(cv::norm(mask, fresh_mask, cv::NORM_INF), 0);
  }
  EXPECT_EQ(cv::norm(model->BackgroundImage(), fresh->BackgroundImage(), cv::NORM_INF), 0);
  EXPECT_EQ(model->frames(), 100);
}

}  // namespace
}  // namespace vantage
