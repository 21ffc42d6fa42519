// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/camera_shift.h"

#include <gmock/gmock.h>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

/// A picture of many edges, larger than what the camera sees of it.
cv::Mat World() {
  cv::Mat world(300, 400, CV_8UC3, cv::Scalar::all(120));
  cv::RNG random(5);
  for (int i = 0; i < 150; ++i) {
    const cv::Rect box(random.uniform(0, 380), random.uniform(0, 280), random.uniform(5, 60),
                       random.uniform(5, 60));
    cv::rectangle(world, box, cv::Scalar::all(random.uniform(30, 220)), -1);
  }
  return world;
}
const cv::Rect kView(40, 30, 320, 240);

cv::Mat Noisy(const cv::Mat& picture, std::uint64_t seed) {
  cv::Mat noise(picture.size(), CV_8UC3);
  cv::RNG random(seed);
  random.fill(noise, cv::RNG::NORMAL, 10, 3);
  return picture + noise - cv::Scalar::all(10);
}

TEST(CameraShift, FindsTheShift) {
  const cv::Mat background = Noisy(World()(kView), 1);
  for (const cv::Point shift :
       {cv::Point(3, 0), cv::Point(-4, 3), cv::Point(0, -12), cv::Point(30, 20)}) {
    const cv::Mat frame = Noisy(World()(kView - shift), 2);
    const auto found = EstimateCameraShift(frame, background, 2);
    ASSERT_TRUE(found) << shift;
    EXPECT_NEAR(found->shift_px.x, shift.x, 0.5) << shift;
    EXPECT_NEAR(found->shift_px.y, shift.y, 0.5) << shift;
    EXPECT_NEAR(found->length_px, cv::norm(shift), 0.5) << shift;
    EXPECT_FALSE(EstimateCameraShift(frame, background, cv::norm(shift) + 1)) << shift;
    EXPECT_TRUE(EstimateCameraShift(0.5 * frame, background, 2)) << "in another light " << shift;
  }
}

TEST(CameraShift, FindsARotation) {
  const cv::Mat background = Noisy(World()(kView), 1);
  const cv::Mat turn = cv::getRotationMatrix2D(cv::Point2f(200, 150), 3, 1);
  cv::Mat turned;
  cv::warpAffine(World(), turned, turn, World().size());
  const auto found = EstimateCameraShift(Noisy(turned(kView), 2), background, 2);
  ASSERT_TRUE(found);
  // Eight of the nine parts are 80 to 133 px from the middle, moved by 3 degrees of that.
  EXPECT_GT(found->length_px, 4);
  EXPECT_LT(found->length_px, 8);
}

TEST(CameraShift, NeitherLightNorABusIsAShift) {
  const cv::Mat background = Noisy(World()(kView), 1);
  EXPECT_FALSE(EstimateCameraShift(Noisy(World()(kView), 2), background, 2));
  EXPECT_FALSE(EstimateCameraShift(Noisy(0.4 * World()(kView), 2), background, 2));
  cv::Mat bus = World()(kView).clone();
  bus(cv::Rect(0, 30, 260, 200)) = cv::Scalar(50, 60, 190);
  for (int i = 0; i < 4; ++i) bus(cv::Rect(10 + 60 * i, 60, 45, 60)) = cv::Scalar::all(30);
  EXPECT_FALSE(EstimateCameraShift(Noisy(bus, 2), background, 2));
  cv::Mat other;
  cv::flip(World()(kView), other, -1);
  EXPECT_FALSE(EstimateCameraShift(Noisy(other, 2), background, 2));
}

TEST(CameraShift, PicturesWithoutEdgesOrSizeSayNothing) {
  const cv::Mat flat(240, 320, CV_8UC3, cv::Scalar::all(90));
  EXPECT_FALSE(EstimateCameraShift(flat, flat, 2));
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(900, 5), cv::Size(24, 24)}) {
    const cv::Mat tiny(size, CV_8UC3, cv::Scalar::all(90));
    EXPECT_FALSE(EstimateCameraShift(tiny, tiny, 2));
  }
}

}  // namespace
}  // namespace vantage
