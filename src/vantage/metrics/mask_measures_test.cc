// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/mask_measures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;

cv::Mat Row(const std::vector<int>& values) {
  cv::Mat row(1, static_cast<int>(values.size()), CV_8UC1);
  for (int column = 0; column < row.cols; ++column) {
    row.at<std::uint8_t>(0, column) =
        static_cast<std::uint8_t>(values[static_cast<std::size_t>(column)]);
  }
  return row;
}

TEST(CountMask, EveryLabelMeetsBothAnswers) {
  const cv::Mat truth = Row({0, 0, 0, 50, 50, 85, 85, 170, 170, 255, 255, 255, 255});
  const cv::Mat mask = Row({0, 0, 255, 0, 255, 0, 255, 0, 255, 0, 255, 255, 255});
  const Result<MaskCounts> counts = CountMask(truth, mask);
  ASSERT_TRUE(counts) << MessageOf(counts);
  EXPECT_EQ(*counts, (MaskCounts{.frames = 1,
                                 .true_positives = 3,
                                 .false_positives = 2,
                                 .false_negatives = 1,
                                 .true_negatives = 3,
                                 .shadow_px = 2,
                                 .shadow_false_positives = 1}));
}

TEST(CountMask, RegionLeavesOutWhatIsNotInside) {
  const cv::Mat truth = Row({0, 255, 0, 255, 50});
  const cv::Mat mask = Row({255, 255, 0, 0, 255});
  const Result<MaskCounts> counts = CountMask(truth, mask, Row({255, 128, 127, 0, 0}));
  ASSERT_TRUE(counts) << MessageOf(counts);
  EXPECT_EQ(*counts, (MaskCounts{.frames = 1, .true_positives = 1, .false_positives = 1}));
}

TEST(CountMask, HalfwayIsForegroundFrom128) {
  const Result<MaskCounts> counts = CountMask(Row({255, 255}), Row({127, 128}));
  ASSERT_TRUE(counts) << MessageOf(counts);
  EXPECT_EQ(counts->true_positives, 1);
  EXPECT_EQ(counts->false_negatives, 1);
}

TEST(CountMask, RefusesWhatItCannotCompare) {
  const cv::Mat row = Row({0, 255});
  EXPECT_THAT(MessageOf(CountMask(Row({0, 255, 0}), row)),
              HasSubstr("the mask has 2 x 1 px, the truth 3 x 1"));
  EXPECT_THAT(MessageOf(CountMask(row, row, Row({255}))),
              HasSubstr("region of interest has 1 x 1"));
  EXPECT_THAT(MessageOf(CountMask(row, cv::Mat(1, 2, CV_8UC3))), HasSubstr("one channel"));
  EXPECT_THAT(MessageOf(CountMask(cv::Mat(1, 2, CV_16UC1), row)), HasSubstr("one channel"));
  EXPECT_THAT(MessageOf(CountMask(row, row, cv::Mat(1, 2, CV_32FC1))), HasSubstr("one channel"));
  // A mask of another convention, 0 and 1, or with the grey edges of scaling.
  EXPECT_THAT(MessageOf(CountMask(Row({0, 1}), row)), HasSubstr("pixel (1, 0) has the label 1"));
  EXPECT_THAT(MessageOf(CountMask(Row({254, 0}), row)), HasSubstr("(0, 0) has the label 254"));
}

TEST(CountMask, NothingCountsInAnEmptyRegion) {
  const Result<MaskCounts> counts = CountMask(Row({0, 255}), Row({0, 255}), Row({0, 0}));
  ASSERT_TRUE(counts) << MessageOf(counts);
  EXPECT_EQ(*counts, MaskCounts{.frames = 1});
}

/// Pixel by pixel, as the benchmark's definition reads.
MaskCounts CountSlowly(const cv::Mat& truth, const cv::Mat& mask, const cv::Mat& roi) {
  MaskCounts counts{.frames = 1};
  for (int row = 0; row < truth.rows; ++row) {
    for (int column = 0; column < truth.cols; ++column) {
      const int label = truth.at<std::uint8_t>(row, column);
      const bool found = mask.at<std::uint8_t>(row, column) >= 128;
      if (label == 85 || label == 170) continue;
      if (!roi.empty() && roi.at<std::uint8_t>(row, column) < 128) continue;
      if (label == 255 && found) ++counts.true_positives;
      if (label == 255 && !found) ++counts.false_negatives;
      if (label != 255 && found) ++counts.false_positives;
      if (label != 255 && !found) ++counts.true_negatives;
      if (label == 50) ++counts.shadow_px;
      if (label == 50 && found) ++counts.shadow_false_positives;
    }
  }
  return counts;
}

RC_GTEST_PROP(CountMask, AgreesWithTheSlowReference, ()) {
  const int rows = *rc::gen::inRange(1, 40);
  const int columns = *rc::gen::inRange(1, 40);
  cv::RNG generator(*rc::gen::arbitrary<std::uint64_t>());
  const auto random = [&](const std::vector<std::uint8_t>& values) {
    // One column more, cut off: rows do not follow each other in memory.
    cv::Mat wide(rows, columns + 1, CV_8UC1);
    for (auto pixel = wide.begin<std::uint8_t>(); pixel != wide.end<std::uint8_t>(); ++pixel) {
      *pixel = values[generator.uniform(0, static_cast<int>(values.size()))];
    }
    return cv::Mat(wide.colRange(0, columns));
  };
  const cv::Mat truth = random({0, 50, 85, 170, 255});
  const cv::Mat mask = random({0, 127, 128, 255});
  const cv::Mat roi = *rc::gen::arbitrary<bool>() ? random({0, 255}) : cv::Mat();
  const Result<MaskCounts> counts = CountMask(truth, mask, roi);
  RC_ASSERT(counts.has_value());
  RC_ASSERT(*counts == CountSlowly(truth, mask, roi));
}

TEST(MeasureMasks, ByHand) {
  MaskCounts counts{.frames = 2,
                    .true_positives = 30,
                    .false_positives = 20,
                    .false_negatives = 10,
                    .true_negatives = 140,
                    .shadow_px = 8,
                    .shadow_false_positives = 2};
  const MaskMeasures m = MeasureMasks(counts);
  EXPECT_DOUBLE_EQ(m.recall, 0.75);
  EXPECT_DOUBLE_EQ(m.specificity, 0.875);
  EXPECT_DOUBLE_EQ(m.fpr, 0.125);
  EXPECT_DOUBLE_EQ(m.fnr, 0.25);
  EXPECT_DOUBLE_EQ(m.pwc, 15);
  EXPECT_DOUBLE_EQ(m.precision, 0.6);
  EXPECT_DOUBLE_EQ(m.f1, 2 * 0.6 * 0.75 / (0.6 + 0.75));
  EXPECT_DOUBLE_EQ(m.shadow_fpr, 0.25);

  counts += counts;
  EXPECT_EQ(counts, (MaskCounts{4, 60, 40, 20, 280, 16, 4}));
  EXPECT_DOUBLE_EQ(MeasureMasks(counts).f1, m.f1);
}

TEST(MeasureMasks, RatiosOfNothingAreNotNumbers) {
  const MaskMeasures none = MeasureMasks({});
  for (const double value : {none.recall, none.specificity, none.fpr, none.fnr, none.pwc,
                             none.precision, none.f1, none.shadow_fpr}) {
    EXPECT_TRUE(std::isnan(value));
  }
  // Nothing moves and nothing is found: recall and precision say nothing, the others are perfect.
  const MaskMeasures still = MeasureMasks({.frames = 1, .true_negatives = 9});
  EXPECT_TRUE(std::isnan(still.recall));
  EXPECT_TRUE(std::isnan(still.precision));
  EXPECT_TRUE(std::isnan(still.f1));
  EXPECT_EQ(still.specificity, 1);
  EXPECT_EQ(still.pwc, 0);
  // Something moves and nothing is found: precision says nothing, F1 is 0.
  const MaskMeasures blind = MeasureMasks({.frames = 1, .false_negatives = 9});
  EXPECT_EQ(blind.recall, 0);
  EXPECT_TRUE(std::isnan(blind.precision));
  EXPECT_EQ(blind.f1, 0);
}

TEST(MeanOf, LeavesOutWhatIsNotANumber) {
  const MaskMeasures a = MeasureMasks({.frames = 1, .true_positives = 3, .false_negatives = 1});
  const MaskMeasures b = MeasureMasks({.frames = 9, .true_positives = 1, .false_negatives = 3});
  const MaskMeasures still = MeasureMasks({.frames = 1, .true_negatives = 9});
  const MaskMeasures mean = MeanOf({a, b, still});
  EXPECT_DOUBLE_EQ(mean.recall, 0.5);
  EXPECT_DOUBLE_EQ(mean.pwc, (25.0 + 75.0 + 0.0) / 3);
  EXPECT_EQ(mean.specificity, 1);
  EXPECT_TRUE(std::isnan(mean.shadow_fpr));
  EXPECT_TRUE(std::isnan(MeanOf({}).f1));
}

}  // namespace
}  // namespace vantage
