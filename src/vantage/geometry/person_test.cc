// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/geometry/person.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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

constexpr ImageSize kSize = {768, 576};
constexpr PersonOptions kBox = {
    .width_m = 0.6, .height_m = 1.8, .shape = PersonOptions::Shape::kBox};
constexpr PersonOptions kCylinder = {
    .width_m = 0.6, .height_m = 1.8, .shape = PersonOptions::Shape::kCylinder};
constexpr PersonOptions kFlat = {
    .width_m = 0.6, .height_m = 1.8, .shape = PersonOptions::Shape::kFlat};

bool Inside(const PixelBox& box, const Vector2d& p, double slack_px) {
  return p.x() >= box.min_x - slack_px && p.x() <= box.max_x + slack_px &&
         p.y() >= box.min_y - slack_px && p.y() <= box.max_y + slack_px;
}

/// `count` random cameras that see a person at a random place, with distortion or without.
template <class Check>
void ForRandomViews(int count, bool distorted, const PersonOptions& person, Check check) {
  Random random(1);
  for (int seen = 0; seen < count;) {
    PinholeModel lens = RandomPinhole(random);
    if (!distorted) lens.distortion = {};
    const Camera camera = Camera::Create(kSize, lens, RandomPose(random)).value();
    const Vector2d foot = random.Point(-30, 30);
    const auto pixel = camera.ImageFromWorld({foot.x(), foot.y(), person.height_m / 2});
    if (!pixel || !camera.InPicture(*pixel)) continue;
    const auto box = PersonBox(camera, foot, person);
    if (!box) continue;  // a part is behind the camera: another test
    ++seen;
    check(camera, foot, *box);
  }
}

TEST(PersonBox, TightlyHoldsEveryPointOfTheUprightBox) {
  for (const bool distorted : {false, true}) {
    // Distortion bends the edges out of the rectangle of the corners, by a fraction of their
    // length.
    const double slack = distorted ? 0.02 : 1e-9;
    ForRandomViews(
        100, distorted, kBox, [&](const Camera& camera, const Vector2d& foot, const PixelBox& box) {
          PixelBox sampled = {1e9, 1e9, -1e9, -1e9};
          const double size = std::max(box.width(), box.height());
          for (int ix = -5; ix <= 5; ++ix) {
            for (int iy = -5; iy <= 5; ++iy) {
              for (int iz = 0; iz <= 10; ++iz) {
                const Vector3d point(foot.x() + 0.06 * ix, foot.y() + 0.06 * iy, 0.18 * iz);
                const auto pixel = camera.ImageFromWorld(point);
                ASSERT_TRUE(pixel);
                EXPECT_TRUE(Inside(box, *pixel, slack * size + 1e-9));
                sampled.min_x = std::min(sampled.min_x, pixel->x());
                sampled.min_y = std::min(sampled.min_y, pixel->y());
                sampled.max_x = std::max(sampled.max_x, pixel->x());
                sampled.max_y = std::max(sampled.max_y, pixel->y());
              }
            }
          }
          EXPECT_NEAR(sampled.min_x, box.min_x, slack * size + 1e-9);
          EXPECT_NEAR(sampled.min_y, box.min_y, slack * size + 1e-9);
          EXPECT_NEAR(sampled.max_x, box.max_x, slack * size + 1e-9);
          EXPECT_NEAR(sampled.max_y, box.max_y, slack * size + 1e-9);
        });
  }
}

TEST(PersonBox, TightlyHoldsEveryPointOfTheUprightCylinder) {
  for (const bool distorted : {false, true}) {
    ForRandomViews(100, distorted, kCylinder,
                   [&](const Camera& camera, const Vector2d& foot, const PixelBox& box) {
                     PixelBox sampled = {1e9, 1e9, -1e9, -1e9};
                     for (int i = 0; i < 2000; ++i) {
                       const double angle = 2 * std::numbers::pi * i / 2000;
                       for (int iz = 0; iz <= 10; ++iz) {
                         const Vector3d point(foot.x() + 0.3 * std::cos(angle),
                                              foot.y() + 0.3 * std::sin(angle), 0.18 * iz);
                         const auto pixel = camera.ImageFromWorld(point);
                         ASSERT_TRUE(pixel);
                         sampled.min_x = std::min(sampled.min_x, pixel->x());
                         sampled.min_y = std::min(sampled.min_y, pixel->y());
                         sampled.max_x = std::max(sampled.max_x, pixel->x());
                         sampled.max_y = std::max(sampled.max_y, pixel->y());
                       }
                     }
                     // The parabola between points of the circle, and distortion, which bends the
                     // sides out of the rectangle.
                     const double slack = distorted ? 0.02 : 2e-3;
                     EXPECT_NEAR(sampled.min_x, box.min_x, slack * box.width());
                     EXPECT_NEAR(sampled.max_x, box.max_x, slack * box.width());
                     EXPECT_NEAR(sampled.min_y, box.min_y, slack * box.height());
                     EXPECT_NEAR(sampled.max_y, box.max_y, slack * box.height());
                   });
  }
}

TEST(PersonBox, CylinderLooksTheSameFromEverySide) {
  const PinholeModel lens{.fx_px = 500, .fy_px = 500, .cx_px = 383.5, .cy_px = 287.5};
  const auto seen_from = [&](double angle) {
    const Vector3d center(10 * std::cos(angle), 10 * std::sin(angle), 4);
    const Camera camera = Camera::Create(kSize, lens, LookAt(center, {0, 0, 1})).value();
    return PersonBox(camera, {0, 0}, kCylinder).value();
  };
  const PixelBox first = seen_from(0);
  for (const double angle : {0.3, 1.0, 2.5, 4.4}) {
    const PixelBox other = seen_from(angle);
    EXPECT_NEAR(other.width(), first.width(), 1e-3 * first.width());
    EXPECT_NEAR(other.min_y, first.min_y, 1e-3 * first.height());
    EXPECT_NEAR(other.max_y, first.max_y, 1e-3 * first.height());
  }
}

TEST(PersonBox, HoldsFootAndHead) {
  for (const PersonOptions& person : {kBox, kCylinder, kFlat}) {
    ForRandomViews(
        300, false, person, [&](const Camera& camera, const Vector2d& foot, const PixelBox& box) {
          for (const double z_m : {0.0, 0.5 * person.height_m, person.height_m}) {
            EXPECT_TRUE(
                Inside(box, camera.ImageFromWorld({foot.x(), foot.y(), z_m}).value(), 1e-9));
          }
          EXPECT_GT(box.width(), 0);
          EXPECT_GT(box.height(), 0);
        });
  }
}

TEST(PersonBox, FlatFigureFacesTheCamera) {
  // Level camera 1 m up, the figure 10 m ahead: 500 px / 10 m are 50 pixels a metre.
  const PinholeModel lens{.fx_px = 500, .fy_px = 500, .cx_px = 383.5, .cy_px = 287.5};
  for (const double angle : {0.0, 0.7, 2.0, 4.0}) {
    const Vector2d ahead(std::cos(angle), std::sin(angle));
    const Camera camera =
        Camera::Create(kSize, lens, LookAt({0, 0, 1}, {ahead.x(), ahead.y(), 1})).value();
    const auto box = PersonBox(camera, 10 * ahead, kFlat);
    ASSERT_TRUE(box);
    EXPECT_NEAR(box->width(), 50 * 0.6, 1e-9);
    EXPECT_NEAR(box->min_y, 287.5 - 50 * 0.8, 1e-9);
    EXPECT_NEAR(box->max_y, 287.5 + 50 * 1.0, 1e-9);
    EXPECT_NEAR(box->min_x + box->max_x, 2 * 383.5, 1e-9);
    // The square base is at least as wide and nearer at its front.
    const auto solid = PersonBox(camera, 10 * ahead, kBox);
    ASSERT_TRUE(solid);
    EXPECT_GT(solid->width(), box->width());
    EXPECT_GT(solid->max_y, box->max_y);
  }
}

TEST(PersonBox, IsNoneWhenAnyPartCannotBeProjected) {
  const PinholeModel lens{.fx_px = 500, .fy_px = 500, .cx_px = 383.5, .cy_px = 287.5};
  const Camera level = Camera::Create(kSize, lens, LookAt({0, 0, 1}, {0, 1, 1})).value();
  for (const PersonOptions& person : {kBox, kCylinder, kFlat}) {
    EXPECT_TRUE(PersonBox(level, {0, 5}, person));
    EXPECT_FALSE(PersonBox(level, {0, -5}, person));
    EXPECT_FALSE(PersonBox(level, {std::nan(""), 5}, person));
  }
  EXPECT_FALSE(PersonBox(level, {0, 0.2}, kBox));  // its near side is behind the camera

  PinholeModel barrel = lens;
  barrel.distortion = {-0.3};  // cone of 46 degrees
  const Camera folding = Camera::Create(kSize, barrel, LookAt({0, 0, 1}, {0, 1, 1})).value();
  EXPECT_TRUE(PersonBox(folding, {4, 5}, kBox));
  EXPECT_FALSE(PersonBox(folding, {5.2, 5}, kBox));
}

TEST(PersonBox, IsNoneForAFlatFigureStraightBelow) {
  const PinholeModel lens{.fx_px = 500, .fy_px = 500, .cx_px = 383.5, .cy_px = 287.5};
  const Camera above = Camera::Create(kSize, lens, LookAt({2, 3, 8}, {2, 3, 0})).value();
  EXPECT_FALSE(PersonBox(above, {2, 3}, kFlat));
  EXPECT_TRUE(PersonBox(above, {2, 3}, kBox));
  EXPECT_TRUE(PersonBox(above, {2, 3.5}, kFlat));
}

TEST(PersonFromBox, InvertsPersonBox) {
  for (const bool distorted : {false, true}) {
    for (PersonOptions person : {kBox, kCylinder, kFlat}) {
      int inverted = 0, seen = 0;
      ForRandomViews(200, distorted, person,
                     [&](const Camera& camera, const Vector2d& foot, const PixelBox& box) {
                       // Steeper than this the footprint hides the height.
                       const double away = (foot - camera.center_m().head<2>()).norm();
                       if (away < camera.center_m().z() || away > 40) return;
                       ++seen;
                       const auto found = PersonFromBox(camera, box, person.shape);
                       if (!found) return;
                       ++inverted;
                       PersonOptions again = person;
                       again.width_m = found->width_m;
                       again.height_m = found->height_m;
                       const PixelBox redrawn = PersonBox(camera, found->foot_m, again).value();
                       EXPECT_NEAR(redrawn.min_x, box.min_x, 1e-3 * box.width());
                       EXPECT_NEAR(redrawn.max_y, box.max_y, 1e-3 * box.height());
                       EXPECT_NEAR(found->width_m, 0.6, 0.02);
                       EXPECT_NEAR(found->height_m, 1.8, 0.04);
                       EXPECT_NEAR((found->foot_m - foot).norm(), 0, 0.04 + 0.004 * away);
                     });
      EXPECT_GT(seen, 50);
      EXPECT_GE(inverted, 0.98 * seen);
    }
  }
}

TEST(PersonFromBox, IsNoneWhereNobodyCanStand) {
  const PinholeModel lens{.fx_px = 500, .fy_px = 500, .cx_px = 383.5, .cy_px = 287.5};
  const Camera level = Camera::Create(kSize, lens, LookAt({0, 0, 1}, {0, 1, 1})).value();
  const Camera above = Camera::Create(kSize, lens, LookAt({0, 0, 8}, {0, 1e-3, 0})).value();
  using Shape = PersonOptions::Shape;
  for (const Shape shape : {Shape::kBox, Shape::kCylinder, Shape::kFlat}) {
    EXPECT_FALSE(PersonFromBox(level, {300, 100, 320, 200}, shape));  // ends above the horizon
    EXPECT_FALSE(PersonFromBox(level, {300, 300, 300, 400}, shape));  // empty
    EXPECT_FALSE(PersonFromBox(level, {std::nan(""), 300, 320, 400}, shape));
    EXPECT_FALSE(PersonFromBox(level, {300, 300, 320, INFINITY}, shape));
  }
  // A square of the footprint's own size seen from above: no height is left.
  EXPECT_FALSE(PersonFromBox(above, {300, 300, 340, 320}, Shape::kCylinder));
}

TEST(PersonOptions, AreChecked) {
  EXPECT_TRUE(ValidateOptions(PersonOptions{}, "person"));
  EXPECT_THAT(MessageOf(ValidateOptions(PersonOptions{.width_m = 0}, "person")),
              HasSubstr("person.width"));
  EXPECT_THAT(MessageOf(ValidateOptions(PersonOptions{.height_m = 50}, "person")),
              HasSubstr("person.height"));
}

TEST(PersonSpec, LengthsMayBeLeftOpen) {
  EXPECT_TRUE(ValidateOptions(PersonSpec{}, "person"));
  EXPECT_FALSE(PersonSpec{}.IsGiven());
  EXPECT_FALSE(PersonSpec{.width_m = 0.6}.IsGiven());
  EXPECT_TRUE((PersonSpec{.width_m = 0.6, .height_m = 1.8}.IsGiven()));
  const PersonOptions some = PersonSpec{.width_m = 0.6, .shape = kBox.shape}.Or(0.4, 1.5);
  EXPECT_EQ(some.width_m, 0.6);
  EXPECT_EQ(some.height_m, 1.5);
  EXPECT_EQ(some.shape, kBox.shape);
  EXPECT_EQ(PersonSpec{}.OrDefault().height_m, PersonOptions().height_m);
  for (const double wrong : {std::nan(""), HUGE_VAL, -1.0, 0.0, 50.0}) {
    EXPECT_THAT(MessageOf(ValidateOptions(PersonSpec{.width_m = wrong}, "person")),
                HasSubstr("person.width"));
    EXPECT_THAT(MessageOf(ValidateOptions(PersonSpec{.height_m = wrong}, "person")),
                HasSubstr("or \"auto\""));
  }
}

}  // namespace
}  // namespace vantage
