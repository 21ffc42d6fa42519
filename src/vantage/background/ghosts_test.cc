// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/ghosts.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;

const cv::Size kSize(120, 90);
const cv::Rect kBlob(30, 20, 24, 40);

/// A floor that is lit from one side, with a little noise.
cv::Mat Floor(int seed) {
  cv::Mat floor(kSize, CV_8UC3);
  for (int x = 0; x < kSize.width; ++x)
    floor.col(x) = cv::Scalar(90 + x / 4, 100 + x / 4, 95 + x / 3);
  cv::Mat noise(kSize, CV_8UC3);
  cv::RNG random(static_cast<std::uint64_t>(seed));
  random.fill(noise, cv::RNG::NORMAL, 10, 2);
  return floor + noise - cv::Scalar::all(10);
}

cv::Mat WithObject(cv::Mat picture, const cv::Rect& where, const cv::Scalar& color) {
  cv::ellipse(
      picture,
      cv::RotatedRect(cv::Point2f(where.x + where.width / 2.0F, where.y + where.height / 2.0F),
                      cv::Size2f(where.size()), 0),
      color, cv::FILLED);
  return picture;
}

cv::Mat MaskOf(const cv::Rect& where) {
  cv::Mat mask = cv::Mat::zeros(kSize, CV_8UC3);
  mask = WithObject(mask, where, cv::Scalar::all(255));
  cv::Mat channel;
  cv::extractChannel(mask, channel, 0);
  return channel;
}

BackgroundPicture PictureOf(const cv::Mat& background) {
  return [background](const cv::Rect& region) { return background(region).clone(); };
}

TEST(Ghosts, AnObjectInFrontIsValidAndOneInTheBackgroundOnlyIsAGhost) {
  for (const cv::Scalar& color : {cv::Scalar(20, 30, 40), cv::Scalar(160, 190, 220)}) {
    const auto object =
        JudgeComponents(WithObject(Floor(1), kBlob, color), MaskOf(kBlob), PictureOf(Floor(2)), {});
    ASSERT_TRUE(object) << MessageOf(object);
    ASSERT_EQ(object->size(), 1u);
    EXPECT_FALSE(object->front().ghost);
    EXPECT_GT(object->front().value, 0.2);

    const auto ghost =
        JudgeComponents(Floor(1), MaskOf(kBlob), PictureOf(WithObject(Floor(2), kBlob, color)), {});
    ASSERT_TRUE(ghost) << MessageOf(ghost);
    ASSERT_EQ(ghost->size(), 1u);
    EXPECT_TRUE(ghost->front().ghost);
    EXPECT_LT(ghost->front().value, 0.02);
  }
}

TEST(Ghosts, MaskHoldsTheGhostsOnly) {
  const cv::Rect other(80, 30, 20, 30);
  const cv::Mat frame = WithObject(Floor(1), other, {20, 200, 30});
  const cv::Mat background = WithObject(Floor(2), kBlob, {30, 20, 200});
  const auto judged =
      JudgeComponents(frame, MaskOf(kBlob) | MaskOf(other), PictureOf(background), {});
  ASSERT_TRUE(judged);
  ASSERT_EQ(judged->size(), 2u);
  EXPECT_EQ(cv::norm(GhostMask(*judged, kSize), MaskOf(kBlob), cv::NORM_INF), 0);
}

TEST(Ghosts, SmallComponentsAndNoCriterionJudgeNothing) {
  const cv::Mat background = WithObject(Floor(2), kBlob, {30, 20, 200});
  GhostOptions options;
  options.min_area_px = cv::countNonZero(MaskOf(kBlob)) + 1;
  auto judged = JudgeComponents(Floor(1), MaskOf(kBlob), PictureOf(background), options);
  ASSERT_TRUE(judged);
  EXPECT_TRUE(judged->empty());
  --options.min_area_px;
  EXPECT_EQ(JudgeComponents(Floor(1), MaskOf(kBlob), PictureOf(background), options)->size(), 1u);
  options.criterion = GhostCriterion::kNone;
  EXPECT_TRUE(JudgeComponents(Floor(1), MaskOf(kBlob), PictureOf(background), options)->empty());
}

TEST(Ghosts, SmallestAndPlainestPicturesHaveADefinedAnswer) {
  GhostOptions options;
  options.min_area_px = 1;
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 1), cv::Size(9, 9)}) {
    const cv::Mat picture(size, CV_8UC3, cv::Scalar(50, 60, 70));
    cv::Mat mask(size, CV_8UC1, cv::Scalar(255));
    for (int round = 0; round < 2; ++round) {
      const auto judged = JudgeComponents(picture, mask, PictureOf(picture), options);
      ASSERT_TRUE(judged);
      for (const JudgedComponent& one : *judged) {
        EXPECT_EQ(one.value, 0);
        EXPECT_TRUE(one.ghost);
      }
      mask.at<std::uint8_t>(0, size.width - 1) = 0;
    }
  }
}

TEST(Ghosts, RefusesPicturesThatDoNotFit) {
  const cv::Mat mask = MaskOf(kBlob);
  const BackgroundPicture background = PictureOf(Floor(2));
  EXPECT_THAT(MessageOf(JudgeComponents(Floor(1).rowRange(0, 80), mask, background, {})),
              HasSubstr("the mask is 120x90 px of type CV_8UC1 and the frame 120x80 px"));
  EXPECT_THAT(MessageOf(JudgeComponents(mask, mask, background, {})),
              HasSubstr("of type CV_8UC1;"));
  EXPECT_THAT(MessageOf(JudgeComponents(Floor(1), Floor(1), background, {})), HasSubstr("must be"));
  const auto too_small = [](const cv::Rect&) { return cv::Mat(3, 3, CV_8UC3); };
  EXPECT_THAT(MessageOf(JudgeComponents(Floor(1), mask, too_small, {})),
              HasSubstr("the background picture is 3x3 px of type CV_8UC3; it must be"));
  EXPECT_EQ(MessageOf(JudgeComponents(Floor(1), mask, background, {.threshold = -1})),
            "background.ghost_threshold is -1; it must be at least 0");
}

}  // namespace
}  // namespace vantage
