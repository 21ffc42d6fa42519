// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/disturbance.h"

#include <gmock/gmock.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "vantage/background/test_camera.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using testing::Camera;
using ::testing::ElementsAre;
using testing::EventsOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::MessageOf;

constexpr ImageSize kSize{192, 144};
constexpr int kAt = 80;  // frame of the disturbance

/// A room with furniture; two people walk through it.
cv::Mat Room() {
  cv::Mat room(kSize.height + 40, kSize.width + 40, CV_8UC3, cv::Scalar(110, 120, 125));
  cv::RNG random(11);
  for (int i = 0; i < 60; ++i) {
    const cv::Rect box(random.uniform(0, 220), random.uniform(0, 170), random.uniform(5, 40),
                       random.uniform(5, 40));
    cv::rectangle(
        room, box,
        cv::Scalar(random.uniform(50, 160), random.uniform(50, 160), random.uniform(50, 160)), -1);
  }
  return room;
}

cv::Rect PersonAt(int t, int which) {
  const int x = which == 0 ? (t * 2) % 150 : 160 - (t * 3) % 150;
  return {x, 40 + 30 * which, 16, 50};
}

cv::Mat FrameAt(int t, cv::Point shift = {}) {
  static const cv::Mat room = Room();
  cv::Mat frame = room(cv::Rect(20, 20, kSize.width, kSize.height) - shift).clone();
  frame(PersonAt(t, 0)) = cv::Scalar(30, 20, 40);
  frame(PersonAt(t, 1)) = cv::Scalar(170, 60, 50);
  return frame;
}

cv::Mat Noisy(const cv::Mat& picture, int t) {
  cv::Mat noise(picture.size(), CV_8UC3);
  cv::RNG random(static_cast<std::uint64_t>(t + 1));
  random.fill(noise, cv::RNG::NORMAL, 10, 2);
  return picture + noise - cv::Scalar::all(10);
}

/// Runs `frames` frames, disturbed from kAt on; `check` sees each frame's mask from there on.
using Disturb = std::function<cv::Mat(int t)>;
DisturbanceReport Watch(int frames, const Disturb& disturb,
                        const std::function<void(int t, const cv::Mat& mask)>& check = {},
                        Camera camera = Camera(kSize)) {
  for (int t = 0; t < frames; ++t) {
    const cv::Mat mask = camera.Step(t < kAt ? Noisy(FrameAt(t), t) : disturb(t));
    if (t == kAt - 1) {
      EXPECT_THAT(EventsOf(camera.report()), IsEmpty());
    }
    if (t >= kAt && check) check(t, mask);
  }
  return camera.report();
}

/// People are found and little else.
void ExpectGoodMask(int t, const cv::Mat& mask) {
  cv::Mat people = cv::Mat::zeros(mask.size(), CV_8UC1);
  for (int which = 0; which < 2; ++which) {
    const cv::Rect person = PersonAt(t, which);
    people(person) = 255;
    EXPECT_GT(cv::countNonZero(mask(person)), 0.75 * person.area()) << "frame " << t;
  }
  EXPECT_LT(cv::countNonZero(mask & ~people), 0.03 * mask.size().area()) << "frame " << t;
}

TEST(Disturbance, ALightChangeIsReportedOnceAndUndoneAtOnce) {
  const auto one_sided = [](const cv::Mat& frame) {
    cv::Mat row(1, frame.cols, CV_32FC3), gain, lit;
    for (int x = 0; x < frame.cols; ++x) {
      row.at<cv::Vec3f>(0, x) = cv::Vec3f::all(1.6F - 0.6F * static_cast<float>(x) / frame.cols);
    }
    cv::repeat(row, frame.rows, 1, gain);
    frame.convertTo(lit, CV_32F);
    cv::Mat(lit.mul(gain)).convertTo(lit, CV_8U);
    return lit;
  };
  const std::function<cv::Mat(const cv::Mat&)> lights[] = {
      [](const cv::Mat& frame) { return cv::Mat(0.6 * frame); },
      [](const cv::Mat& frame) { return cv::Mat(1.5 * frame); },
      [](const cv::Mat& frame) { return cv::Mat(frame + cv::Scalar::all(30)); },
      [](const cv::Mat& frame) { return cv::Mat(frame.mul(cv::Scalar(0.6, 0.8, 1.2))); },
      one_sided,
  };
  for (const auto& light : lights) {
    SCOPED_TRACE(&light - lights);
    const DisturbanceReport report = Watch(
        kAt + 30, [&](int t) { return Noisy(light(FrameAt(t)), t); },
        [](int t, const cv::Mat& mask) { ExpectGoodMask(t, mask); });
    ASSERT_THAT(EventsOf(report), ElementsAre(DisturbanceKind::kLight));
    EXPECT_EQ(report.events[0].frame, kAt);
    EXPECT_LE(report.events[0].frames, 5);
    EXPECT_EQ(report.restarts, 0);
    EXPECT_EQ(report.skipped, 0);
  }
}

TEST(Disturbance, ALightThatChangesOverHalfASecondIsOneEvent) {
  for (const double end : {0.5, 1.5}) {
    const DisturbanceReport report = Watch(
        kAt + 40,
        [&](int t) {
          const double gain = 1 + (end - 1) * std::min(1.0, (t - kAt + 1) / 12.0);
          return Noisy(gain * FrameAt(t), t);
        },
        [](int t, const cv::Mat& mask) {
          if (t >= kAt + 14) ExpectGoodMask(t, mask);
        });
    ASSERT_THAT(EventsOf(report), ElementsAre(DisturbanceKind::kLight)) << end;
    EXPECT_NEAR(report.events[0].factor, end, 0.15);
  }
}

TEST(Disturbance, ASlowGainOfTheCameraIsNone) {
  const DisturbanceReport report = Watch(kAt + 250, [](int t) {
    return Noisy((1 - 0.3 * std::min(1.0, (t - kAt) / 200.0)) * FrameAt(t), t);
  });
  EXPECT_THAT(EventsOf(report), IsEmpty());
}

TEST(Disturbance, ACrowdOrABusIsNone) {
  const DisturbanceReport crowd = Watch(kAt + 50, [](int t) {
    cv::Mat frame = FrameAt(t);
    cv::RNG random(9);
    for (int i = 0; i < std::min(25, 3 * (t - kAt)); ++i) {
      const int x = (random.uniform(0, 400) + 2 * t) % 180;
      frame(cv::Rect(x, random.uniform(0, 100), 12, 44)) =
          cv::Scalar(random.uniform(0, 255), random.uniform(0, 255), random.uniform(0, 255));
    }
    return Noisy(frame, t);
  });
  EXPECT_THAT(EventsOf(crowd), IsEmpty());
  const DisturbanceReport bus = Watch(kAt + 80, [](int t) {
    cv::Mat frame = FrameAt(t);
    const int front = std::min(12 * (t - kAt), 180);
    if (t < kAt + 60 && front > 0) {
      frame(cv::Rect(0, 20, front, 115)) = cv::Scalar(60, 70, 190);
      for (int x = front - 30; x >= 0; x -= 36)
        frame(cv::Rect(x, 35, 24, 30)) = cv::Scalar::all(35);
    }
    return Noisy(frame, t);
  });
  EXPECT_THAT(EventsOf(bus), IsEmpty());
}

TEST(Disturbance, FramesThatRepeatAreSkippedFromTheLimitOn) {
  cv::Mat last;
  const auto frozen = [](int t) {
    return t < kAt + 60 ? Noisy(FrameAt(kAt), kAt) : Noisy(FrameAt(t), t);
  };
  const auto encoded = [&](int t) {  // by an encoder that alters a few levels
    cv::Mat frame = frozen(t);
    cv::RNG random(static_cast<std::uint64_t>(t));
    for (int i = 0; i < 200; ++i) {
      frame.at<cv::Vec3b>(random.uniform(0, frame.rows), random.uniform(0, frame.cols)) +=
          cv::Vec3b(1, 1, 1);
    }
    return frame;
  };
  for (const Disturb& disturb : {Disturb(frozen), Disturb(encoded)}) {
    const DisturbanceReport report = Watch(kAt + 70, disturb);
    ASSERT_THAT(EventsOf(report), ElementsAre(DisturbanceKind::kFreeze));
    EXPECT_EQ(report.events[0].frame, kAt + 25);  // kAt is the first that is not a repetition
    EXPECT_EQ(report.events[0].frames, 35);
    EXPECT_EQ(report.skipped, 35);
  }
}

TEST(Disturbance, StillScenesAndDoubledFramesAreNotFrozen) {
  EXPECT_THAT(EventsOf(Watch(kAt + 80, [](int t) { return Noisy(FrameAt(kAt), t); })), IsEmpty());
  EXPECT_THAT(EventsOf(Watch(kAt + 80, [](int t) { return Noisy(FrameAt(t / 2 * 2), t / 2 * 2); })),
              IsEmpty());
}

TEST(Disturbance, SomethingSmallThatMovesIsNotFrozen) {
  // Drawn without noise, between the samples for most of the time.
  const DisturbanceReport report = Watch(kAt + 80, [](int t) {
    cv::Mat frame = FrameAt(kAt);
    frame.at<cv::Vec3b>(71, 20 + (t / 2) % 150) = cv::Vec3b(255, 255, 255);
    return frame;
  });
  EXPECT_THAT(EventsOf(report), IsEmpty());
}

TEST(Disturbance, ABlackPictureTeachesNothing) {
  for (const cv::Scalar& color : {cv::Scalar(0, 0, 0), cv::Scalar(250, 40, 0)}) {
    const DisturbanceReport report = Watch(
        kAt + 60,
        [&](int t) {
          const cv::Mat plain(kSize.height, kSize.width, CV_8UC3, color);
          return Noisy(t < kAt + 30 ? plain : FrameAt(t), t);
        },
        [](int t, const cv::Mat& mask) {
          if (t < kAt + 30) {
            EXPECT_EQ(cv::countNonZero(mask), 0);
          } else {
            ExpectGoodMask(t, mask);
          }
        });
    ASSERT_THAT(EventsOf(report), ElementsAre(DisturbanceKind::kBlack));
    EXPECT_EQ(report.events[0].frame, kAt);
    EXPECT_EQ(report.events[0].frames, 30);
    EXPECT_EQ(report.skipped, 30);
  }
}

TEST(Disturbance, AMovedCameraBeginsAnew) {
  const DisturbanceReport report = Watch(kAt + 40, [](int t) {
    return Noisy(FrameAt(t, {4, -3}), t);
  });
  ASSERT_THAT(EventsOf(report), ElementsAre(DisturbanceKind::kMoved));
  EXPECT_LE(report.events[0].frame, kAt + 25);
  EXPECT_NEAR(report.events[0].length_px, 5, 0.5);
  EXPECT_EQ(report.restarts, 1);
}

TEST(Disturbance, ACameraThatShakesIsNotMoved) {
  const DisturbanceReport report = Watch(kAt + 80, [](int t) {
    return Noisy(FrameAt(t, {cvRound(4 * std::sin(0.9 * t)), cvRound(3 * std::cos(0.7 * t))}), t);
  });
  EXPECT_THAT(EventsOf(report), IsEmpty());
}

TEST(Disturbance, AnotherSceneIsLearntAnewAsALastResort) {
  DisturbanceOptions options;
  options.restart_secs = 0.2;
  const DisturbanceReport report = Watch(
      kAt + 40,
      [](int t) {
        cv::Mat other;
        cv::flip(FrameAt(t), other, -1);
        return Noisy(255 - other, t);
      },
      [](int t, const cv::Mat& mask) {
        if (t > kAt + 30) {
          EXPECT_LT(cv::countNonZero(mask), 0.25 * mask.size().area());
        }
      },
      Camera(kSize, options));
  ASSERT_THAT(EventsOf(report), ElementsAre(DisturbanceKind::kLost));
  EXPECT_NEAR(static_cast<double>(report.events[0].frame), kAt + 25, 3);
}

TEST(Disturbance, CanBeOff) {
  DisturbanceOptions off;
  off.enabled = false;
  const DisturbanceReport report = Watch(
      kAt + 40, [](int t) { return cv::Mat(t < kAt + 5 ? 0.5 * FrameAt(t) : 0 * FrameAt(t)); }, {},
      Camera(kSize, off));
  EXPECT_THAT(EventsOf(report), IsEmpty());
}

TEST(Disturbance, TakesPicturesOfAnySizeAndContent) {
  cv::RNG random(1);
  for (const ImageSize size : {ImageSize{1, 1}, ImageSize{1, 40}, ImageSize{700, 2},
                               ImageSize{33, 17}, ImageSize{80, 90}}) {
    Camera camera(size);
    for (int t = 0; t < 120; ++t) {
      cv::Mat frame(size.height, size.width, CV_8UC3, cv::Scalar::all(t / 10 % 2 * 255));
      if (t % 50 > 30) random.fill(frame, cv::RNG::UNIFORM, 0, 256);
      camera.Step(frame);
    }
  }
}

TEST(Disturbance, RefusesWrongFramesMasksAndOptions) {
  auto detector = DisturbanceDetector::Create({8, 6}, {});
  ASSERT_TRUE(detector);
  EXPECT_THAT(MessageOf(detector->Look(cv::Mat(6, 9, CV_8UC3))), HasSubstr("must be 8x6 px"));
  EXPECT_THAT(MessageOf(detector->Look(cv::Mat())), HasSubstr("frame 0 is 0x0 px"));
  const auto none = [](const cv::Rect&) { return cv::Mat(); };
  EXPECT_THAT(MessageOf(detector->Inspect(cv::Mat(6, 8, CV_8UC3), cv::Mat(6, 8, CV_8UC3), none)),
              HasSubstr("must be 8x6 px"));
  EXPECT_THAT(MessageOf(DisturbanceDetector::Create({0, 6}, {})), HasSubstr("at least 1 px"));
  EXPECT_THAT(MessageOf(DisturbanceDetector::Create({8, 6}, {}, 0)), HasSubstr("above 0"));
  DisturbanceOptions wrong;
  wrong.light_share = 0;
  EXPECT_EQ(MessageOf(DisturbanceDetector::Create({8, 6}, wrong)),
            "background.light_share is 0; it must be above 0 and at most 1");
  nlohmann::ordered_json json;
  RecordOptions(DisturbanceOptions{}, json);
  EXPECT_EQ(json.dump(),
            R"({"disturbances":true,"light_share":0.4,"freeze_secs":1.0,"uniform_levels":12,)"
            R"("moved_px":2.0,"restart_secs":1.0})");
}

TEST(Disturbance, ABackgroundPictureOfAWrongSizeIsAnError) {
  auto detector = DisturbanceDetector::Create(kSize, {});
  ASSERT_TRUE(detector);
  const auto wrong = [](const cv::Rect&) { return cv::Mat(3, 3, CV_8UC3); };
  const cv::Mat empty = cv::Mat::zeros(kSize.height, kSize.width, CV_8UC1);
  for (int t = 0; t < 30; ++t) {
    ASSERT_TRUE(detector->Look(Noisy(FrameAt(t), t)));
    ASSERT_TRUE(detector->Inspect(Noisy(FrameAt(t), t), empty, wrong));
  }
  ASSERT_TRUE(detector->Look(FrameAt(30)));
  EXPECT_THAT(MessageOf(detector->Inspect(FrameAt(30), ~empty, wrong)), HasSubstr("is 3x3 px"));
}

}  // namespace
}  // namespace vantage
