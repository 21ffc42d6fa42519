// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/geometry/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "vantage/base/test_support.h"
#include "vantage/geometry/test_cameras.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using testing::LookAt;
using testing::MessageOf;
using testing::Random;
using testing::RandomPinhole;
using testing::RandomPose;
using testing::RandomTsai;

constexpr ImageSize kSize = {768, 576};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Camera at the world's origin, looking along z: world coordinates are camera coordinates.
Camera AtOrigin(const LensModel& lens) { return Camera::Create(kSize, lens, CameraPose{}).value(); }

PinholeModel Barrel(double k1) {
  return {.fx_px = 500, .fy_px = 500, .cx_px = 383.5, .cy_px = 287.5, .distortion = {k1}};
}

/// OpenCV's projection: the independent reference, without a check of the lens's cone.
Vector2d ProjectByOpenCv(const PinholeModel& lens, const CameraPose& pose,
                         const Vector3d& world_m) {
  cv::Matx33d rotation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation(row, column) = pose.rotation(row, column);
  }
  cv::Vec3d turn;
  cv::Rodrigues(rotation, turn);
  const cv::Vec3d shift(pose.translation_m.x(), pose.translation_m.y(), pose.translation_m.z());
  const cv::Matx33d matrix(lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1);
  const std::vector<double> distortion(lens.distortion.begin(), lens.distortion.end());
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(std::vector<cv::Point3d>{{world_m.x(), world_m.y(), world_m.z()}}, turn, shift,
                    matrix, distortion, pixels);
  return {pixels[0].x, pixels[0].y};
}

TEST(Camera, RaysOfPixelsPassThroughWhatTheyShow) {
  Random random(11);
  for (int round = 0; round < 100; ++round) {
    const LensModel lens = round % 2 == 0 ? LensModel(RandomPinhole(random)) : RandomTsai(random);
    const Camera camera = Camera::Create(kSize, lens, RandomPose(random)).value();
    const Vector2d pixel(random.Between(200, 500), random.Between(150, 400));
    const auto ray = camera.RayFromImage(pixel);
    if (!ray) continue;
    EXPECT_NEAR(ray->norm(), 1, 1e-12);
    const auto back = camera.ImageFromWorld(camera.center_m() + 7 * *ray);
    ASSERT_TRUE(back);
    EXPECT_LT((*back - pixel).norm(), 1e-6);
  }
}

TEST(Camera, PixelsAboveTheHorizonHaveRays) {
  const PinholeModel lens{.fx_px = 500, .fy_px = 500, .cx_px = 383.5, .cy_px = 287.5};
  const Camera camera = Camera::Create(kSize, lens, LookAt({0, 0, 2}, {10, 0, 2})).value();
  EXPECT_FALSE(camera.WorldFromImage({383.5, 87.5}));
  const auto ray = camera.RayFromImage({383.5, 87.5});
  ASSERT_TRUE(ray);
  EXPECT_LT((*ray - Vector3d(5, 0, 2).normalized()).norm(), 1e-12);
}

TEST(Pinhole, ProjectsAsOpenCvDoes) {
  Random random(1);
  int compared = 0;
  for (int round = 0; round < 200; ++round) {
    const PinholeModel lens = RandomPinhole(random);
    const CameraPose pose = RandomPose(random);
    const Camera camera = Camera::Create(kSize, lens, pose).value();
    for (int i = 0; i < 20; ++i) {
      const double z = random.Between(1, 30);
      const Vector2d u = random.Point(-0.7, 0.7);
      const Vector3d world =
          pose.rotation.transpose() * (Vector3d(u.x() * z, u.y() * z, z) - pose.translation_m);
      const auto pixel = camera.ImageFromWorld(world);
      if (!pixel) continue;
      EXPECT_LT((*pixel - ProjectByOpenCv(lens, pose, world)).norm(), 1e-6);
      ++compared;
    }
  }
  EXPECT_GT(compared, 3000);
}

TEST(Pinhole, RefusesPointsThatFoldBack) {
  // r (1 - 0.3 r^2) grows up to r = 1 / sqrt(0.9) = 1.054.
  const Camera camera = AtOrigin(Barrel(-0.3));
  EXPECT_TRUE(camera.ImageFromWorld({1.05, 0, 1}));
  EXPECT_FALSE(camera.ImageFromWorld({1.06, 0, 1}));
  const Vector3d folded(1.8, 0, 1);  // OpenCV shows it in the middle of the picture
  EXPECT_TRUE(camera.InPicture(ProjectByOpenCv(Barrel(-0.3), CameraPose{}, folded)));
  EXPECT_FALSE(camera.ImageFromWorld(folded));
}

TEST(Pinhole, RefusesPointsThatWeakDistortionFoldsFromFarOutside) {
  // r (1 - 1e-4 r^2) is 0 again at r = 100, almost square to the axis.
  const Camera camera = AtOrigin(Barrel(-1e-4));
  EXPECT_FALSE(camera.ImageFromWorld({100, 0, 1}));
  EXPECT_TRUE(camera.ImageFromWorld({10, 0, 1}));
}

TEST(Pinhole, IsOneToOneWithinTheCone) {
  // Along every ray from the axis the distance in the picture grows until the cone ends, and it
  // never comes back, whatever the coefficients.
  Random random(2);
  for (int round = 0; round < 300; ++round) {
    PinholeModel lens = RandomPinhole(random);
    for (double& k : lens.distortion) k *= random.Between(0, 3);
    const Camera camera = AtOrigin(lens);
    const double angle = random.Between(0, 6.3);
    const auto center = camera.ImageFromWorld({0, 0, 1});
    ASSERT_TRUE(center);
    double previous = 0;
    bool ended = false;
    for (int step = 1; step < 200; ++step) {
      const double r = 0.02 * step;
      const auto pixel = camera.ImageFromWorld({r * std::cos(angle), r * std::sin(angle), 1});
      if (!pixel) {
        ended = true;
        continue;
      }
      ASSERT_FALSE(ended);
      const double distance =
          (*pixel - *center).cwiseQuotient(Vector2d(lens.fx_px, lens.fy_px)).norm();
      ASSERT_GT(distance, previous);
      previous = distance;
    }
  }
}

TEST(Pinhole, InvertsItsDistortionUpToTheBorderOfTheCone) {
  Random random(3);
  int inverted = 0;
  for (int round = 0; round < 2000; ++round) {
    const Camera camera = AtOrigin(RandomPinhole(random));
    const Vector2d u = random.Point(-1.2, 1.2);
    const auto pixel = camera.ImageFromWorld({u.x(), u.y(), 1});
    if (!pixel) continue;
    const auto back = camera.WorldFromImage(*pixel, 1);
    ASSERT_TRUE(back) << u.transpose();
    EXPECT_LT((camera.ImageFromWorld(*back).value() - *pixel).norm(), 1e-6);
    EXPECT_LT((back->head<2>() - u).norm(), 1e-5);  // flat near the border
    ++inverted;
  }
  EXPECT_GT(inverted, 1000);
}

/// The root of r (1 + kappa r^2) = r_u that continues the identity, by bisection.
double DistortedRadiusByBisection(double kappa, double r_u) {
  double low = 0;
  double high = kappa < 0 ? std::sqrt(-1 / (3 * kappa)) : r_u;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (middle * (1 + kappa * middle * middle) < r_u ? low : high) = middle;
  }
  return low;
}

TEST(Tsai, SolvesTheCubic) {
  Random random(4);
  int solved = 0;
  for (int round = 0; round < 2000; ++round) {
    TsaiModel lens = RandomTsai(random);
    lens.kappa1_per_mm2 = std::copysign(std::pow(10, random.Between(-6, 2)), random.Between(-1, 1));
    const double angle = random.Between(0, 6.3);
    const double r_u = random.Between(0, 10);
    const Vector2d u = r_u / lens.focal_mm * Vector2d(std::cos(angle), std::sin(angle));
    const auto pixel = AtOrigin(lens).ImageFromWorld({u.x(), u.y(), 1});
    const double fold =
        lens.kappa1_per_mm2 < 0 ? 2.0 / 3 * std::sqrt(-1 / (3 * lens.kappa1_per_mm2)) : 1e9;
    ASSERT_EQ(pixel.has_value(), r_u <= fold);
    if (!pixel) continue;
    const double r_d = DistortedRadiusByBisection(lens.kappa1_per_mm2, r_u);
    const Vector2d expected(lens.cx_px + lens.sx * r_d * std::cos(angle) / lens.dpx_mm,
                            lens.cy_px + r_d * std::sin(angle) / lens.dpy_mm);
    EXPECT_LT((*pixel - expected).norm(), 1e-4) << lens.kappa1_per_mm2 << " " << r_u;
    ++solved;
  }
  EXPECT_GT(solved, 1000);
}

TEST(Tsai, KnowsNoPixelBeyondItsFold) {
  Random random(5);
  TsaiModel lens = RandomTsai(random);
  lens.kappa1_per_mm2 = -0.05;  // r_d ends at 2.58 mm, 503 pixels across
  const Camera camera = AtOrigin(lens);
  EXPECT_TRUE(camera.WorldFromImage({lens.cx_px + 490, lens.cy_px}, 1));
  EXPECT_FALSE(camera.WorldFromImage({lens.cx_px + 600, lens.cy_px}, 1));
}

TEST(Camera, TheTwoModelsAgreeWithoutDistortion) {
  Random random(6);
  for (int round = 0; round < 200; ++round) {
    TsaiModel tsai = RandomTsai(random);
    tsai.kappa1_per_mm2 = 0;
    const PinholeModel pinhole{.fx_px = tsai.sx * tsai.focal_mm / tsai.dpx_mm,
                               .fy_px = tsai.focal_mm / tsai.dpy_mm,
                               .cx_px = tsai.cx_px,
                               .cy_px = tsai.cy_px};
    const CameraPose pose = RandomPose(random);
    const Camera a = Camera::Create(kSize, tsai, pose).value();
    const Camera b = Camera::Create(kSize, pinhole, pose).value();
    const Vector2d ground = random.Point(-40, 40);
    const auto pixel_a = a.ImageFromWorld({ground.x(), ground.y(), 1.2});
    const auto pixel_b = b.ImageFromWorld({ground.x(), ground.y(), 1.2});
    ASSERT_EQ(pixel_a.has_value(), pixel_b.has_value());
    if (pixel_a) {
      EXPECT_LT((*pixel_a - *pixel_b).norm(), 1e-8 * (1 + pixel_a->norm()));
    }
    const Vector2d pixel = random.Point(0, 576);
    const auto ground_a = a.WorldFromImage(pixel);
    const auto ground_b = b.WorldFromImage(pixel);
    ASSERT_EQ(ground_a.has_value(), ground_b.has_value());
    if (ground_a) {
      EXPECT_LT((*ground_a - *ground_b).norm(), 1e-8 * (1 + ground_a->norm()));
    }
  }
}

TEST(Camera, BackProjectionUndoesProjection) {
  Random random(7);
  int seen = 0;
  for (int round = 0; round < 4000; ++round) {
    const LensModel lens =
        round % 2 == 0 ? LensModel(RandomPinhole(random)) : LensModel(RandomTsai(random));
    const Camera camera = Camera::Create(kSize, lens, RandomPose(random)).value();
    const Vector2d pixel = random.Point(0, 576);
    const double z_m = random.Between(0, 1.8);
    const auto world = camera.WorldFromImage(pixel, z_m);
    if (!world) continue;
    EXPECT_EQ(world->z(), z_m);
    const auto again = camera.ImageFromWorld(*world);
    ASSERT_TRUE(again);
    EXPECT_LT((*again - pixel).norm(), 1e-6);
    ++seen;
  }
  EXPECT_GT(seen, 2500);
}

TEST(Camera, KnowsNoGroundAtOrAboveTheHorizon) {
  // 5 m up, level: the horizon is the principal point's row.
  const Camera camera = Camera::Create(kSize, Barrel(0), LookAt({0, 0, 5}, {0, 10, 5})).value();
  EXPECT_FALSE(camera.WorldFromImage({400, 287.5}));
  EXPECT_FALSE(camera.WorldFromImage({400, 100}));
  const auto ground = camera.WorldFromImage({383.5, 387.5});
  ASSERT_TRUE(ground);  // 100 px below at 500 px a unit: 5 m down are 25 m away
  EXPECT_LT((*ground - Vector3d(0, 25, 0)).norm(), 1e-9);
  // Seen from below, a plane overhead is the other way round.
  EXPECT_TRUE(camera.WorldFromImage({400, 100}, 8));
  EXPECT_FALSE(camera.WorldFromImage({400, 500}, 8));
}

TEST(Camera, DoesNotSeeBehindItselfOrNotNumbers) {
  const Camera camera = Camera::Create(kSize, Barrel(0), LookAt({0, 0, 5}, {0, 10, 0})).value();
  EXPECT_TRUE(camera.ImageFromWorld({0, 10, 0}));
  EXPECT_FALSE(camera.ImageFromWorld({0, -10, 0}));
  EXPECT_FALSE(camera.ImageFromWorld(camera.center_m()));
  EXPECT_FALSE(camera.ImageFromWorld({kNan, 10, 0}));
  EXPECT_FALSE(camera.ImageFromWorld({0, std::numeric_limits<double>::infinity(), 0}));
  EXPECT_FALSE(camera.WorldFromImage({kNan, 500}));
  EXPECT_FALSE(camera.WorldFromImage({300, 500}, kNan));
  EXPECT_FALSE(camera.InPicture({kNan, 5}));
}

TEST(Camera, CenterIsWhereThePoseSays) {
  const Camera camera = Camera::Create(kSize, Barrel(0), LookAt({3, -4, 5}, {0, 10, 0})).value();
  EXPECT_LT((camera.center_m() - Vector3d(3, -4, 5)).norm(), 1e-12);
}

TEST(Camera, PictureReachesHalfAPixelAroundItsOuterCentres) {
  const Camera camera = AtOrigin(Barrel(0));
  EXPECT_TRUE(camera.InPicture({-0.5, -0.5}));
  EXPECT_FALSE(camera.InPicture({-0.51, 0}));
  EXPECT_TRUE(camera.InPicture({767.49, 575.49}));
  EXPECT_FALSE(camera.InPicture({767.5, 0}));
  EXPECT_FALSE(camera.InPicture({0, 575.5}));
}

TEST(Camera, TheLensOfAScaledCameraMakesTheSameCamera) {
  Random random(9);
  const LensModel lenses[] = {RandomPinhole(random), TsaiModel{.focal_mm = 5.5,
                                                               .kappa1_per_mm2 = 5e-3,
                                                               .dpx_mm = 5.1e-3,
                                                               .dpy_mm = 4.65e-3,
                                                               .sx = 1.1,
                                                               .cx_px = 380,
                                                               .cy_px = 290}};
  for (const LensModel& lens : lenses) {
    const Camera scaled =
        Camera::Create(kSize, lens, RandomPose(random)).value().Scaled({300, 200}).value();
    const Camera same = Camera::Create({300, 200}, scaled.ScaledLens(), scaled.pose()).value();
    for (int i = 0; i < 50; ++i) {
      const auto world = scaled.WorldFromImage(random.Point(0, 200));
      if (!world) continue;
      EXPECT_LT((*same.ImageFromWorld(*world) - *scaled.ImageFromWorld(*world)).norm(), 1e-9);
    }
  }
}

TEST(Camera, ScalingKeepsThePixelCentreConvention) {
  Random random(8);
  const Camera camera = Camera::Create(kSize, RandomPinhole(random), RandomPose(random)).value();
  const Camera half = camera.Scaled({384, 288}).value();
  EXPECT_EQ(half.size(), (ImageSize{384, 288}));
  for (int i = 0; i < 100; ++i) {
    const Vector2d pixel = random.Point(0, 576);
    // Pixel (0, 0) of the half picture is made of (0..1, 0..1): its centre is (0.5, 0.5) there.
    const auto world = half.WorldFromImage(pixel / 2);
    const auto same = camera.WorldFromImage(pixel + Vector2d(0.5, 0.5));
    ASSERT_EQ(world.has_value(), same.has_value());
    if (!world) continue;
    EXPECT_LT((*world - *same).norm(), 1e-6 * (1 + same->norm()));
    EXPECT_LT((half.ImageFromWorld(*world).value() - pixel / 2).norm(), 1e-6);
  }
  // There and back is the same camera; the two axes scale apart.
  const Camera back = camera.Scaled({100, 500}).value().Scaled(kSize).value();
  const Vector2d ground = camera.WorldFromImage({380, 560}).value().head<2>();
  const Vector3d point(ground.x(), ground.y(), 0);
  EXPECT_LT((back.ImageFromWorld(point).value() - camera.ImageFromWorld(point).value()).norm(),
            1e-9);
  EXPECT_THAT(MessageOf(camera.Scaled({0, 10})), HasSubstr("0 x 10 px"));
}

TEST(Camera, ReplacesARoundedRotationByAnExactOne) {
  CameraPose pose = LookAt({3, -4, 5}, {0, 10, 0});
  const Eigen::Matrix3d exact = pose.rotation;
  pose.rotation = (pose.rotation * 1e4).array().round() / 1e4;
  const Camera camera = Camera::Create(kSize, Barrel(-0.1), pose).value();
  const Eigen::Matrix3d& used = camera.pose().rotation;
  EXPECT_LT((used * used.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_LT((used - exact).norm(), 2e-4);
  const Vector3d ground = camera.WorldFromImage({100, 500}).value();
  EXPECT_LT((camera.ImageFromWorld(ground).value() - Vector2d(100, 500)).norm(), 1e-8);
}

TEST(Camera, RefusesAbsurdCalibrationNamingTheField) {
  const auto message = [](const LensModel& lens, const CameraPose& pose = {},
                          ImageSize size = kSize) {
    return MessageOf(Camera::Create(size, lens, pose));
  };
  const auto pinhole = [](auto change) {
    PinholeModel lens = Barrel(0);
    change(lens);
    return lens;
  };
  const auto tsai = [](auto change) {
    Random random(9);
    TsaiModel lens = RandomTsai(random);
    change(lens);
    return lens;
  };
  EXPECT_EQ(message(Barrel(0)), "");
  EXPECT_THAT(message(pinhole([](auto& m) { m.fx_px = 0; })), HasSubstr("fx is 0 px"));
  EXPECT_THAT(message(pinhole([](auto& m) { m.fy_px = kNan; })), HasSubstr("fy is nan px"));
  EXPECT_THAT(message(pinhole([](auto& m) { m.cx_px = kNan; })), HasSubstr("cx is nan"));
  EXPECT_THAT(message(pinhole([](auto& m) { m.cy_px = -INFINITY; })), HasSubstr("cy is -inf"));
  EXPECT_THAT(message(pinhole([](auto& m) { m.distortion[3] = kNan; })), HasSubstr("p2 is nan"));
  EXPECT_THAT(message(tsai([](auto& m) { m.focal_mm = -5; })), HasSubstr("focal is -5 mm"));
  EXPECT_THAT(message(tsai([](auto& m) { m.dpx_mm = 0; })), HasSubstr("dpx is 0 mm"));
  EXPECT_THAT(message(tsai([](auto& m) { m.dpy_mm = kNan; })), HasSubstr("dpy is nan mm"));
  EXPECT_THAT(message(tsai([](auto& m) { m.sx = 0; })), HasSubstr("sx is 0;"));
  EXPECT_THAT(message(tsai([](auto& m) { m.kappa1_per_mm2 = kNan; })), HasSubstr("kappa1 is nan"));
  EXPECT_THAT(message(Barrel(0), {}, {768, 0}), HasSubstr("768 x 0 px"));
  EXPECT_THAT(message(Barrel(0), {}, {40000, 10}), HasSubstr("40000 x 10 px"));

  const auto pose = [](auto change) {
    CameraPose result = LookAt({3, -4, 5}, {0, 10, 0});
    change(result);
    return result;
  };
  EXPECT_THAT(message(Barrel(0), pose([](auto& p) { p.rotation(1, 2) = kNan; })),
              HasSubstr("rotation is not finite"));
  EXPECT_THAT(message(Barrel(0), pose([](auto& p) { p.rotation *= 1.01; })),
              HasSubstr("rotation is not a proper orthonormal matrix"));
  EXPECT_THAT(message(Barrel(0), pose([](auto& p) { p.rotation *= -1; })),
              HasSubstr("rotation is not a proper orthonormal matrix"));
  EXPECT_THAT(message(Barrel(0), pose([](auto& p) { p.translation_m.x() = kNan; })),
              HasSubstr("translation is (nan"));
  EXPECT_THAT(message(Barrel(0), pose([](auto& p) { p.translation_m.z() = 35469; })),
              HasSubstr("is it in millimetres?"));
}

TEST(Camera, AnyFiniteLensAnswersWithoutNotNumbers) {
  Random random(10);
  for (int round = 0; round < 3000; ++round) {
    PinholeModel lens;
    const auto wild = [&] {
      return std::copysign(std::pow(10, random.Between(-300, 300)), random.Between(-1, 1));
    };
    lens.fx_px = std::abs(wild());
    lens.fy_px = std::abs(wild());
    lens.cx_px = wild();
    for (double& k : lens.distortion) k = wild();
    const TsaiModel tsai{.focal_mm = lens.fx_px,
                         .kappa1_per_mm2 = wild(),
                         .dpx_mm = lens.fy_px,
                         .dpy_mm = std::abs(wild()),
                         .sx = std::abs(wild()),
                         .cx_px = wild(),
                         .cy_px = wild()};
    for (const LensModel& any : {LensModel(lens), LensModel(tsai)}) {
      const Camera camera = AtOrigin(any);
      if (const auto pixel = camera.ImageFromWorld({0.1, 0.2, 1})) {
        EXPECT_TRUE(pixel->allFinite());
      }
      if (const auto world = camera.WorldFromImage({100, 200}, 1)) {
        EXPECT_TRUE(world->allFinite());
      }
    }
  }
}

}  // namespace
}  // namespace vantage
