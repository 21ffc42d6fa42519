// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/person_size.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "vantage/base/test_support.h"
#include "vantage/geometry/test_cameras.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using ::testing::HasSubstr;
using testing::LookAt;
using testing::MessageOf;
using testing::Random;
using Shape = PersonOptions::Shape;

constexpr ImageSize kSize = {640, 480};

std::vector<Camera> Corners(int count) {
  const PinholeModel lens{.fx_px = 500, .fy_px = 500, .cx_px = 319.5, .cy_px = 239.5};
  std::vector<Camera> cameras;
  for (int i = 0; i < count; ++i) {
    const double angle = std::numbers::pi / 4 + i * std::numbers::pi / 2;
    cameras.push_back(
        Camera::Create(kSize, lens,
                       LookAt({13 * std::cos(angle), 13 * std::sin(angle), 5}, {0, 0, 0.5}))
            .value());
  }
  return cameras;
}

Polygon Area() { return Polygon::Rectangle({-5, -5}, {5, 5}).value(); }

/// Shares of figures that are wrong.
struct Damage {
  double merged = 0;     ///< somebody else stands half a metre away
  double fragments = 0;  ///< in one of the views, the upper or lower part is missing
  int blobs = 0;         ///< false foreground in each picture
};

cv::Rect PixelsOf(const PixelBox& box) {
  const cv::Point first(static_cast<int>(std::ceil(box.min_x)),
                        static_cast<int>(std::ceil(box.min_y)));
  const cv::Point last(static_cast<int>(std::floor(box.max_x)),
                       static_cast<int>(std::floor(box.max_y)));
  return cv::Rect(first, last + cv::Point(1, 1));
}

/// Three people per moment, far enough apart to be seen one by one in most views.
PersonSizeMeter Measured(const std::vector<Camera>& cameras, const PersonOptions& person,
                         int moments, const Damage& damage) {
  PersonSizeMeter meter(cameras, Area(), person.shape);
  Random random(5);
  for (int moment = 0; moment < moments; ++moment) {
    std::vector<cv::Mat> masks;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      masks.push_back(cv::Mat::zeros(kSize.height, kSize.width, CV_8UC1));
    }
    const auto draw = [&](const Vector2d& foot_m) {
      for (std::size_t i = 0; i < cameras.size(); ++i) {
        cv::Rect pixels = PixelsOf(PersonBox(cameras[i], foot_m, person).value());
        if (random.Between(0, 1) < damage.fragments) {
          const int cut = static_cast<int>(pixels.height * random.Between(0.2, 0.6));
          pixels.height -= cut;
          if (random.Between(0, 1) < 0.5) pixels.y += cut;
        }
        cv::rectangle(masks[i], pixels, cv::Scalar(255), cv::FILLED);
      }
    };
    for (const Vector2d& around : {Vector2d(-3, -2), Vector2d(3, -1), Vector2d(0, 3)}) {
      const Vector2d foot_m = around + random.Point(-1, 1);
      draw(foot_m);
      if (random.Between(0, 1) >= damage.merged) continue;
      const double angle = random.Between(0, 6.28);
      draw(foot_m + 0.5 * Vector2d(std::cos(angle), std::sin(angle)));
    }
    for (cv::Mat& mask : masks) {
      for (int i = 0; i < damage.blobs; ++i) {
        cv::ellipse(
            mask,
            {static_cast<int>(random.Between(0, 640)), static_cast<int>(random.Between(0, 480))},
            {static_cast<int>(random.Between(2, 20)), static_cast<int>(random.Between(2, 20))}, 0,
            0, 360, cv::Scalar(255), cv::FILLED);
      }
    }
    EXPECT_TRUE(meter.Add(masks));
  }
  return meter;
}

void ExpectSize(const PersonSizeReport& report, const PersonOptions& person, double tolerance) {
  ASSERT_TRUE(report.width && report.height);
  EXPECT_NEAR(report.width->value_m, person.width_m, tolerance * person.width_m);
  EXPECT_NEAR(report.height->value_m, person.height_m, tolerance * person.height_m);
}

TEST(PersonSize, IsFoundFromCleanSilhouettes) {
  for (const int count : {1, 4}) {
    for (const Shape shape : {Shape::kFlat, Shape::kCylinder, Shape::kBox}) {
      for (const auto& [width_m, height_m] :
           {std::pair(0.45, 1.8), std::pair(0.7, 1.7), std::pair(0.4, 1.2)}) {
        SCOPED_TRACE(fmt::format("{} cameras, {} x {} m", count, width_m, height_m));
        const PersonOptions person{.width_m = width_m, .height_m = height_m, .shape = shape};
        const PersonSizeReport report = Measured(Corners(count), person, 30, {}).Report();
        ExpectSize(report, person, 0.03);
        EXPECT_EQ(report.confirmed, count > 1);
        EXPECT_EQ(report.frames, 30);
        EXPECT_LT(report.height->spread_m, 0.05);
      }
    }
  }
}

TEST(PersonSize, IsFoundFromDamagedSilhouettes) {
  const PersonOptions person{.width_m = 0.5, .height_m = 1.75, .shape = Shape::kCylinder};
  for (const int count : {1, 4}) {
    for (const Damage& damage :
         {Damage{.merged = 0.4}, Damage{.fragments = 0.3}, Damage{.blobs = 12},
          Damage{.merged = 0.2, .fragments = 0.15, .blobs = 5}}) {
      SCOPED_TRACE(fmt::format("{} cameras, {} merged, {} fragments, {} blobs", count,
                               damage.merged, damage.fragments, damage.blobs));
      ExpectSize(Measured(Corners(count), person, 60, damage).Report(), person, 0.06);
    }
  }
}

TEST(PersonSize, CountsOnlyWhatOtherCamerasConfirm) {
  // The blobs of four cameras rarely agree on a place and a height.
  const PersonOptions person{.width_m = 0.5, .height_m = 1.75, .shape = Shape::kCylinder};
  const PersonSizeReport report = Measured(Corners(4), person, 40, {.blobs = 10}).Report();
  std::int64_t figures = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LE(report.counted[i], report.figures[i]);
    EXPECT_GT(report.counted[i], 40);
    figures += report.figures[i];
  }
  EXPECT_LT(report.TotalCounted(), figures);
}

TEST(PersonSize, IsUnknownWhenTooFewAreSeen) {
  const PersonOptions person{.width_m = 0.5, .height_m = 1.75, .shape = Shape::kFlat};
  const PersonSizeReport few = Measured(Corners(1), person, 5, {}).Report();
  EXPECT_GT(few.TotalCounted(), 0);
  EXPECT_FALSE(few.width || few.height);
  const PersonSizeReport none = PersonSizeMeter(Corners(2), Area(), Shape::kFlat).Report();
  EXPECT_EQ(none.TotalCounted(), 0);
  EXPECT_THAT(none.figures, ::testing::ElementsAre(0, 0));
  EXPECT_FALSE(none.width || none.height);
}

TEST(PersonSize, LeavesOutWhatIsNoPerson) {
  PersonSizeMeter meter(Corners(1), Area(), Shape::kFlat);
  // A car, a cat, somebody outside the area, somebody whom the picture's edge cuts, and noise.
  const PersonOptions car{.width_m = 3, .height_m = 1.5};
  const PersonOptions cat{.width_m = 0.3, .height_m = 0.4};
  const Camera camera = Corners(1)[0];
  cv::Mat mask = cv::Mat::zeros(kSize.height, kSize.width, CV_8UC1);
  const auto draw = [&](const PersonOptions& what, const Vector2d& at_m) {
    cv::rectangle(mask, PixelsOf(PersonBox(camera, at_m, what).value()), cv::Scalar(255),
                  cv::FILLED);
  };
  draw(car, {0, 0});
  draw(cat, {-4, 0});
  draw({}, {-6, -6});
  mask(cv::Rect(0, 200, 40, 120)) = 255;
  mask(cv::Rect(500, 450, 2, 2)) = 255;
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(meter.Add({&mask, 1}));
  EXPECT_EQ(meter.Report().figures[0], 0);
}

TEST(PersonSize, PassesOverCamerasWithoutPicture) {
  const PersonOptions person{.width_m = 0.5, .height_m = 1.75, .shape = Shape::kFlat};
  PersonSizeMeter meter(Corners(2), Area(), Shape::kFlat);
  std::vector<cv::Mat> masks(2);
  masks[1] = cv::Mat::zeros(kSize.height, kSize.width, CV_8UC1);
  masks[1](PixelsOf(PersonBox(Corners(2)[1], {0, 0}, person).value())) = 255;  // 19 px wide
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(meter.Add(masks));
  const PersonSizeReport report = meter.Report();
  EXPECT_FALSE(report.confirmed);
  EXPECT_THAT(report.counted, ::testing::ElementsAre(0, 50));
  ExpectSize(report, person, 0.06);
}

TEST(PersonSize, OfASilhouetteIsWhatItFills) {
  // An ellipse: the rectangle that loses as little of it as it adds is narrower and lower.
  const Camera camera = Corners(1)[0];
  cv::Mat mask = cv::Mat::zeros(kSize.height, kSize.width, CV_8UC1);
  const cv::Rect pixels = PixelsOf(
      PersonBox(camera, {2, 2}, {.width_m = 0.7, .height_m = 2, .shape = Shape::kFlat}).value());
  cv::ellipse(mask, (pixels.tl() + pixels.br()) / 2, pixels.size() / 2, 0, 0, 360, cv::Scalar(255),
              cv::FILLED);
  PersonSizeMeter meter({camera}, Area(), Shape::kFlat);
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(meter.Add({&mask, 1}));
  const PersonSizeReport report = meter.Report();
  ASSERT_TRUE(report.width && report.height);
  EXPECT_LT(report.width->value_m, 0.7);
  EXPECT_LT(report.height->value_m, 2);
  const double share = report.width->value_m * report.height->value_m / (0.7 * 2);
  EXPECT_GT(share, 0.7);
  EXPECT_LT(share, 0.92);
}

TEST(PersonSize, IsWideEnoughForMostPeople) {
  // People of two widths: the rectangle covers the wider ones, too.
  PersonSizeMeter meter(Corners(1), Area(), Shape::kFlat);
  const Camera camera = Corners(1)[0];
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const PersonOptions person{.width_m = random.Between(0.5, 0.7), .height_m = 1.8};
    cv::Mat mask = cv::Mat::zeros(kSize.height, kSize.width, CV_8UC1);
    mask(PixelsOf(PersonBox(camera, random.Point(-2, 4), person).value())) = 255;
    EXPECT_TRUE(meter.Add({&mask, 1}));
  }
  const PersonSizeReport report = meter.Report();
  ASSERT_TRUE(report.width);
  EXPECT_NEAR(report.width->value_m, 0.6, 0.06);
  EXPECT_NEAR(report.RectangleWidth_m(0.1), 0.7, 0.07);
  EXPECT_NEAR(report.RectangleWidth_m(2), report.width->value_m + 1.0, 1e-12);
}

TEST(PersonSize, RefusesMasksOfAnotherKind) {
  PersonSizeMeter meter(Corners(1), Area(), Shape::kFlat);
  const std::vector<cv::Mat> two(2);
  EXPECT_THAT(MessageOf(meter.Add(two)), HasSubstr("2 masks were given for 1 cameras"));
  for (const cv::Mat& mask :
       {cv::Mat(480, 641, CV_8UC1, cv::Scalar(0)), cv::Mat(480, 640, CV_8UC3, cv::Scalar(0))}) {
    EXPECT_THAT(MessageOf(meter.Add({&mask, 1})), HasSubstr("640 x 480 px"));
  }
}

}  // namespace
}  // namespace vantage
