// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/subtractor.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <random>

#include "vantage/background/test_scene.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::ElementsAre;
using testing::ForegroundShare;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::LeavingPerson;
using testing::MessageOf;

const LeavingPerson kScene;
constexpr ImageSize kSize = LeavingPerson::kSize;
constexpr int kAlone = 45;  // frame from which the ghost should be gone

BackgroundOptions OptionsOf(GhostCriterion criterion) {
  BackgroundOptions options;
  options.mixture.rate = LearningRate::kOriginal;
  options.ghosts.rule.criterion = criterion;
  options.cleanup = {.open_px = 0, .close_px = 0, .min_area_px = 0};
  return options;
}

TEST(Subtractor, AGhostGoesAndThePersonStays) {
  for (const GhostJudgement judgement : {GhostJudgement::kStill, GhostJudgement::kPlain}) {
    for (const GhostCriterion criterion : {GhostCriterion::kNone, GhostCriterion::kFep}) {
      BackgroundOptions options = OptionsOf(criterion);
      options.ghosts.judgement = judgement;
      auto subtractor = BackgroundSubtractor::Create(kSize, options);
      ASSERT_TRUE(subtractor);
      cv::Mat mask;
      for (int t = 0; t < 70; ++t) {
        ASSERT_TRUE(subtractor->Apply(kScene.FrameAt(t), mask, 1));
        EXPECT_TRUE(subtractor->reliable());
        if (t < kAlone) continue;
        EXPECT_GT(ForegroundShare(mask, kScene.At(t)), 0.95) << "frame " << t;
        const double ghost_share = ForegroundShare(mask, LeavingPerson::kStart);
        if (criterion == GhostCriterion::kFep) {
          EXPECT_LT(ghost_share, 0.02) << "frame " << t;
        } else {
          EXPECT_GT(ghost_share, 0.95) << "frame " << t;
        }
      }
      const BackgroundReport& report = subtractor->report();
      EXPECT_EQ(report.frames, 70);
      EXPECT_EQ(report.unreliable, 0);
      EXPECT_EQ(report.shadows_px, 0);
      if (criterion == GhostCriterion::kFep) {
        EXPECT_GE(report.ghost_frames, 1);
        EXPECT_LE(report.ghost_frames, 20);
        EXPECT_GT(report.ghosts_px, 400);
      } else {
        EXPECT_EQ(report.ghost_frames, 0);
        EXPECT_EQ(report.ghosts_px, 0);
      }
    }
  }
}

TEST(Subtractor, TheVerdictIsOfTheLastFrame) {
  auto subtractor = BackgroundSubtractor::Create(kSize, OptionsOf(GhostCriterion::kFep));
  ASSERT_TRUE(subtractor);
  cv::Mat mask;
  std::int64_t ghosts_px = 0;
  for (int t = 0; t < 70; ++t) {
    ASSERT_TRUE(subtractor->Apply(kScene.FrameAt(t), mask, 1));
    const GhostVerdict& verdict = subtractor->verdict();
    ghosts_px += verdict.ghosts_px;
    EXPECT_EQ(verdict.ghosts.empty(), verdict.ghosts_px == 0);
    if (verdict.ghosts_px == 0) continue;
    EXPECT_EQ(cv::countNonZero(verdict.ghosts), verdict.ghosts_px);
    EXPECT_EQ(cv::countNonZero(verdict.ghosts & mask), 0);
    EXPECT_FALSE(verdict.judged.empty());
  }
  EXPECT_EQ(subtractor->report().ghosts_px, ghosts_px);
}

TEST(Subtractor, WhatIsHeldIsNeverAbsorbed) {
  for (const GhostJudgement judgement : {GhostJudgement::kStill, GhostJudgement::kPlain}) {
    BackgroundOptions options = OptionsOf(GhostCriterion::kFep);
    options.ghosts.judgement = judgement;
    auto subtractor = BackgroundSubtractor::Create(kSize, options);
    ASSERT_TRUE(subtractor);
    // A tracker that believes somebody still stands in the left half of the old place.
    cv::Rect held_place = LeavingPerson::kStart;
    held_place.width /= 2;
    cv::Mat held = cv::Mat::zeros(kSize.height, kSize.width, CV_8UC1);
    held(held_place) = 1;
    const cv::Rect rest(held_place.br().x, held_place.y, held_place.width, held_place.height);
    cv::Mat mask;
    for (int t = 0; t < 70; ++t) {
      ASSERT_TRUE(subtractor->Apply(kScene.FrameAt(t), mask, 1, held));
      const GhostVerdict& verdict = subtractor->verdict();
      EXPECT_EQ(verdict.ghosts.empty(), verdict.ghosts_px == 0);
      if (!verdict.ghosts.empty()) {
        EXPECT_EQ(cv::countNonZero(verdict.ghosts & (held != 0)), 0);
      }
      if (t < kAlone) continue;
      EXPECT_GT(ForegroundShare(mask, held_place), 0.95) << t;
      EXPECT_LT(ForegroundShare(mask, rest), 0.03) << t;
    }
    // Let go, the rest goes too.
    for (int t = 70; t < 85; ++t) ASSERT_TRUE(subtractor->Apply(kScene.FrameAt(t), mask, 1));
    EXPECT_LT(ForegroundShare(mask, LeavingPerson::kStart), 0.03);
  }
}

TEST(Subtractor, ShadowsGoWhereAsked) {
  BackgroundOptions options = OptionsOf(GhostCriterion::kNone);
  options.mixture.rate = LearningRate::kModified;
  for (const bool enabled : {false, true}) {
    options.shadows.enabled = enabled;
    auto subtractor = BackgroundSubtractor::Create(kSize, options);
    ASSERT_TRUE(subtractor);
    const cv::Rect shadow(10, 40, 30, 8);
    const cv::Rect person(20, 10, 12, 30);
    cv::Mat mask;
    for (int t = 0; t < 60; ++t) {
      cv::Mat frame(kSize.height, kSize.width, CV_8UC3, cv::Scalar(120, 150, 140 + t % 2));
      if (t >= 30) {  // and the camera freezes
        frame = cv::Scalar(120, 150, 140);
        frame(shadow) *= 0.7;
        frame(person) = cv::Scalar(200, 20, 30);
      }
      ASSERT_TRUE(subtractor->Apply(frame, mask, 1));
      if (t != 30 && subtractor->reliable()) continue;
      EXPECT_EQ(ForegroundShare(mask, person), 1) << t;
      EXPECT_EQ(ForegroundShare(mask, shadow), enabled ? 0 : 1) << t;
    }
    EXPECT_FALSE(subtractor->reliable());
    EXPECT_EQ(subtractor->report().shadows_px > 0, enabled);
  }
}

/// A subtractor that has seen the scene until the person waves; the same again gives the same.
BackgroundSubtractor Settled(LearningRate rate) {
  BackgroundOptions options = OptionsOf(GhostCriterion::kFep);
  options.mixture.rate = rate;
  auto subtractor = BackgroundSubtractor::Create(kSize, options).value();
  cv::Mat mask;
  for (int t = 0; t < 60; ++t) {
    EXPECT_TRUE(subtractor.Apply(kScene.FrameAt(t), mask, 1));
    EXPECT_TRUE(subtractor.reliable());
  }
  return subtractor;
}

std::vector<DisturbanceKind> EventsOf(const BackgroundSubtractor& subtractor) {
  std::vector<DisturbanceKind> kinds;
  for (const auto& event : subtractor.report().disturbances.events) kinds.push_back(event.kind);
  return kinds;
}

TEST(Subtractor, BlackFramesGiveEmptyMasksAndTheModelNeverSeesThem) {
  BackgroundSubtractor disturbed = Settled(LearningRate::kOriginal);
  BackgroundSubtractor undisturbed = Settled(LearningRate::kOriginal);
  cv::Mat mask, expected;
  for (int t = 0; t < 30; ++t) {
    cv::Mat black(kSize.height, kSize.width, CV_8UC3);
    cv::RNG(static_cast<std::uint64_t>(t + 1)).fill(black, cv::RNG::NORMAL, 3, 1);
    ASSERT_TRUE(disturbed.Apply(black, mask, 1));
    EXPECT_FALSE(disturbed.reliable());
    EXPECT_TRUE(disturbed.verdict().judged.empty());
    EXPECT_EQ(mask.size(), black.size());
    EXPECT_EQ(cv::countNonZero(mask), 0);
  }
  EXPECT_THAT(EventsOf(disturbed), ElementsAre(DisturbanceKind::kBlack));
  EXPECT_EQ(disturbed.report().unreliable, 30);
  EXPECT_EQ(disturbed.report().disturbances.skipped, 30);
  for (int t = 60; t < 75; ++t) {
    ASSERT_TRUE(disturbed.Apply(kScene.FrameAt(t), mask, 1));
    ASSERT_TRUE(undisturbed.Apply(kScene.FrameAt(t), expected, 1));
    EXPECT_TRUE(disturbed.reliable());
    EXPECT_EQ(cv::norm(mask, expected, cv::NORM_INF), 0) << t;
  }
  EXPECT_EQ(disturbed.report().unreliable, 30);
}

TEST(Subtractor, AFrozenCameraRepeatsTheLastMask) {
  BackgroundSubtractor subtractor = Settled(LearningRate::kOriginal);
  cv::Mat mask, last;
  int frozen = 0;
  for (int t = 0; t < 60; ++t) {
    ASSERT_TRUE(subtractor.Apply(kScene.FrameAt(60), mask, 1));
    if (!subtractor.reliable()) {
      ++frozen;
      EXPECT_EQ(cv::norm(mask, last, cv::NORM_INF), 0) << t;
      EXPECT_GT(ForegroundShare(mask, kScene.At(60)), 0.95);
    }
    mask.copyTo(last);
  }
  EXPECT_THAT(EventsOf(subtractor), ElementsAre(DisturbanceKind::kFreeze));
  EXPECT_NEAR(frozen, 60 - 25, 3) << "noticed within a second";
  ASSERT_TRUE(subtractor.Apply(kScene.FrameAt(61), mask, 1));
  EXPECT_TRUE(subtractor.reliable());
}

TEST(Subtractor, AChangeOfTheLightIsCorrected) {
  BackgroundSubtractor subtractor = Settled(LearningRate::kModified);
  cv::Mat mask;
  for (int t = 60; t < 95; ++t) {
    ASSERT_TRUE(subtractor.Apply(0.7 * kScene.FrameAt(t), mask, 1));
    if (t < 85) continue;  // a second
    EXPECT_TRUE(subtractor.reliable());
    EXPECT_GT(ForegroundShare(mask, kScene.At(t)), 0.85) << t;
    EXPECT_LT(cv::countNonZero(mask), 1.2 * LeavingPerson::kStart.area()) << t;
  }
  EXPECT_THAT(EventsOf(subtractor), ElementsAre(DisturbanceKind::kLight));
  EXPECT_GE(subtractor.report().unreliable, 1);
  EXPECT_GE(subtractor.report().disturbances.relit, 1);
  EXPECT_EQ(subtractor.report().disturbances.restarts, 0);
}

TEST(Subtractor, DisturbancesMayBeLeftAlone) {
  BackgroundOptions options = OptionsOf(GhostCriterion::kNone);
  options.disturbances.enabled = false;
  auto subtractor = BackgroundSubtractor::Create(kSize, options);
  ASSERT_TRUE(subtractor);
  cv::Mat mask;
  for (int t = 0; t < 70; ++t) {
    const cv::Mat frame = kScene.FrameAt(t);
    ASSERT_TRUE(subtractor->Apply(t < 60 ? frame : cv::Mat(0.1 * frame), mask, 1));
    EXPECT_TRUE(subtractor->reliable());
  }
  EXPECT_GT(ForegroundShare(mask, {0, 0, kSize.width, kSize.height}), 0.9);
  EXPECT_THAT(EventsOf(*subtractor), IsEmpty());
}

TEST(Subtractor, ThreadCountDoesNotChangeABit) {
  auto one = BackgroundSubtractor::Create(kSize, {});
  auto three = BackgroundSubtractor::Create(kSize, {});
  ASSERT_TRUE(one && three);
  cv::Mat mask_one, mask_three;
  for (int t = 0; t < 90; ++t) {
    const cv::Mat frame = kScene.FrameAt(t) * (t < 75 ? 1 : 0.7);
    ASSERT_TRUE(one->Apply(frame, mask_one, 1));
    ASSERT_TRUE(three->Apply(frame, mask_three, 3));
    ASSERT_EQ(cv::norm(mask_one, mask_three, cv::NORM_INF), 0) << "frame " << t;
  }
  EXPECT_GT(one->report().ghosts_px, 0);
  EXPECT_EQ(one->report().ghosts_px, three->report().ghosts_px);
  EXPECT_EQ(one->report().unreliable, three->report().unreliable);
}

TEST(Subtractor, TheMaskMayBeTheFrame) {
  auto apart = BackgroundSubtractor::Create(kSize, {});
  auto in_place = BackgroundSubtractor::Create(kSize, {});
  ASSERT_TRUE(apart && in_place);
  cv::Mat mask;
  for (int t = 0; t < 50; ++t) {
    cv::Mat both = kScene.FrameAt(t);
    ASSERT_TRUE(apart->Apply(both, mask, 1));
    ASSERT_TRUE(in_place->Apply(both, both, 1));
    ASSERT_EQ(cv::norm(mask, both, cv::NORM_INF), 0) << t;
  }
}

TEST(Subtractor, TakesPicturesOfAnySizeAndContent) {
  BackgroundOptions options;
  options.ghosts.min_area_px = 1;
  std::mt19937 random(1);
  for (const ImageSize size :
       {ImageSize{1, 1}, ImageSize{1, 9}, ImageSize{7, 1}, ImageSize{33, 17}}) {
    auto subtractor = BackgroundSubtractor::Create(size, options);
    ASSERT_TRUE(subtractor);
    cv::Mat mask;
    for (int t = 0; t < 20; ++t) {
      cv::Mat frame(size.height, size.width, CV_8UC3);
      for (int i = 0; i < size.width * size.height * 3; ++i) {
        frame.data[i] = t % 3 == 0 ? 255 : static_cast<uchar>(random());
      }
      ASSERT_TRUE(subtractor->Apply(frame, mask, 2));
      EXPECT_EQ(mask.size(), frame.size());
      EXPECT_EQ(cv::countNonZero((mask != 0) & (mask != 255)), 0);
    }
  }
}

TEST(Subtractor, RefusesWrongFrames) {
  auto subtractor = BackgroundSubtractor::Create(kSize, {});
  ASSERT_TRUE(subtractor);
  cv::Mat mask;
  EXPECT_THAT(MessageOf(subtractor->Apply(cv::Mat(), mask, 1)), HasSubstr("is empty"));
  EXPECT_THAT(MessageOf(subtractor->Apply(cv::Mat(5, 5, CV_8UC3), mask, 1)),
              HasSubstr("must be 96x72 px"));
  EXPECT_THAT(MessageOf(subtractor->Apply(cv::Mat(72, 96, CV_16UC1), mask, 1)),
              HasSubstr("CV_16UC1"));
  EXPECT_EQ(subtractor->report().frames, 0);
}

TEST(Subtractor, OptionsAreOneFlatTable) {
  nlohmann::ordered_json json;
  RecordOptions(BackgroundOptions{}, json);
  EXPECT_EQ(json.dump(),
            R"({"method":"mixture","color":"luv","rate":"modified","gaussians":3,"alpha":0.002,)"
            R"("background_share":0.5,"match_sigmas":2.5,"initial_weight":0.05,)"
            R"("absorb_weight":1.0,"luv_initial_sigma":15.0,"luv_min_sigma":5.0,)"
            R"("rgb_initial_sigma":50.0,"rgb_min_sigma":20.0,"disturbances":true,)"
            R"("light_share":0.4,"freeze_secs":1.0,"uniform_levels":12,"moved_px":2.0,)"
            R"("restart_secs":1.0,"shadows":false,"shadow_tau":0.6,"shadow_color":8.0,)"
            R"("ghosts":"fep","fep_threshold":0.05,"fer_threshold":0.9,"nb_threshold":1.0,)"
            R"("epd_threshold":2.6,"cb_threshold":0.03,"ghost_border":1,"ghost_ring":3,)"
            R"("cb_bins":8,"ghost_judgement":"still","ghost_min_area":50,)"
            R"("ghost_still_frames":8,"ghost_still_levels":12,"ghost_whole_share":0.5,)"
            R"("ghost_join":4,"ghost_free_share":0.3,"ghost_agree_frames":3,"open":1,"close":2,)"
            R"("min_area":40,"rehearsal_secs":60.0,"rehearsal_frames":100})");
  BackgroundOptions options;
  options.cleanup.close_px = 99;
  EXPECT_EQ(MessageOf(BackgroundSubtractor::Create(kSize, options)),
            "background.close is 99; it must be between 0 and 50 px");
  options = {};
  options.mixture.background_share = 0.2;
  EXPECT_THAT(MessageOf(BackgroundSubtractor::Create(kSize, options)), HasSubstr("absorb_weight"));
}

}  // namespace
}  // namespace vantage
