// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/default_masks.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"
#include "vantage/experiments/test_mask_recording.h"

namespace vantage {
namespace {

using testing::GhostSequence;
using testing::TemporaryFolder;

TEST(NearMoving, HalfAHeightAround) {
  cv::Mat labels = cv::Mat::zeros(100, 120, CV_8UC1);
  EXPECT_EQ(cv::countNonZero(NearMoving(labels)), 0);
  labels(cv::Rect(50, 40, 4, 20)) = TruthLabel::kMoving;
  labels(cv::Rect(0, 0, 30, 30)) = TruthLabel::kShadow;
  cv::Mat expected = cv::Mat::zeros(labels.size(), CV_8UC1);
  expected(cv::Rect(40, 30, 24, 40)) = 255;
  EXPECT_EQ(cv::countNonZero(NearMoving(labels) != expected), 0);
  labels(cv::Rect(118, 90, 2, 10)) = TruthLabel::kMoving;  // cut by the picture's edge
  EXPECT_EQ(NearMoving(labels).at<std::uint8_t>(99, 113), 255);
}

TEST(RunDefaultMasks, EqualsADirectComputation) {
  const TemporaryFolder folder;
  testing::WriteMaskRecording(folder.path());
  const auto open = [&] {
    return LabelledSequence::OpenRecording(folder.path(), 0, {.first = 10}).value();
  };
  LabelledSequence sequence = open();
  const auto create = [&] { return BackgroundSubtractor::Create(sequence.size(), {}).value(); };
  const DefaultMasks found = RunDefaultMasks(open(), create()).value();

  BackgroundSubtractor subtractor = create();
  MaskCounts counts;
  std::int64_t near = 0;
  LabelledFrame frame;
  cv::Mat mask;
  while (sequence.Next(frame).value()) {
    ASSERT_TRUE(subtractor.Apply(frame.bgr, mask, 1));
    if (frame.labels.empty()) continue;
    counts += CountMask(frame.labels, mask).value();
    cv::Rect around = GhostSequence::Box(static_cast<int>(frame.frame));
    around &= cv::Rect(0, 0, mask.cols, mask.rows);
    for (int y = 0; y < mask.rows; ++y) {
      for (int x = 0; x < mask.cols; ++x) {
        const bool inside = !around.empty() && x >= around.x - 15 && x < around.br().x + 15 &&
                            y >= around.y - 15 && y < around.br().y + 15;
        near += inside && mask.at<std::uint8_t>(y, x) != 0 &&
                        frame.labels.at<std::uint8_t>(y, x) == TruthLabel::kStatic
                    ? 1
                    : 0;
      }
    }
  }
  EXPECT_EQ(found.counts, counts);
  EXPECT_EQ(found.near_false_positives, near);
  EXPECT_GT(near, 0);
  EXPECT_LT(near, counts.false_positives);
}

}  // namespace
}  // namespace vantage
