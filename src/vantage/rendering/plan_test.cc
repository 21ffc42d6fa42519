// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "vantage/rendering/palette.h"
#include "vantage/rendering/test_scene.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using testing::CornerScene;

constexpr ImageSize kHd = {640, 360};

Person At(int id, const Vector2d& position_m) {
  return {TrackId{id}, position_m, false, {{position_m, 0}}};
}

cv::Vec3b Pixel(const cv::Mat& image, const cv::Point2d& p) {
  return image.at<cv::Vec3b>(static_cast<int>(std::lround(p.y)),
                             static_cast<int>(std::lround(p.x)));
}

double Difference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

TEST(Plan, HasXToTheRightAndYUpInTrueProportion) {
  for (const cv::Size size : {cv::Size(500, 300), {300, 600}, {64, 64}}) {
    const Plan plan(CornerScene({kHd}), size);
    const cv::Point2d origin = plan.PixelFromGround({0, 0});
    const cv::Point2d right = plan.PixelFromGround({1, 0});
    const cv::Point2d up = plan.PixelFromGround({0, 1});
    EXPECT_GT(right.x, origin.x);
    EXPECT_EQ(right.y, origin.y);
    EXPECT_LT(up.y, origin.y);
    EXPECT_EQ(up.x, origin.x);
    EXPECT_DOUBLE_EQ(right.x - origin.x, origin.y - up.y);
    for (const Vector2d& corner : {Vector2d(-4, -3), {4, -3}, {4, 3}, {-4, 3}}) {
      const cv::Point2d px = plan.PixelFromGround(corner);
      EXPECT_TRUE(cv::Rect2d(0, 0, size.width, size.height).contains(px));
      EXPECT_LT((plan.GroundFromPixel(px) - corner).norm(), 1e-12);
    }
    EXPECT_EQ(plan.Draw({}).size(), size);
  }
}

TEST(Plan, PeopleAreWhereTheyStandInTheirColors) {
  const Plan plan(CornerScene({kHd, kHd}), {500, 400});
  const cv::Mat empty = plan.Draw({});
  const cv::Mat drawn = plan.Draw({At(3, {1, 2}), At(8, {-2, -1})});
  for (const auto& [id, position] : {std::pair(3, Vector2d(1, 2)), {8, Vector2d(-2, -1)}}) {
    const cv::Scalar color = ColorOf(TrackId{id});
    EXPECT_EQ(Pixel(drawn, plan.PixelFromGround(position)),
              cv::Vec3b(cv::saturate_cast<uchar>(color[0]), cv::saturate_cast<uchar>(color[1]),
                        cv::saturate_cast<uchar>(color[2])));
  }
  const cv::Point2d elsewhere = plan.PixelFromGround({-2, 2});
  EXPECT_EQ(Pixel(drawn, elsewhere), Pixel(empty, elsewhere));
  EXPECT_EQ(Difference(plan.Draw({}), empty), 0);  // nothing stays
}

TEST(Plan, TrailsLeadToPeople) {
  const Plan plan(CornerScene({kHd}), {500, 400});
  Person person = At(3, {2, 0});
  person.trail = {{{-2, 0}, 1}, {{0, 0}, 0.5}, {{2, 0}, 0}};
  const cv::Mat drawn = plan.Draw({person});
  person.trail.clear();
  const cv::Mat without = plan.Draw({person});
  const cv::Point2d on_trail = plan.PixelFromGround({1.03, 0});
  EXPECT_GT(cv::norm(Pixel(drawn, on_trail), Pixel(without, on_trail)), 50);
}

TEST(Plan, GroundThatIsSeenIsLighter) {
  Scene scene = CornerScene({});
  // Looks from the west along the x axis: half of the plan behind it is unseen.
  scene.cameras.push_back(
      {"west",
       {},
       Camera::Create(kHd, PinholeModel{.fx_px = 600, .fy_px = 600, .cx_px = 320, .cy_px = 180},
                      testing::LookAt({0, 0, 3}, {4, 0, 0}))
           .value()});
  const cv::Mat drawn = Plan(scene, {600, 460}).Draw({});
  const Plan plan(scene, {600, 460});
  const auto brightness = [&](const Vector2d& at_m) {
    const cv::Vec3b pixel = Pixel(drawn, plan.PixelFromGround(at_m));
    return pixel[0] + pixel[1] + pixel[2];
  };
  EXPECT_GT(brightness({3.55, 0.15}), brightness({-3.55, 0.15}) + 60);
}

TEST(Plan, AnyPeopleAndCamerasAreFine) {
  Scene scene = CornerScene({kHd, kHd});
  scene.cameras.push_back(
      {"far",
       {},
       Camera::Create(kHd, PinholeModel{.fx_px = 600, .fy_px = 600, .cx_px = 320, .cy_px = 180},
                      testing::LookAt({5000, 10, 30}, {0, 0, 0}))
           .value()});
  scene.cameras.push_back(
      {"down",
       {},
       Camera::Create(kHd, PinholeModel{.fx_px = 600, .fy_px = 600, .cx_px = 320, .cy_px = 180},
                      testing::LookAt({0, 0, 9}, {0, 0, 0}))
           .value()});
  scene.doors.push_back(Polygon::Rectangle({-4, -1}, {-3.5, 1}).value());
  scene.obstacles.push_back(Polygon::Rectangle({1, 1}, {2, 2}).value());
  const Plan plan(scene, {300, 500});
  const cv::Mat empty = plan.Draw({});
  const cv::Mat drawn = plan.Draw({At(1, {1e9, 0}), At(2, {-1e300, 1e300}), At(3, {0, -400})});
  EXPECT_EQ(Difference(empty, drawn), 0);
}

}  // namespace
}  // namespace vantage
