// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/rehearsal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "vantage/background/subtractor.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;

TEST(SampleBeginning, ReachesTheEndOfTheWindow) {
  const RehearsalOptions options{.rehearsal_secs = 60, .rehearsal_frames = 100};
  const auto planned = [&](std::optional<std::int64_t> frames, double rate) {
    const RehearsalPlan plan = SampleBeginning(options, frames, rate);
    return std::pair(plan.interval, plan.samples);
  };
  EXPECT_EQ(planned(1000, 20), std::pair(std::int64_t{10}, std::int64_t{100}));
  EXPECT_EQ(planned(100000, 20), std::pair(std::int64_t{12}, std::int64_t{100}));
  EXPECT_EQ(planned(std::nullopt, 7), std::pair(std::int64_t{5}, std::int64_t{84}));
  EXPECT_EQ(planned(99, 20), std::pair(std::int64_t{10}, std::int64_t{10}));
  EXPECT_EQ(planned(101, 20), std::pair(std::int64_t{10}, std::int64_t{11}));
  EXPECT_EQ(planned(101, 1), std::pair(std::int64_t{1}, std::int64_t{60}));
  EXPECT_EQ(planned(0, 20).second, 0);
}

TEST(PlanRehearsal, NeitherOfShortRecordingsNorOfStreams) {
  const RehearsalOptions options{.rehearsal_secs = 60, .rehearsal_frames = 100};
  EXPECT_EQ(PlanRehearsal(options, 599, 20).samples, 0);
  EXPECT_EQ(PlanRehearsal(options, 600, 20).samples, 60);
  EXPECT_EQ(PlanRehearsal(options, std::nullopt, 20).samples, 0);
  EXPECT_EQ(PlanRehearsal({.rehearsal_secs = 0}, 1000, 20).samples, 0);
}

constexpr ImageSize kSize{.width = 64, .height = 48};
const cv::Rect kPerson(24, 10, 10, 24);

/// A grey place, and somebody on it.
cv::Mat Frame(std::optional<cv::Rect> person) {
  cv::Mat frame(kSize.height, kSize.width, CV_8UC3, cv::Scalar(90, 90, 90));
  if (person) frame(*person) = cv::Scalar(20, 20, 200);
  return frame;
}

BackgroundSubtractor Create() { return BackgroundSubtractor::Create(kSize, {}).value(); }

TEST(Rehearsal, WhoStandsThereAtFirstIsForegroundAndLeavesNoGhost) {
  BackgroundSubtractor rehearsed = Create();
  BackgroundSubtractor plain = Create();
  cv::Mat mask;
  for (int sample = 0; sample < 20; ++sample) {
    const auto person = sample < 6 ? std::optional(kPerson) : std::nullopt;
    ASSERT_TRUE(rehearsed.Rehearse(Frame(person), mask, 1));
  }
  EXPECT_EQ(rehearsed.report().rehearsed, 20);
  EXPECT_EQ(rehearsed.report().frames, 0);
  ASSERT_TRUE(plain.Apply(Frame(kPerson), mask, 1));
  EXPECT_EQ(cv::countNonZero(mask), 0);
  ASSERT_TRUE(rehearsed.Apply(Frame(kPerson), mask, 1));
  EXPECT_NEAR(cv::countNonZero(mask), kPerson.area(), 20);
  EXPECT_NEAR(cv::countNonZero(mask(kPerson)), kPerson.area(), 20);
  // The place is uncovered.
  ASSERT_TRUE(plain.Apply(Frame({}), mask, 1));
  EXPECT_GT(cv::countNonZero(mask), 0) << "or there is no ghost to avoid";
  ASSERT_TRUE(rehearsed.Apply(Frame({}), mask, 1));
  EXPECT_EQ(cv::countNonZero(mask), 0);
}

TEST(Rehearsal, WhoStaysIsBackground) {
  BackgroundSubtractor subtractor = Create();
  cv::Mat mask;
  for (int sample = 0; sample < 20; ++sample) {
    const auto person = sample < 14 ? std::optional(kPerson) : std::nullopt;
    ASSERT_TRUE(subtractor.Rehearse(Frame(person), mask, 1));
  }
  ASSERT_TRUE(subtractor.Apply(Frame(kPerson), mask, 1));
  EXPECT_EQ(cv::countNonZero(mask), 0);
}

TEST(Rehearsal, MasksOnTheWayShowWhoIsNew) {
  BackgroundSubtractor subtractor = Create();
  cv::Mat mask;
  for (int sample = 0; sample < 10; ++sample) {
    ASSERT_TRUE(subtractor.Rehearse(Frame({}), mask, 1));
    EXPECT_EQ(cv::countNonZero(mask), 0);
  }
  ASSERT_TRUE(subtractor.Rehearse(Frame(kPerson), mask, 1));
  EXPECT_NEAR(cv::countNonZero(mask(kPerson)), kPerson.area(), 20);
}

TEST(Rehearsal, AFewBlackSamplesDoNoHarm) {
  BackgroundSubtractor subtractor = Create();
  cv::Mat mask;
  for (int sample = 0; sample < 20; ++sample) {
    const bool black = sample > 4 && sample < 12;
    ASSERT_TRUE(subtractor.Rehearse(black ? cv::Mat(Frame({}) * 0) : Frame({}), mask, 1));
  }
  ASSERT_TRUE(subtractor.Apply(Frame(kPerson), mask, 1));
  EXPECT_NEAR(cv::countNonZero(mask), kPerson.area(), 20);
  EXPECT_TRUE(subtractor.reliable());
}

TEST(Rehearsal, RefusesFramesOfAnotherSize) {
  BackgroundSubtractor subtractor = Create();
  cv::Mat mask;
  EXPECT_THAT(MessageOf(subtractor.Rehearse(cv::Mat(10, 10, CV_8UC3), mask, 1)),
              HasSubstr("10x10"));
}

}  // namespace
}  // namespace vantage
