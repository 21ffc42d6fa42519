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

constexpr ImageSize kSize{120, 90};
const cv::Rect kBlob(30, 20, 24, 40);

cv::Mat Noisy(const cv::Mat& picture, int seed) {
  cv::Mat noise(picture.size(), CV_8UC3);
  cv::RNG(static_cast<std::uint64_t>(seed)).fill(noise, cv::RNG::NORMAL, 10, 1.5);
  return picture + noise - cv::Scalar::all(10);
}

/// A floor that is lit from one side.
cv::Mat Floor() {
  cv::Mat floor(kSize.height, kSize.width, CV_8UC3);
  for (int x = 0; x < kSize.width; ++x) {
    floor.col(x) = cv::Scalar(90 + x / 4, 100 + x / 4, 95 + x / 3);
  }
  return floor;
}

template <class Picture>
cv::Mat WithObject(const Picture& picture, const cv::Rect& where, const cv::Scalar& color) {
  cv::Mat with = picture.clone();
  const cv::Point2f centre(static_cast<float>(where.x) + static_cast<float>(where.width) / 2,
                           static_cast<float>(where.y) + static_cast<float>(where.height) / 2);
  cv::ellipse(with, cv::RotatedRect(centre, cv::Size2f(where.size()), 0), color, cv::FILLED);
  return with;
}

cv::Mat NoMask() { return cv::Mat::zeros(kSize.height, kSize.width, CV_8UC1); }
cv::Mat MaskOf(const cv::Rect& where) { return WithObject(NoMask(), where, 255); }

BackgroundPicture PictureOf(const cv::Mat& background) {
  return [background](const cv::Rect& region) { return background(region).clone(); };
}

GhostOptions Plain(GhostCriterion criterion = GhostCriterion::kFep) {
  return {.rule = {.criterion = criterion}, .judgement = GhostJudgement::kPlain};
}

GhostVerdict JudgeOnce(const cv::Mat& bgr, const cv::Mat& mask, const cv::Mat& background,
                       const GhostOptions& options) {
  auto detector = GhostDetector::Create(kSize, options);
  EXPECT_TRUE(detector) << MessageOf(detector);
  auto verdict = detector->Judge(bgr, mask, PictureOf(background));
  EXPECT_TRUE(verdict) << MessageOf(verdict);
  return *verdict;
}

TEST(PlainGhosts, EveryRuleTellsAnObjectFromAGhost) {
  for (const GhostCriterion rule : {GhostCriterion::kFep, GhostCriterion::kFer, GhostCriterion::kNb,
                                    GhostCriterion::kEpd, GhostCriterion::kCb}) {
    for (const cv::Scalar& color : {cv::Scalar(20, 30, 40), cv::Scalar(160, 190, 220)}) {
      SCOPED_TRACE(::testing::Message() << NameOf(rule) << ", " << color);
      const cv::Mat floor(kSize.height, kSize.width, CV_8UC3, cv::Scalar(105, 110, 108));
      const cv::Mat with = WithObject(floor, kBlob, color);
      const GhostVerdict object = JudgeOnce(with, MaskOf(kBlob), floor, Plain(rule));
      ASSERT_EQ(object.judged.size(), 1u);
      EXPECT_FALSE(object.judged[0].ghost);
      EXPECT_GT(object.judged[0].value, Plain(rule).rule.threshold());
      EXPECT_TRUE(object.ghosts.empty());
      EXPECT_EQ(object.ghosts_px, 0);

      const GhostVerdict ghost = JudgeOnce(floor, MaskOf(kBlob), with, Plain(rule));
      ASSERT_EQ(ghost.judged.size(), 1u);
      EXPECT_TRUE(ghost.judged[0].ghost);
      EXPECT_EQ(cv::norm(ghost.ghosts, MaskOf(kBlob), cv::NORM_INF), 0);
      EXPECT_EQ(ghost.ghosts_px, cv::countNonZero(MaskOf(kBlob)));
    }
  }
}

TEST(PlainGhosts, OnlyTheGhostsOfAFrameAreToBeAbsorbed) {
  const cv::Rect other(80, 30, 20, 30);
  const cv::Mat frame = Noisy(WithObject(Floor(), other, {20, 200, 30}), 1);
  const cv::Mat background = Noisy(WithObject(Floor(), kBlob, {30, 20, 200}), 2);
  const GhostVerdict verdict = JudgeOnce(frame, MaskOf(kBlob) | MaskOf(other), background, Plain());
  ASSERT_EQ(verdict.judged.size(), 2u);
  EXPECT_TRUE(verdict.judged[0].ghost);
  EXPECT_LT(verdict.judged[0].value, 0.02);
  EXPECT_FALSE(verdict.judged[1].ghost);
  EXPECT_GT(verdict.judged[1].value, 0.2);
  EXPECT_EQ(cv::norm(verdict.ghosts, MaskOf(kBlob), cv::NORM_INF), 0);
}

TEST(PlainGhosts, SmallComponentsAndNoRuleJudgeNothing) {
  const cv::Mat background = WithObject(Floor(), kBlob, {30, 20, 200});
  GhostOptions options = Plain();
  options.min_area_px = cv::countNonZero(MaskOf(kBlob)) + 1;
  EXPECT_TRUE(JudgeOnce(Floor(), MaskOf(kBlob), background, options).judged.empty());
  --options.min_area_px;
  EXPECT_EQ(JudgeOnce(Floor(), MaskOf(kBlob), background, options).judged.size(), 1u);
  options.rule.criterion = GhostCriterion::kNone;
  EXPECT_TRUE(JudgeOnce(Floor(), MaskOf(kBlob), background, options).judged.empty());
}

TEST(Ghosts, SmallestAndPlainestPicturesHaveADefinedAnswer) {
  for (const GhostJudgement judgement : {GhostJudgement::kPlain, GhostJudgement::kStill}) {
    const GhostOptions options{
        .rule = {}, .judgement = judgement, .min_area_px = 1, .still_frames = 1};
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 1), cv::Size(1, 4), cv::Size(9, 9)}) {
      auto detector = GhostDetector::Create({size.width, size.height}, options);
      ASSERT_TRUE(detector);
      const cv::Mat picture(size, CV_8UC3, cv::Scalar(50, 60, 70));
      cv::Mat mask(size, CV_8UC1, cv::Scalar(255));
      for (int t = 0; t < 6; ++t) {
        if (t == 3) mask.at<std::uint8_t>(0, size.width - 1) = 0;
        const auto verdict = detector->Judge(picture, mask, PictureOf(picture));
        ASSERT_TRUE(verdict) << MessageOf(verdict);
        for (const JudgedComponent& one : verdict->judged) EXPECT_EQ(one.value, 0);
      }
    }
  }
}

TEST(Ghosts, RulesWithoutABackgroundPictureWorkAndOthersSayWhatTheyNeed) {
  const cv::Mat frame = Noisy(Floor(), 1);
  const cv::Mat mask = MaskOf(kBlob);
  for (const GhostJudgement judgement : {GhostJudgement::kPlain, GhostJudgement::kStill}) {
    for (const GhostCriterion rule :
         {GhostCriterion::kEpd, GhostCriterion::kCb, GhostCriterion::kFep, GhostCriterion::kFer,
          GhostCriterion::kNb}) {
      const GhostOptions options{
          .rule = {.criterion = rule}, .judgement = judgement, .still_frames = 1};
      for (const BackgroundPicture& none :
           {BackgroundPicture(), BackgroundPicture([](const cv::Rect&) { return cv::Mat(); })}) {
        auto detector = GhostDetector::Create(kSize, options);
        ASSERT_TRUE(detector);
        Result<GhostVerdict> verdict;
        for (int t = 0; t < 3 && verdict; ++t) verdict = detector->Judge(frame, mask, none);
        if (NeedsBackground(rule)) {
          EXPECT_EQ(MessageOf(verdict),
                    fmt::format("ghosts: rule {} compares with the background picture, which this "
                                "background algorithm does not have; choose epd or cb",
                                NameOf(rule)));
        } else {
          ASSERT_TRUE(verdict) << MessageOf(verdict);
          EXPECT_EQ(verdict->judged.size(), 1u);
        }
      }
    }
  }
}

TEST(Ghosts, RefuseWhatDoesNotFit) {
  auto detector = GhostDetector::Create(kSize, Plain());
  ASSERT_TRUE(detector);
  const cv::Mat frame = Floor();
  const cv::Mat mask = MaskOf(kBlob);
  const BackgroundPicture background = PictureOf(frame);
  EXPECT_EQ(MessageOf(detector->Judge(frame.rowRange(0, 80), mask, background)),
            "ghosts: the mask is 120x90 px of type CV_8UC1 and the frame 120x80 px of type "
            "CV_8UC3; they must be 120x90 px of types CV_8UC1 and CV_8UC3");
  EXPECT_THAT(MessageOf(detector->Judge(frame, mask.colRange(0, 99), background)),
              HasSubstr("the mask is 99x90 px"));
  EXPECT_THAT(MessageOf(detector->Judge(mask, mask, background)), HasSubstr("120x90 px of type "
                                                                            "CV_8UC1;"));
  EXPECT_THAT(MessageOf(detector->Judge(frame, frame, background)), HasSubstr("must be"));
  const auto too_small = [](const cv::Rect&) { return cv::Mat(3, 3, CV_8UC3); };
  EXPECT_THAT(MessageOf(detector->Judge(frame, mask, too_small)),
              HasSubstr("the background picture is 3x3 px of type CV_8UC3; it must be 37x53 px"));
  GhostOptions options;
  options.rule.fep_threshold = -1;
  EXPECT_EQ(MessageOf(GhostDetector::Create(kSize, options)),
            "background.fep_threshold is -1; it must be at least 0");
  EXPECT_EQ(MessageOf(GhostDetector::Create({0, 5}, {})),
            "ghosts: frames of 0x5 px; each side must be at least 1 px");
}

/// Each frame of a ghost that stands still for the detector, until it is to be absorbed.
int FramesUntilAbsorbed(const GhostOptions& options) {
  auto detector = GhostDetector::Create(kSize, options).value();
  const cv::Mat background = WithObject(Floor(), kBlob, {30, 20, 200});
  for (int t = 0; t < 600; ++t) {
    const auto verdict = detector.Judge(Noisy(Floor(), t), MaskOf(kBlob), PictureOf(background));
    EXPECT_TRUE(verdict) << MessageOf(verdict);
    EXPECT_EQ(verdict->judged.size(), t < options.still_frames ? 0u : 1u) << t;
    if (verdict->ghosts_px == 0) continue;
    EXPECT_EQ(cv::norm(verdict->ghosts, MaskOf(kBlob), cv::NORM_INF), 0);
    return t;
  }
  return -1;
}

TEST(StillGhosts, AreAbsorbedAfterExactlyTheFramesThatMustAgree) {
  for (const int still : {1, 8, 30}) {
    for (const int agree : {1, 3, 250}) {
      // The first frame is kept, `still` later ones are like it, and of these the last votes first.
      EXPECT_EQ(FramesUntilAbsorbed({.rule = {}, .still_frames = still, .agree_frames = agree}),
                still + agree - 1)
          << still << " " << agree;
    }
  }
}

TEST(StillGhosts, VotesMustBeInARow) {
  const GhostOptions options{.rule = {}, .still_frames = 2, .agree_frames = 3};
  auto detector = GhostDetector::Create(kSize, options).value();
  // What is around the place changes its light now and then: its border is an object's.
  const cv::Mat lit = [] {
    cv::Mat frame = Floor();
    frame.setTo(cv::Scalar::all(10), MaskOf(kBlob) == 0);
    return frame;
  }();
  const auto absorbed = [&](const cv::Mat& frame) {
    const auto verdict = detector.Judge(frame, MaskOf(kBlob), PictureOf(Floor()));
    EXPECT_TRUE(verdict) << MessageOf(verdict);
    return verdict->ghosts_px > 0;
  };
  EXPECT_FALSE(absorbed(Floor()));
  EXPECT_FALSE(absorbed(Floor()));
  // However long ago the votes are: frames are counted modulo powers of two.
  for (const int away : {1, 2, 253, 254, 255, 256, 257, 511}) {
    EXPECT_FALSE(absorbed(Floor())) << away;
    EXPECT_FALSE(absorbed(Floor())) << away;
    for (int i = 0; i < away; ++i) EXPECT_FALSE(absorbed(lit)) << away;
  }
  EXPECT_FALSE(absorbed(Floor()));
  EXPECT_FALSE(absorbed(Floor()));
  EXPECT_TRUE(absorbed(Floor()));
}

/// Somebody in stripes who sways, so that every pixel keeps changing.
cv::Mat WithDancer(const cv::Mat& picture, const cv::Rect& where, int t) {
  cv::Mat stripes(picture.size(), CV_8UC3);
  for (int x = 0; x < picture.cols; ++x) {
    stripes.col(x) = (x + 3 * t) / 6 % 2 == 0 ? cv::Scalar(30, 20, 150) : cv::Scalar(190, 210, 60);
  }
  cv::Mat with = picture.clone();
  stripes.copyTo(with, MaskOf(where));
  return with;
}

TEST(StillGhosts, OneThatHangsTogetherWithAPersonGoesAndThePersonStays) {
  auto detector = GhostDetector::Create(kSize, {}).value();
  const cv::Mat background = WithObject(Floor(), kBlob, {30, 20, 200});
  cv::Mat remaining = MaskOf(kBlob);
  for (int t = 0; t < 60; ++t) {
    const cv::Rect dancer(48 + t % 2, 18, 26, 44);  // in front of a part of the ghost
    const cv::Mat person = MaskOf(dancer);
    const cv::Mat frame = WithDancer(Noisy(Floor(), t), dancer, t);
    const cv::Mat mask = person | remaining;
    ASSERT_EQ(FindComponents(mask, {.min_area_px = 10}).size(), 1u) << "one, together";
    const auto verdict = detector.Judge(frame, mask, PictureOf(background));
    ASSERT_TRUE(verdict) << MessageOf(verdict);
    if (verdict->ghosts_px == 0) continue;
    EXPECT_EQ(cv::countNonZero(verdict->ghosts & person), 0) << t;
    remaining &= ~verdict->ghosts;
    EXPECT_LT(t, 15);
  }
  const cv::Mat uncovered = remaining & ~MaskOf({48, 18, 27, 44});
  EXPECT_LT(cv::countNonZero(uncovered), 0.1 * cv::countNonZero(MaskOf(kBlob)));
}

TEST(StillGhosts, SomebodyWithoutTextureWhoMovesIsNeverJudged) {
  auto detector = GhostDetector::Create(kSize, {}).value();
  for (int t = 0; t < 25; ++t) {
    const cv::Rect person(5 + 4 * t % 90, 20, 20, 44);
    const cv::Mat frame = Noisy(WithObject(Floor(), person, {30, 20, 200}), t);
    const auto verdict = detector.Judge(frame, MaskOf(person), PictureOf(Floor()));
    ASSERT_TRUE(verdict) << MessageOf(verdict);
    EXPECT_TRUE(verdict->judged.empty()) << t;
  }
}

TEST(StillGhosts, SomebodyWhoBarelyMovesOrStandsIsAnObject) {
  for (const int frames_per_px : {1, 2, 1000}) {
    auto detector = GhostDetector::Create(kSize, {}).value();
    std::size_t judged = 0;
    for (int t = 0; t < 60; ++t) {
      const cv::Rect person(30 + t / frames_per_px, 20, 24, 44);
      const cv::Mat frame = Noisy(WithObject(Floor(), person, {30, 20, 200}), t);
      const auto verdict = detector.Judge(frame, MaskOf(person), PictureOf(Floor()));
      ASSERT_TRUE(verdict) << MessageOf(verdict);
      EXPECT_EQ(verdict->ghosts_px, 0) << t;
      judged += verdict->judged.size();
    }
    EXPECT_GT(judged, 0u);
  }
}

TEST(StillGhosts, APieceBesideWhatFadedOfAnObjectIsNotJudged) {
  auto detector = GhostDetector::Create(kSize, {}).value();
  const cv::Rect rest(36, 33, 12, 14);  // without an edge of its own
  const cv::Mat with = WithObject(Floor(), kBlob, {30, 20, 200});
  for (int t = 0; t < 40; ++t) {
    const bool faded = t >= 20;
    const cv::Mat mask = MaskOf(faded ? rest : kBlob);
    const cv::Mat background = faded ? with : Floor();
    const auto verdict = detector.Judge(with, mask, PictureOf(background));
    ASSERT_TRUE(verdict) << MessageOf(verdict);
    EXPECT_EQ(verdict->ghosts_px, 0) << t;
    if (!faded) continue;
    ASSERT_EQ(verdict->judged.size(), 1u);
    EXPECT_EQ(verdict->judged[0].free_share, 0);
    EXPECT_FALSE(verdict->judged[0].ghost);
  }
  EXPECT_TRUE(JudgeOnce(with, MaskOf(rest), with, Plain()).judged[0].ghost)
      << "by itself it looks like one";
}

}  // namespace
}  // namespace vantage
