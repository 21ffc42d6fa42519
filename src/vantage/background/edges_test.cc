// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace vantage {
namespace {

double LargestDifference(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() ? cv::norm(a, b, cv::NORM_INF) : 1e9;
}

cv::Mat Noise(cv::Size size, std::uint64_t seed) {
  cv::Mat picture(size, CV_8UC3);
  cv::RNG(seed).fill(picture, cv::RNG::UNIFORM, 0, 256);
  return picture;
}

/// Soft clouds with sharp figures and a little noise, as a camera sees a room.
cv::Mat Room(cv::Size size, std::uint64_t seed) {
  cv::Mat picture = Noise(size, seed);
  cv::GaussianBlur(picture, picture, {}, 6);
  cv::RNG random(seed + 100);
  for (int i = 0; i < 12; ++i) {
    const cv::Point centre(random.uniform(0, size.width), random.uniform(0, size.height));
    const cv::Scalar color(random.uniform(0, 256), random.uniform(0, 256), random.uniform(0, 256));
    cv::ellipse(picture, centre, {random.uniform(2, 20), random.uniform(2, 20)},
                random.uniform(0, 180), 0, 360, color, i % 3 == 0 ? 2 : cv::FILLED);
  }
  cv::Mat noise(size, CV_8UC3);
  random.fill(noise, cv::RNG::NORMAL, 8, 2);
  return picture + noise;
}

std::vector<cv::Mat> Pictures() {
  std::vector<cv::Mat> pictures;
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(2, 1), cv::Size(1, 5), cv::Size(3, 3),
                              cv::Size(40, 31), cv::Size(97, 64)}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      pictures.push_back(Noise(size, seed));
      pictures.push_back(Room(size, seed));
    }
    pictures.emplace_back(size, CV_8UC3, cv::Scalar(10, 20, 30));
  }
  return pictures;
}

TEST(Edges, GradientIsTheSobelFilterOfTheLuma) {
  for (const cv::Mat& picture : Pictures()) {
    cv::Mat luma, dx, dy;
    cv::cvtColor(picture, luma, cv::COLOR_BGR2GRAY);
    cv::Sobel(luma, dx, CV_16S, 1, 0, 3, 1, 0, cv::BORDER_REPLICATE);
    cv::Sobel(luma, dy, CV_16S, 0, 1, 3, 1, 0, cv::BORDER_REPLICATE);
    const LumaGradient gradient = GradientOf(picture);
    EXPECT_EQ(LargestDifference(gradient.x, dx), 0);
    EXPECT_EQ(LargestDifference(gradient.y, dy), 0);
    cv::Mat x, y;
    dx.convertTo(x, CV_32S);
    dy.convertTo(y, CV_32S);
    EXPECT_EQ(LargestDifference(gradient.squared, x.mul(x) + y.mul(y)), 0);
  }
}

TEST(Edges, InTheWholePictureThoseOfOpenCv) {
  int edges_px = 0;
  for (const cv::Mat& picture : Pictures()) {
    const LumaGradient gradient = GradientOf(picture);
    const cv::Mat all(picture.size(), CV_8UC1, cv::Scalar(255));
    for (const double upper :
         {EdgeThreshold(&gradient, nullptr, all), 0.0, 1.0, 37.0, 120.5, 400.0, 1e4}) {
      cv::Mat canny;
      cv::Canny(gradient.x, gradient.y, canny, upper / 2, upper, true);
      EXPECT_EQ(LargestDifference(CannyEdges(gradient, all, upper), canny), 0)
          << picture.size() << " px at " << upper;
      edges_px += cv::countNonZero(canny);
    }
  }
  EXPECT_GT(edges_px, 10000);
}

/// Maxima in the region, joined there to strong ones, by connected components.
TEST(Edges, InARegionLinkedWithinIt) {
  int linked_px = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const cv::Mat picture = Room({90, 70}, seed);
    const LumaGradient gradient = GradientOf(picture);
    cv::Mat region = cv::Mat::zeros(picture.size(), CV_8UC1);
    cv::ellipse(region, {45, 35}, {34, 26}, 0, 0, 360, 255, 7);
    const double upper = 2 * EdgeThreshold(&gradient, nullptr, region);
    ASSERT_GT(upper, 0);
    // With two equal thresholds nothing is left to link.
    cv::Mat weak, strong, labels;
    cv::Canny(gradient.x, gradient.y, weak, upper / 2, upper / 2, true);
    cv::Canny(gradient.x, gradient.y, strong, upper, upper, true);
    weak &= region;
    strong &= region;
    cv::Mat expected = cv::Mat::zeros(region.size(), CV_8UC1);
    const int count = cv::connectedComponents(weak, labels, 8);
    for (int label = 1; label < count; ++label) {
      const cv::Mat one = labels == label;
      if (cv::countNonZero(one & strong) > 0) expected |= one;
    }
    EXPECT_EQ(LargestDifference(CannyEdges(gradient, region, upper), expected), 0);
    linked_px += cv::countNonZero(expected & ~strong);
  }
  EXPECT_GT(linked_px, 100) << "some edges must be linked ones";
}

/// The length that best separates two classes, from the list of all lengths.
double SlowOtsu(const std::vector<LumaGradient>& gradients, const cv::Mat& region) {
  std::vector<double> lengths;
  for (const LumaGradient& gradient : gradients) {
    for (int y = 0; y < region.rows; ++y) {
      for (int x = 0; x < region.cols; ++x) {
        if (region.at<std::uint8_t>(y, x) == 0) continue;
        const double dx = gradient.x.at<std::int16_t>(y, x);
        const double dy = gradient.y.at<std::int16_t>(y, x);
        lengths.push_back(std::floor(std::hypot(dx, dy)));
      }
    }
  }
  std::sort(lengths.begin(), lengths.end());
  double best = -1;
  double threshold = 0;
  for (std::size_t i = 0; i + 1 < lengths.size(); ++i) {
    if (lengths[i] == lengths[i + 1]) continue;
    const auto low = static_cast<double>(i + 1);
    const auto high = static_cast<double>(lengths.size()) - low;
    double low_sum = 0, high_sum = 0;
    for (std::size_t k = 0; k < lengths.size(); ++k) (k <= i ? low_sum : high_sum) += lengths[k];
    const double apart = low_sum / low - high_sum / high;
    const double between = low * high * apart * apart;
    if (between <= best) continue;
    best = between;
    threshold = lengths[i];
  }
  return threshold;
}

TEST(Edges, ThresholdIsOtsusOverBothPictures) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(4, 3), cv::Size(30, 22)}) {
      const LumaGradient a = GradientOf(Room(size, seed));
      const LumaGradient b = GradientOf(seed % 2 == 0 ? Noise(size, seed) : Room(size, seed + 50));
      const cv::Mat all(size, CV_8UC1, cv::Scalar(255));
      cv::Mat part = all.clone();
      part.colRange(0, size.width / 2).setTo(0);
      for (const cv::Mat& region : {all, part}) {
        EXPECT_EQ(EdgeThreshold(&a, nullptr, region), SlowOtsu({a}, region));
        EXPECT_EQ(EdgeThreshold(nullptr, &b, region), SlowOtsu({b}, region));
        EXPECT_EQ(EdgeThreshold(&a, &b, region), SlowOtsu({a, b}, region));
      }
    }
  }
}

TEST(Edges, ThresholdOfNothingIsZero) {
  const LumaGradient gradient = GradientOf(Noise({9, 9}, 1));
  EXPECT_EQ(EdgeThreshold(&gradient, &gradient, cv::Mat::zeros(9, 9, CV_8UC1)), 0);
  EXPECT_EQ(EdgeThreshold(nullptr, nullptr, cv::Mat(9, 9, CV_8UC1, cv::Scalar(255))), 0);
}

}  // namespace
}  // namespace vantage
