// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/overlay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "vantage/geometry/test_cameras.h"
#include "vantage/rendering/palette.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using testing::LookAt;

constexpr ImageSize kSize = {640, 480};
const cv::Scalar kGrey = {100, 100, 100};

/// 6 m up, looking at the origin from 12 m south of it.
Camera TestCamera() {
  return Camera::Create(kSize, PinholeModel{.fx_px = 600, .fy_px = 600, .cx_px = 320, .cy_px = 240},
                        LookAt({0, -12, 6}, {0, 0, 0.5}))
      .value();
}

cv::Mat Picture() { return cv::Mat(kSize.height, kSize.width, CV_8UC3, kGrey); }

Person At(int id, const Vector2d& position_m) {
  return {TrackId{id}, position_m, false, {{position_m, 0}}};
}

/// How far the pixel is from a colour, largest channel.
double Distance(const cv::Mat& picture, double x, double y, const cv::Scalar& color) {
  const auto& pixel =
      picture.at<cv::Vec3b>(static_cast<int>(std::lround(y)), static_cast<int>(std::lround(x)));
  double distance = 0;
  for (int c = 0; c < 3; ++c) distance = std::max(distance, std::abs(pixel[c] - color[c]));
  return distance;
}

bool Untouched(const cv::Mat& picture) { return cv::norm(picture, Picture(), cv::NORM_INF) == 0; }

TEST(DrawPeople, BoxIsWhereProjectionSays) {
  const Camera camera = TestCamera();
  for (const Vector2d& position : {Vector2d(0, 0), {-2, 1}, {2.5, -1}, {1, 6}}) {
    cv::Mat picture = Picture();
    DrawPeople(picture, camera, {At(5, position)}, {});
    const PixelBox box = PersonBox(camera, position, {}).value();
    const cv::Scalar color = ColorOf(TrackId{5});
    const double middle_y = (box.min_y + box.max_y) / 2;
    EXPECT_LT(Distance(picture, box.min_x, middle_y, color), 60);
    EXPECT_LT(Distance(picture, box.max_x, middle_y, color), 60);
    EXPECT_LT(Distance(picture, (box.min_x + box.max_x) / 2, box.max_y, color), 60);
    // The person inside stays to be seen, and so does what lies around.
    EXPECT_EQ(Distance(picture, (box.min_x + box.max_x) / 2, middle_y, kGrey), 0);
    EXPECT_EQ(Distance(picture, box.min_x - 8, middle_y, kGrey), 0);
    EXPECT_EQ(Distance(picture, box.max_x + 8, middle_y, kGrey), 0);
    // The tag stands on the box.
    EXPECT_LT(Distance(picture, (box.min_x + box.max_x) / 2 - 5, box.min_y - 3, color), 10);
  }
}

TEST(DrawPeople, TrailRunsAlongTheGroundAndFades) {
  const Camera camera = TestCamera();
  Person person = At(3, {3, 0});
  person.trail.clear();
  for (int i = 0; i <= 60; ++i) person.trail.push_back({{-3 + 0.1 * i, 0}, 1 - i / 60.0});
  cv::Mat picture = Picture();
  DrawPeople(picture, camera, {person}, {});
  const cv::Scalar color = ColorOf(TrackId{3});
  const auto distance_at = [&](double x_m) {
    const Vector2d pixel = camera.ImageFromWorld({x_m, 0, 0}).value();
    return Distance(picture, pixel.x(), pixel.y(), color);
  };
  EXPECT_LT(distance_at(2), 60);
  EXPECT_LT(distance_at(2), distance_at(0));
  EXPECT_LT(distance_at(0), distance_at(-2));
  const Vector2d beside = camera.ImageFromWorld({0, 0.5, 0}).value();
  EXPECT_EQ(Distance(picture, beside.x(), beside.y(), kGrey), 0);
}

TEST(DrawPeople, TheNearerOneIsInFront) {
  const Camera camera = TestCamera();
  cv::Mat picture = Picture();
  DrawPeople(picture, camera, {At(1, {0, -1}), At(2, {0, 0.2})}, {});
  const PixelBox near = PersonBox(camera, {0, -1}, {}).value();
  const PixelBox far = PersonBox(camera, {0, 0.2}, {}).value();
  ASSERT_GT(near.max_y, far.max_y);
  // The near one's side crosses the far one's lower edge.
  EXPECT_LT(Distance(picture, near.min_x, far.max_y, ColorOf(TrackId{1})), 60);
}

TEST(DrawPeople, TagsDoNotHideEachOther) {
  const Camera camera = TestCamera();
  cv::Mat picture = Picture();
  const std::vector<Person> crowd = {At(1, {0, 0}), At(2, {0.02, 0}), At(3, {0.04, 0}),
                                     At(4, {0.06, 0})};
  DrawPeople(picture, camera, crowd, {});
  for (int i = 0; i < 4; ++i) {
    const cv::Scalar color = ColorOf(TrackId{i + 1});
    cv::Mat same;
    cv::inRange(picture, color, color, same);
    EXPECT_GT(cv::countNonZero(same), 120) << i;  // most of a tag of 16 x 18 pixels
  }
}

TEST(DrawPeople, InferredPositionsArePaler) {
  const Camera camera = TestCamera();
  Person person = At(5, {0, 0});
  person.inferred = true;
  cv::Mat picture = Picture();
  DrawPeople(picture, camera, {person}, {});
  const PixelBox box = PersonBox(camera, {0, 0}, {}).value();
  const double distance =
      Distance(picture, box.min_x, (box.min_y + box.max_y) / 2, ColorOf(TrackId{5}));
  EXPECT_GT(distance, 30);
  EXPECT_FALSE(Untouched(picture));
}

TEST(DrawPeople, NobodyMeansNothing) {
  cv::Mat picture = Picture();
  DrawPeople(picture, TestCamera(), {}, {});
  EXPECT_TRUE(Untouched(picture));
}

TEST(DrawPeople, ThoseOutOfViewAreNotDrawn) {
  const Camera camera = TestCamera();
  cv::Mat picture = Picture();
  const double nowhere = std::nan("");
  const std::vector<Person> hidden = {At(1, {0, -30}),       At(2, {50, 0}),
                                      At(3, {0, -12}),       At(4, {nowhere, 0}),
                                      At(5, {1e300, 1e300}), At(6, {0, -11.9})};
  DrawPeople(picture, camera, hidden, {});
  EXPECT_TRUE(Untouched(picture));
}

TEST(DrawPeople, ATrailFromBehindTheCameraIsCut) {
  const Camera camera = TestCamera();
  Person person = At(3, {0, 0});
  person.trail.clear();
  for (int i = 0; i <= 40; ++i) person.trail.push_back({{0, -40.0 + i}, 1 - i / 40.0});
  cv::Mat picture = Picture();
  DrawPeople(picture, camera, {person}, {});
  EXPECT_FALSE(Untouched(picture));
}

TEST(DrawGround, OutlinesTheAreaAndKeepsThePicture) {
  const Camera camera = TestCamera();
  const Polygon area = Polygon::Rectangle({-2, -2}, {2, 2}).value();
  cv::Mat picture = Picture();
  DrawGround(picture, camera, area, false);
  const auto difference = [&](const Vector2d& ground_m) {
    const Vector2d pixel = camera.ImageFromWorld({ground_m.x(), ground_m.y(), 0}).value();
    return Distance(picture, pixel.x(), pixel.y(), kGrey);
  };
  EXPECT_GT(difference({0, -2}), 20);
  EXPECT_GT(difference({2, 0.3}), 20);
  EXPECT_EQ(difference({0, 0}), 0);
  EXPECT_EQ(difference({0.5, 3}), 0);
  DrawGround(picture, camera, area, true);
  EXPECT_GT(difference({1, 0.5}), 0);  // a line of the grid
  EXPECT_EQ(difference({0.5, 3}), 0);  // but not outside the area
}

}  // namespace
}  // namespace vantage
