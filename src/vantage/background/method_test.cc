// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/method.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "vantage/background/opencv_method.h"
#include "vantage/background/subtractor.h"
#include "vantage/background/test_scene.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using testing::ForegroundShare;
using ::testing::HasSubstr;
using testing::LeavingPerson;
using testing::MessageOf;

const LeavingPerson kScene;

BackgroundOptions OptionsOf(MethodKind kind, GhostCriterion criterion) {
  BackgroundOptions options;
  options.method = kind;
  options.ghosts.rule.criterion = criterion;
  options.cleanup = {.open_px = 0, .close_px = 0, .min_area_px = 0};
  return options;
}

TEST(OpenCvMethods, AGhostGoesForGoodAndThePersonStays) {
  const LeavingPerson scene{.stays = 300};  // they learn fast in the beginning
  for (const MethodKind kind : {MethodKind::kMog2, MethodKind::kKnn}) {
    for (const GhostCriterion rule : {GhostCriterion::kNone, GhostCriterion::kFep}) {
      SCOPED_TRACE(::testing::Message()
                   << (kind == MethodKind::kKnn ? "knn " : "mog2 ") << NameOf(rule));
      auto subtractor = BackgroundSubtractor::Create(LeavingPerson::kSize, OptionsOf(kind, rule));
      ASSERT_TRUE(subtractor) << MessageOf(subtractor);
      cv::Mat mask;
      for (int t = 0; t < 350; ++t) {
        const Status status = subtractor->Apply(scene.FrameAt(t), mask, 1);
        ASSERT_TRUE(status) << MessageOf(status);
        if (t < 325) continue;
        EXPECT_GT(ForegroundShare(mask, scene.At(t)), 0.9) << t;
        const double ghost_share = ForegroundShare(mask, LeavingPerson::kStart);
        if (rule == GhostCriterion::kFep) {
          EXPECT_LT(ghost_share, 0.03) << t;
        } else {
          EXPECT_GT(ghost_share, 0.8) << t;
        }
      }
      EXPECT_EQ(subtractor->report().ghost_frames > 0, rule == GhostCriterion::kFep);
    }
  }
}

TEST(OpenCvMethods, RefuseFramesOfAnotherKindAndStartAnew) {
  for (const MethodKind kind : {MethodKind::kMog2, MethodKind::kKnn}) {
    auto made = CreateMethod(kind, {20, 10}, {});
    ASSERT_TRUE(made);
    BackgroundMethod& method = **made;
    cv::Mat mask;
    EXPECT_TRUE(method.BackgroundImage({2, 3, 4, 5}).empty()) << "no frame yet";
    EXPECT_THAT(MessageOf(method.Absorb(cv::Mat::zeros(10, 20, CV_8UC1))), HasSubstr("frame"));
    EXPECT_THAT(MessageOf(method.Apply(cv::Mat(10, 21, CV_8UC3), {}, mask, 1)),
                HasSubstr("it must be 20x10 px"));
    EXPECT_THAT(MessageOf(method.Apply(cv::Mat(10, 20, CV_8UC1), {}, mask, 1)),
                HasSubstr("CV_8UC1"));
    const cv::Mat dark(10, 20, CV_8UC3, cv::Scalar::all(20));
    const cv::Mat bright(10, 20, CV_8UC3, cv::Scalar::all(220));
    for (int t = 0; t < 30; ++t) ASSERT_TRUE(method.Apply(dark, {}, mask, 1));
    EXPECT_EQ(cv::countNonZero(mask), 0);
    const cv::Mat behind = method.BackgroundImage({2, 3, 4, 5});
    EXPECT_EQ(behind.size(), cv::Size(4, 5));
    EXPECT_EQ(cv::norm(behind, dark({2, 3, 4, 5}), cv::NORM_INF), 0);
    EXPECT_THAT(MessageOf(method.Absorb(cv::Mat::zeros(10, 19, CV_8UC1))), HasSubstr("19x10 px"));
    EXPECT_THAT(MessageOf(method.Absorb(dark)), HasSubstr("CV_8UC3"));
    ASSERT_TRUE(method.Apply(bright, {}, mask, 1));
    EXPECT_EQ(cv::countNonZero(mask), 200);
    EXPECT_FALSE(method.Relight(cv::Mat(10, 20, CV_32FC3), 1).value()) << "cannot";
    method.Restart();
    EXPECT_TRUE(method.BackgroundImage({2, 3, 4, 5}).empty());
    for (int t = 0; t < 30; ++t) ASSERT_TRUE(method.Apply(bright, {}, mask, 1));
    EXPECT_EQ(cv::countNonZero(mask), 0);
  }
}

/// The masks of KNN hang on random numbers: they must be its own.
TEST(OpenCvMethods, MasksDoNotDependOnWhatElseTheProgramDoes) {
  for (const MethodKind kind : {MethodKind::kMog2, MethodKind::kKnn}) {
    std::vector<cv::Mat> masks[2];
    for (int run = 0; run < 2; ++run) {
      auto method = CreateMethod(kind, LeavingPerson::kSize, {}).value();
      cv::Mat mask;
      for (int t = 0; t < 60; ++t) {
        if (run == 1) cv::theRNG().next();
        ASSERT_TRUE(method->Apply(kScene.FrameAt(t), {}, mask, 1));
        masks[run].push_back(mask.clone());
      }
    }
    for (std::size_t t = 0; t < masks[0].size(); ++t) {
      ASSERT_EQ(cv::norm(masks[0][t], masks[1][t], cv::NORM_INF), 0) << t;
    }
  }
}

TEST(AbsorbedColors, ClearWhatLooksAsItWasAbsorbedUntilTheMethodHasLearntIt) {
  const cv::Mat floor(4, 6, CV_8UC3, cv::Scalar(100, 110, 120));
  const cv::Mat ghost = [] {
    cv::Mat pixels = cv::Mat::zeros(4, 6, CV_8UC1);
    pixels.colRange(2, 4) = 255;
    return pixels;
  }();
  AbsorbedColors colors;
  cv::Mat mask = ghost.clone();
  colors.TakeFrom(floor, mask);
  EXPECT_EQ(cv::countNonZero(mask), 8) << "nothing was absorbed yet";
  colors.Add(floor, ghost);
  mask.setTo(255);
  colors.TakeFrom(floor + cv::Scalar(20, -20, 20), mask);
  EXPECT_EQ(cv::norm(mask, ~ghost, cv::NORM_INF), 0);
  // Somebody walks in front and away again.
  mask.setTo(255);
  colors.TakeFrom(floor + cv::Scalar(0, 0, 21), mask);
  EXPECT_EQ(cv::countNonZero(mask), 24);
  mask.setTo(255);
  colors.TakeFrom(floor, mask);
  EXPECT_EQ(cv::countNonZero(mask), 16);
  // The method calls one column background: from now on it decides there.
  mask.setTo(255);
  mask.col(2) = 0;
  colors.TakeFrom(floor, mask);
  EXPECT_EQ(cv::countNonZero(mask), 16);
  mask.setTo(255);
  colors.TakeFrom(floor, mask);
  EXPECT_EQ(cv::countNonZero(mask.col(2)), 4);
  EXPECT_EQ(cv::countNonZero(mask.col(3)), 0);
  // Another colour absorbed at the same place takes the place of the first.
  colors.Add(floor + cv::Scalar::all(60), ghost);
  mask.setTo(255);
  colors.TakeFrom(floor, mask);
  EXPECT_EQ(cv::countNonZero(mask), 24);
}

/// A user's own: the background is the first frame.
class FirstFrame : public BackgroundMethod {
 public:
  Status Apply(const cv::Mat& bgr, const cv::Mat&, cv::Mat& mask, int) override {
    if (first_.empty()) first_ = bgr.clone();
    frame_ = bgr.clone();
    cv::Mat difference;
    cv::absdiff(bgr, first_, difference);
    cv::cvtColor(difference, difference, cv::COLOR_BGR2GRAY);
    mask = difference > 15;
    return {};
  }
  Status Absorb(const cv::Mat& pixels) override {
    frame_.copyTo(first_, pixels);
    return {};
  }
  void Restart() override {
    first_.release();
    ++restarts;
  }
  int restarts = 0;

 protected:
  cv::Mat first_, frame_;
};

class FirstFrameShown : public FirstFrame {
 public:
  cv::Mat BackgroundImage(const cv::Rect& region) const override { return first_(region).clone(); }
};

TEST(OwnMethod, GhostsGoWithTheRulesThatItCanServe) {
  for (const GhostCriterion rule : {GhostCriterion::kFep, GhostCriterion::kCb}) {
    BackgroundOptions options = OptionsOf(MethodKind::kMixture, rule);
    auto subtractor = rule == GhostCriterion::kFep
                          ? BackgroundSubtractor::Create(
                                LeavingPerson::kSize, std::make_unique<FirstFrameShown>(), options)
                          : BackgroundSubtractor::Create(LeavingPerson::kSize,
                                                         std::make_unique<FirstFrame>(), options);
    ASSERT_TRUE(subtractor);
    cv::Mat mask;
    for (int t = 0; t < 75; ++t) {
      const Status status = subtractor->Apply(kScene.FrameAt(t), mask, 1);
      ASSERT_TRUE(status) << MessageOf(status);
      if (t < 45) continue;
      EXPECT_GT(ForegroundShare(mask, kScene.At(t)), 0.9) << NameOf(rule) << " " << t;
      EXPECT_LT(ForegroundShare(mask, LeavingPerson::kStart), 0.03) << NameOf(rule) << " " << t;
    }
  }
}

TEST(OwnMethod, WithoutABackgroundPictureFepSaysWhatToDo) {
  auto subtractor =
      BackgroundSubtractor::Create(LeavingPerson::kSize, std::make_unique<FirstFrame>(),
                                   OptionsOf(MethodKind::kMixture, GhostCriterion::kFep));
  ASSERT_TRUE(subtractor);
  cv::Mat mask;
  Status status;
  for (int t = 0; t < 75 && status; ++t) {
    status = subtractor->Apply(kScene.FrameAt(t), mask, 1);
  }
  EXPECT_THAT(MessageOf(status), HasSubstr("choose epd or cb"));
}

TEST(OwnMethod, ThatCannotFollowTheLightIsRestarted) {
  auto own = std::make_unique<FirstFrameShown>();
  FirstFrameShown& method = *own;
  auto subtractor = BackgroundSubtractor::Create(
      LeavingPerson::kSize, std::move(own), OptionsOf(MethodKind::kMixture, GhostCriterion::kFep));
  ASSERT_TRUE(subtractor);
  cv::Mat mask;
  for (int t = 0; t < 80; ++t) {
    const cv::Mat frame = kScene.FrameAt(t) * (t < 60 ? 1 : 0.6);
    ASSERT_TRUE(subtractor->Apply(frame, mask, 1));
    if (t < 60) {
      EXPECT_TRUE(subtractor->reliable());
      EXPECT_EQ(method.restarts, 0);
    }
  }
  EXPECT_EQ(method.restarts, 1);
  EXPECT_LT(cv::countNonZero(mask), mask.total() / 4);
}

TEST(OwnMethod, ThatIsMissingOrAnswersAnotherMaskIsRefused) {
  EXPECT_THAT(MessageOf(BackgroundSubtractor::Create(LeavingPerson::kSize, nullptr, {})),
              HasSubstr("method"));
  class Broken : public FirstFrame {
   public:
    Status Apply(const cv::Mat& bgr, const cv::Mat&, cv::Mat& mask, int) override {
      mask = bgr.colRange(1, bgr.cols).clone();
      return {};
    }
  };
  BackgroundOptions options = OptionsOf(MethodKind::kMixture, GhostCriterion::kNone);
  options.disturbances.enabled = false;
  auto subtractor =
      BackgroundSubtractor::Create(LeavingPerson::kSize, std::make_unique<Broken>(), options);
  ASSERT_TRUE(subtractor);
  cv::Mat mask;
  EXPECT_THAT(MessageOf(subtractor->Apply(kScene.FrameAt(0), mask, 1)),
              HasSubstr("mask is 95x72 px of type CV_8UC3"));
}

}  // namespace
}  // namespace vantage
