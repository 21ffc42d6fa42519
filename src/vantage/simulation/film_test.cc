// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"
#include "vantage/simulation/test_stage.h"

namespace vantage::simulation {
namespace {

using testing::Ball;
using testing::BallThing;
using ::testing::HasSubstr;
using testing::kTestBlack;
using testing::kTestRed;
using testing::MessageOf;
using testing::Person;
using ::testing::SizeIs;
using testing::TestStage;

std::vector<Thing> Nothing(FrameIndex) { return {}; }

/// Three people: one walks, one stands, one passes behind the first.
std::vector<Thing> Walkers(FrameIndex frame) {
  const double step = 0.1 * static_cast<double>(frame);
  return {Person(1, {-2 + step, 0}, kTestRed), Person(2, {2, 2}, kTestBlack),
          Person(7, {1 - step, 1.5}, kTestRed)};
}

Film MakeFilm(const Stage& stage, std::uint64_t seed = 1, int threads = 1) {
  return Film::Create(stage, seed, threads).value();
}

Shot ShotAt(Film& film, FrameIndex frame, int threads = 1) {
  return film.Shoot(frame, threads).value().at(0);
}

double LargestDifference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_INF);
}

void ExpectEqual(const Shot& a, const Shot& b) {
  EXPECT_EQ(LargestDifference(a.picture, b.picture), 0);
  EXPECT_EQ(LargestDifference(a.mask, b.mask), 0);
  ASSERT_EQ(a.sightings.size(), b.sightings.size());
  for (std::size_t i = 0; i < a.sightings.size(); ++i) {
    EXPECT_EQ(a.sightings[i].id, b.sightings[i].id);
    EXPECT_EQ(a.sightings[i].pixels, b.sightings[i].pixels);
    EXPECT_EQ(a.sightings[i].visible_pixels, b.sightings[i].visible_pixels);
    EXPECT_EQ(a.sightings[i].box, b.sightings[i].box);
  }
}

/// Without noise, so that two pictures differ only where their light does.
Stage Noiseless(Stage stage) {
  for (StageCamera& camera : stage.cameras) camera.noise = 0;
  return stage;
}

cv::Scalar MeanAround(const Shot& shot, const Stage& stage, const Eigen::Vector3d& world_m) {
  const auto pixel = stage.cameras[0].camera.ImageFromWorld(world_m).value();
  const cv::Rect box(static_cast<int>(std::lround(pixel.x())) - 1,
                     static_cast<int>(std::lround(pixel.y())) - 1, 3, 3);
  return cv::mean(shot.picture(box));
}

/// Green: as good as any for grey light.
double GreenAround(const Shot& shot, const Stage& stage, const Eigen::Vector3d& world_m) {
  return MeanAround(shot, stage, world_m)[1];
}

TEST(Film, MaskOfABallIsWhereGeometrySays) {
  const Eigen::Vector3d center_m(0.7, 0.4, 1.2);
  constexpr double kRadius_m = 0.9;
  const Stage stage = TestStage([&](FrameIndex) {
    return std::vector<Thing>{BallThing(3, center_m.cast<float>(), kRadius_m, kTestRed)};
  });
  Film film = MakeFilm(stage);
  const Shot shot = ShotAt(film, 0);
  const Camera& camera = stage.cameras[0].camera;
  std::int64_t inside = 0;
  cv::Rect box;
  for (int y = 0; y < shot.mask.rows; ++y) {
    for (int x = 0; x < shot.mask.cols; ++x) {
      // Distance of the centre to the ray, through a point of it on the ground.
      const Eigen::Vector3d ground = camera.WorldFromImage({x, y}).value();
      const Eigen::Vector3d way = (ground - camera.center_m()).normalized();
      const double distance = way.cross(center_m - camera.center_m()).norm();
      if (std::abs(distance - kRadius_m) < 1e-4) continue;
      EXPECT_EQ(shot.mask.at<std::uint8_t>(y, x), distance < kRadius_m ? 255 : 0) << x << " " << y;
      if (distance < kRadius_m) {
        ++inside;
        const cv::Rect pixel(x, y, 1, 1);
        box = box.empty() ? pixel : box | pixel;
      }
    }
  }
  EXPECT_GT(inside, 100);
  ASSERT_THAT(shot.sightings, SizeIs(1));
  EXPECT_EQ(shot.sightings[0].id, 3);
  EXPECT_EQ(shot.sightings[0].pixels, inside);
  EXPECT_EQ(shot.sightings[0].visible_pixels, inside);
  EXPECT_EQ(shot.sightings[0].box, box);
  const cv::Scalar color = MeanAround(shot, stage, center_m);
  EXPECT_GT(color[2], 2 * color[1]) << "it is red";
}

TEST(Film, PicturesDoNotDependOnFramesBefore) {
  const auto gains = [](FrameIndex frame) {
    return std::vector<float>{1, frame < 3 ? 1.0F : 0.8F};
  };
  const Stage stage = TestStage(Walkers, gains, 0.1F);
  Film in_order = MakeFilm(stage);
  for (FrameIndex frame = 0; frame <= 6; ++frame) {
    const Shot shot = ShotAt(in_order, frame);
    Film fresh = MakeFilm(stage);
    ExpectEqual(shot, ShotAt(fresh, frame));
  }
  Film backwards = MakeFilm(stage);
  ShotAt(backwards, 200);
  const Shot back = ShotAt(backwards, 6);
  ExpectEqual(back, ShotAt(in_order, 6));
}

TEST(Film, PicturesDoNotDependOnThreads) {
  const Stage stage = TestStage(Walkers, nullptr, 0.1F);
  Film one = MakeFilm(stage, 1, 1);
  Film three = MakeFilm(stage, 1, 3);
  for (FrameIndex frame = 0; frame < 5; ++frame) {
    ExpectEqual(ShotAt(one, frame, 1), ShotAt(three, frame, 3));
  }
}

TEST(Film, SeedChangesNoiseOnly) {
  const Stage stage = TestStage(Walkers);
  Film first = MakeFilm(stage, 1);
  Film second = MakeFilm(stage, 2);
  const Shot a = ShotAt(first, 0);
  const Shot b = ShotAt(second, 0);
  EXPECT_EQ(LargestDifference(a.mask, b.mask), 0);
  const double difference = LargestDifference(a.picture, b.picture);
  EXPECT_GT(difference, 0);
  EXPECT_LT(difference, 20);

  const Stage noiseless = Noiseless(TestStage(Walkers));
  Film third = MakeFilm(noiseless, 1);
  Film fourth = MakeFilm(noiseless, 2);
  ExpectEqual(ShotAt(third, 0), ShotAt(fourth, 0));
}

TEST(Film, NoiseHasTheAskedDeviationAtWhite) {
  Stage stage = TestStage(Nothing);
  constexpr double kNoise = 0.02;
  stage.cameras[0].noise = kNoise;
  stage.cameras[0].vignetting = 0;
  // White is 1; a little less, so that nothing is cut off.
  stage.materials[0] = {Material::Pattern::kPlain, {1, 1, 1}};
  stage.blocks.resize(1);
  stage.lighting.lamps.clear();
  stage.lighting.ambient = {0.8F, 0.8F, 0.8F};
  stage.script = std::make_unique<testing::TestScript>(
      Nothing, [](FrameIndex) { return std::vector<float>{1}; });
  Film film = MakeFilm(stage);
  cv::Mat a;
  cv::Mat b;
  ShotAt(film, 0).picture.convertTo(a, CV_64FC3);
  ShotAt(film, 1).picture.convertTo(b, CV_64FC3);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(a - b, mean, deviation);
  // Slope of sRGB's curve at 0.8, times the noise there, times sqrt(2) for a difference.
  const double slope = 255 * 1.055 / 2.4 * std::pow(0.8, 1 / 2.4 - 1);
  const double expected = slope * kNoise * std::sqrt(0.8) * std::sqrt(2);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(mean[channel], 0, 0.2);
    EXPECT_NEAR(deviation[channel], expected, 0.1 * expected);
  }
}

TEST(Film, StillStageKeepsItsPicture) {
  const Stage stage = Noiseless(TestStage(
      [](FrameIndex) {
        return std::vector<Thing>{Person(1, {0, 0}, kTestRed)};
      },
      nullptr, 0.1F));
  Film film = MakeFilm(stage);
  const Shot first = ShotAt(film, 0);
  const double traced = film.report().pixels_traced;
  EXPECT_GT(traced, 0);
  EXPECT_LT(traced, 96 * 72 / 2) << "only tiles around the person";
  ExpectEqual(first, ShotAt(film, 1));
  EXPECT_EQ(film.report().pixels_traced, traced) << "nothing moved: nothing is traced";
  EXPECT_EQ(film.report().shots, 2);
  EXPECT_EQ(film.report().pixels, 2 * 96 * 72);
}

TEST(Film, WhatLeavesLeavesNoTrace) {
  const auto come_and_go = [](FrameIndex frame) {
    return frame == 1 ? Walkers(0) : std::vector<Thing>{};
  };
  const Stage stage = Noiseless(TestStage(come_and_go, nullptr, 0.1F));
  Film film = MakeFilm(stage);
  const Shot before = ShotAt(film, 0);
  const Shot during = ShotAt(film, 1);
  EXPECT_GT(LargestDifference(before.picture, during.picture), 50);
  ExpectEqual(before, ShotAt(film, 2));
  EXPECT_THAT(before.sightings, SizeIs(0));
  EXPECT_EQ(cv::countNonZero(before.mask), 0);
}

TEST(Film, HiddenPeopleKeepTheirExtent) {
  // 2 stands right behind 1, as the camera sees it.
  const auto behind = [](FrameIndex frame) {
    std::vector<Thing> people = {Person(1, {0, -2}, kTestRed), Person(2, {0.1, -1.3}, kTestBlack)};
    if (frame == 1) people.erase(people.begin());
    return people;
  };
  const Stage stage = TestStage(behind);
  Film film = MakeFilm(stage);
  const Shot hidden = ShotAt(film, 0);
  const Shot alone = ShotAt(film, 1);
  ASSERT_THAT(hidden.sightings, SizeIs(2));
  ASSERT_THAT(alone.sightings, SizeIs(1));
  EXPECT_EQ(hidden.sightings[0].visible_pixels, hidden.sightings[0].pixels);
  EXPECT_LT(hidden.sightings[1].visible_pixels, hidden.sightings[1].pixels / 2);
  EXPECT_EQ(hidden.sightings[1].pixels, alone.sightings[0].pixels);
  EXPECT_EQ(hidden.sightings[1].box, alone.sightings[0].box);
  EXPECT_EQ(alone.sightings[0].visible_pixels, alone.sightings[0].pixels);
  EXPECT_EQ(cv::countNonZero(hidden.mask),
            hidden.sightings[0].visible_pixels + hidden.sightings[1].visible_pixels);
}

TEST(Film, FixedThingsHide) {
  const Stage stage = TestStage([](FrameIndex) {
    return std::vector<Thing>{Person(1, {0, 11}, kTestRed)};
  });
  Film film = MakeFilm(stage);  // the wall is 2 m high, 1 m before the person
  const Shot shot = ShotAt(film, 0);
  ASSERT_THAT(shot.sightings, SizeIs(1));
  EXPECT_GT(shot.sightings[0].pixels, 0);
  EXPECT_LT(shot.sightings[0].visible_pixels, shot.sightings[0].pixels);
}

TEST(Film, OnlyForegroundIsInTheTruth) {
  const auto things = [](FrameIndex) {
    std::vector<Thing> all = {Person(1, {-2, 0}, kTestRed), Person(2, {0, 0}, kTestRed),
                              Person(3, {2, 0}, kTestRed)};
    all[0].kind = Thing::Kind::kScenery;
    all[1].kind = Thing::Kind::kObject;
    all[1].foreground = false;
    all[2].kind = Thing::Kind::kObject;
    return all;
  };
  const Stage stage = TestStage(things);
  Film film = MakeFilm(stage);
  const Shot shot = ShotAt(film, 0);
  ASSERT_THAT(shot.sightings, SizeIs(1));
  EXPECT_EQ(shot.sightings[0].id, 3);
  EXPECT_EQ(cv::countNonZero(shot.mask), shot.sightings[0].visible_pixels);
}

TEST(Film, ShadowLiesWhereTheLampThrowsIt) {
  const auto ball = [](FrameIndex frame) {
    std::vector<Thing> things;
    if (frame == 0) things.push_back(BallThing(1, {2, 1, 2}, 0.3F, kTestRed));
    return things;
  };
  const Stage stage = Noiseless(TestStage(ball));
  Film film = MakeFilm(stage);
  const Shot with = ShotAt(film, 0);
  const Shot without = ShotAt(film, 1);
  // The line from the lamp at (0, 0, 20) through the ball at (2, 1, 2) meets the ground 20/18 as
  // far out.
  const Eigen::Vector3d shadow(2 * 20.0 / 18, 20.0 / 18, 0);
  EXPECT_LT(GreenAround(with, stage, shadow), 0.8 * GreenAround(without, stage, shadow));
  const Eigen::Vector3d beside(-2 * 20.0 / 18, 20.0 / 18, 0);
  EXPECT_EQ(GreenAround(with, stage, beside), GreenAround(without, stage, beside));
}

TEST(Film, FixedShadowLiesWhereTheLampThrowsIt) {
  const Stage bare = Noiseless(TestStage(Nothing));
  Stage roofed = Noiseless(TestStage(Nothing));
  roofed.blocks.push_back({{2, 1, 4}, {0.8F, 0.8F, 0}, 0, kTestBlack});
  Film without = MakeFilm(bare);
  Film with = MakeFilm(roofed);
  const Eigen::Vector3d shadow(2 * 20.0 / 16, 20.0 / 16, 0);
  EXPECT_LT(GreenAround(ShotAt(with, 0), bare, shadow),
            0.8 * GreenAround(ShotAt(without, 0), bare, shadow));
}

TEST(Film, GlossyGroundMirrors) {
  const auto ball = [](FrameIndex frame) {
    std::vector<Thing> things;
    if (frame == 0) things.push_back(BallThing(1, {0, 2, 2}, 0.6F, kTestRed));
    return things;
  };
  // Where the camera at (0, -8, 6) sees the mirror image at (0, 2, -2) through the ground.
  const Eigen::Vector3d mirrored(0, -8 + 10 * 6.0 / 8, 0);
  const auto color = [&](float gloss, FrameIndex frame) {
    const Stage stage = Noiseless(TestStage(ball, nullptr, gloss));
    Film film = MakeFilm(stage);
    return MeanAround(ShotAt(film, frame), stage, mirrored);
  };
  const cv::Scalar with = color(0.5F, 0);
  const cv::Scalar without = color(0.5F, 1);
  EXPECT_LT(with[1], 0.75 * without[1]) << "the ball stands before the bright sky";
  EXPECT_GT(with[2] / with[1], 1.1 * without[2] / without[1]) << "and is red";
  EXPECT_EQ(color(0, 0), color(0, 1)) << "dull ground mirrors nothing";
}

TEST(Film, GainsScaleTheLight) {
  const auto gains = [](FrameIndex frame) {
    const float gain = frame == 0 ? 0.5F : 0.25F;
    return std::vector<float>{gain, gain};
  };
  const Stage stage = Noiseless(TestStage(Walkers, gains));
  Stage darker = Noiseless(TestStage(Walkers, [](FrameIndex) {
    return std::vector<float>{0.5F, 0.5F};
  }));
  darker.cameras[0].exposure = 0.5;
  Film film = MakeFilm(stage);
  Film dark_film = MakeFilm(darker);
  const Shot bright = ShotAt(film, 0);
  EXPECT_LT(cv::mean(ShotAt(film, 1).picture)[1], 0.85 * cv::mean(bright.picture)[1]);
  // Half of the light with twice the exposure is the same picture.
  const Shot halved = ShotAt(dark_film, 1);
  EXPECT_LE(LargestDifference(halved.picture, ShotAt(film, 1).picture), 1);
}

TEST(Film, PixelsWithoutARayStayBlack) {
  Stage stage = TestStage(Walkers);
  // So much barrel distortion that the corners lie beyond the cone of the lens.
  const PinholeModel lens{
      .fx_px = 40, .fy_px = 40, .cx_px = 47.5, .cy_px = 35.5, .distortion = {-0.4}};
  stage.cameras[0].camera =
      Camera::Create({96, 72}, lens, testing::LookAt({0, -8, 6}, {0, 0, 0})).value();
  ASSERT_FALSE(stage.cameras[0].camera.RayFromImage({0, 0}));
  stage.cameras[0].noise = 0;
  Film film = MakeFilm(stage);
  const Shot shot = ShotAt(film, 0);
  EXPECT_EQ(shot.picture.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 0));
  EXPECT_NE(shot.picture.at<cv::Vec3b>(36, 48), cv::Vec3b(0, 0, 0));
}

TEST(Film, RejectsInconsistentStages) {
  const auto message = [](auto change) {
    Stage stage = TestStage(Nothing);
    change(stage);
    return MessageOf(Film::Create(stage, 1, 1));
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(message([](Stage& stage) { stage.blocks[0].material = 4; }),
              HasSubstr("material 4 is out of range; there are 4"));
  EXPECT_THAT(message([](Stage& stage) { stage.blocks[0].center_m.y() = kNan; }),
              HasSubstr("not a finite number"));
  EXPECT_THAT(message([](Stage& stage) {
                stage.limbs.push_back(Ball({0, 0, 0}, 0, 0));
              }),
              HasSubstr("radii"));
  EXPECT_THAT(message([](Stage& stage) { stage.cameras.clear(); }), HasSubstr("no camera"));
  EXPECT_THAT(message([](Stage& stage) { stage.script = nullptr; }), HasSubstr("no script"));
  EXPECT_THAT(message([](Stage& stage) { stage.materials[1].scale_m = 0; }),
              HasSubstr("scale_m is 0"));
  EXPECT_THAT(message([](Stage& stage) { stage.lighting.lamps[0].half_u_m.setZero(); }),
              HasSubstr("no length"));
  EXPECT_THAT(
      message([](Stage& stage) { stage.lighting.lamps.resize(5, stage.lighting.lamps[0]); }),
      HasSubstr("at most 4"));
  EXPECT_THAT(message([](Stage& stage) { stage.cameras[0].exposure = -1; }),
              HasSubstr("exposure is -1"));
}

TEST(Film, RejectsInconsistentFrames) {
  const auto script = [](FrameIndex frame) {
    std::vector<Thing> things = {Person(1, {0, 0}, kTestRed), Person(2, {1, 0}, kTestRed)};
    if (frame == 1) things[1].id = 1;
    if (frame == 2) things[0].limbs[0].material = -1;
    if (frame == 3) things[0].limbs[0].a_m.x() = std::numeric_limits<float>::infinity();
    return things;
  };
  const auto gains = [](FrameIndex frame) {
    return std::vector<float>(frame == 4 ? 1 : 2, frame == 5 ? -1.0F : 1.0F);
  };
  const Stage stage = TestStage(script, gains);
  Film film = MakeFilm(stage);
  const Shot first = ShotAt(film, 0);
  EXPECT_THAT(MessageOf(film.Shoot(1, 1)), HasSubstr("thing 1 follows 1"));
  EXPECT_THAT(MessageOf(film.Shoot(2, 1)), HasSubstr("frame 2: thing 1: material -1"));
  EXPECT_THAT(MessageOf(film.Shoot(3, 1)), HasSubstr("not a place"));
  EXPECT_THAT(MessageOf(film.Shoot(4, 1)), HasSubstr("1 gains for 2 groups"));
  EXPECT_THAT(MessageOf(film.Shoot(5, 1)), HasSubstr("a gain is -1"));
  EXPECT_THAT(MessageOf(film.Shoot(1000, 1)), HasSubstr("frame 1000"));
  EXPECT_THAT(MessageOf(film.Shoot(-1, 1)), HasSubstr("frame -1"));
  ExpectEqual(first, ShotAt(film, 0));
}

}  // namespace
}  // namespace vantage::simulation
