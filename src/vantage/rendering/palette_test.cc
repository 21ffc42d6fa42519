// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/palette.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

/// CIE L*a*b*, in which a distance of about 2 can just be seen.
cv::Vec3d Lab(const cv::Scalar& bgr) {
  cv::Mat3f pixel(1, 1, cv::Vec3f(bgr[0] / 255, bgr[1] / 255, bgr[2] / 255));
  cv::Mat3f lab;
  cv::cvtColor(pixel, lab, cv::COLOR_BGR2Lab);
  return cv::Vec3d(lab(0, 0));
}

double Difference(const cv::Scalar& a, const cv::Scalar& b) { return cv::norm(Lab(a) - Lab(b)); }

TEST(Palette, IsStable) {
  // Pictures of one run must look like those of the next, and of the next version.
  EXPECT_EQ(ColorOf(TrackId{0}), cv::Scalar(255, 194, 140));
  EXPECT_EQ(ColorOf(TrackId{7}), ColorOf(TrackId{7}));
}

TEST(Palette, FewPeopleDifferMuch) {
  for (int first = 0; first < 50; ++first) {
    for (int other = first + 1; other < first + 12; ++other) {
      const double difference = Difference(ColorOf(TrackId{first}), ColorOf(TrackId{other}));
      EXPECT_GT(difference, other == first + 1 ? 40 : 14) << first << " and " << other;
    }
  }
}

TEST(Palette, NeighboursDifferInLightnessToo) {
  for (int id = 0; id < 100; ++id) {
    EXPECT_GT(std::abs(Lab(ColorOf(TrackId{id}))[0] - Lab(ColorOf(TrackId{id + 1}))[0]), 5);
  }
}

TEST(Palette, EveryIdHasALightColor) {
  using Limits = std::numeric_limits<std::int64_t>;
  std::vector<std::int64_t> ids = {Limits::min(), -1, 1'000'000'007, Limits::max()};
  for (int id = 0; id < 500; ++id) ids.push_back(id);
  for (const std::int64_t id : ids) {
    const cv::Scalar color = ColorOf(TrackId{id});
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_GE(color[channel], 0);
      EXPECT_LE(color[channel], 255);
    }
    EXPECT_GT(Lab(color)[0], 50) << id;
    EXPECT_GT(std::abs(Lab(TextColorOn(color))[0] - Lab(color)[0]), 40) << id;
  }
}

}  // namespace
}  // namespace vantage
