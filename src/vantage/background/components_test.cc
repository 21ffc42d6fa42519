// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/components.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

namespace vantage {
namespace {

cv::Mat RandomMask(cv::Size size, double share, std::mt19937& random) {
  cv::Mat mask(size, CV_8UC1);
  std::bernoulli_distribution set(share);
  for (auto& pixel : cv::Mat_<std::uint8_t>(mask)) pixel = set(random) ? 255 : 0;
  return mask;
}

double LargestDifference(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() ? cv::norm(a, b, cv::NORM_INF) : 1e9;
}

/// Pixels of `mask` that can be reached from `seed` in steps of up to `reach_px` rows and columns;
/// they are taken out of it.
cv::Mat Flood(cv::Mat& mask, cv::Point seed, int reach_px) {
  cv::Mat flooded = cv::Mat::zeros(mask.size(), CV_8UC1);
  std::vector<cv::Point> open = {seed};
  mask.at<std::uint8_t>(seed) = 0;
  while (!open.empty()) {
    const cv::Point from = open.back();
    open.pop_back();
    flooded.at<std::uint8_t>(from) = 255;
    for (int y = 0; y < mask.rows; ++y) {
      for (int x = 0; x < mask.cols; ++x) {
        if (std::max(std::abs(x - from.x), std::abs(y - from.y)) > reach_px) continue;
        if (mask.at<std::uint8_t>(y, x) == 0) continue;
        mask.at<std::uint8_t>(y, x) = 0;
        open.emplace_back(x, y);
      }
    }
  }
  return flooded;
}

std::vector<Component> SlowComponents(cv::Mat mask, const ComponentRule& rule) {
  mask = mask.clone();
  const cv::Rect picture({}, mask.size());
  std::vector<Component> components;
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) == 0) continue;
      const cv::Mat pixels = Flood(mask, {x, y}, rule.reach_px);
      if (cv::countNonZero(pixels) < rule.min_area_px) continue;
      Component one;
      std::vector<cv::Point> points;
      cv::findNonZero(pixels, points);
      one.box = cv::boundingRect(points);
      one.area_px = cv::countNonZero(pixels);
      const cv::Point margin(rule.margin_px, rule.margin_px);
      one.window = cv::Rect(one.box.tl() - margin, one.box.br() + margin) & picture;
      one.pixels = pixels(one.window);
      components.push_back(one);
    }
  }
  return components;
}

void ExpectSameComponents(const cv::Mat& mask, const ComponentRule& rule) {
  const std::vector<Component> found = FindComponents(mask, rule);
  const std::vector<Component> slow = SlowComponents(mask, rule);
  ASSERT_EQ(found.size(), slow.size());
  for (std::size_t i = 0; i < slow.size(); ++i) {
    EXPECT_EQ(found[i].box, slow[i].box);
    EXPECT_EQ(found[i].area_px, slow[i].area_px);
    EXPECT_EQ(found[i].window, slow[i].window);
    EXPECT_EQ(LargestDifference(found[i].pixels, slow[i].pixels), 0);
  }
}

TEST(Components, AreThoseOfASlowFloodFill) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    const cv::Size size(1 + static_cast<int>(random() % 40), 1 + static_cast<int>(random() % 25));
    const ComponentRule rule{.reach_px = round % 3 == 0 ? 1 : 1 + static_cast<int>(random() % 6),
                             .min_area_px = 1 + static_cast<int>(random() % 6),
                             .margin_px = static_cast<int>(random() % 5)};
    const double share = round % 2 == 0 ? 0.04 : 0.4;
    SCOPED_TRACE(::testing::Message()
                 << "round " << round << ", " << size << " px, reach " << rule.reach_px);
    ExpectSameComponents(RandomMask(size, share, random), rule);
  }
}

TEST(Components, AnyValueButZeroIsForegroundAndRowsMayBeApart) {
  std::mt19937 random(4);
  cv::Mat picture = RandomMask({50, 30}, 0.3, random);
  for (auto& pixel : cv::Mat_<std::uint8_t>(picture)) {
    if (pixel != 0) pixel = static_cast<std::uint8_t>(1 + random() % 255);
  }
  ExpectSameComponents(picture(cv::Rect(3, 5, 41, 19)), {.reach_px = 2, .margin_px = 1});
}

TEST(Components, LargeOnesInOrderWithTheirWindows) {
  cv::Mat mask = cv::Mat::zeros(40, 60, CV_8UC1);
  mask(cv::Rect(50, 2, 10, 6)) = 255;  // at the picture's edge
  mask(cv::Rect(5, 10, 4, 5)) = 255;
  mask.at<std::uint8_t>(15, 9) = 255;  // touches it at a corner
  mask(cv::Rect(30, 30, 3, 3)) = 255;  // too small
  const std::vector<Component> found = FindComponents(mask, {.min_area_px = 10, .margin_px = 3});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].box, cv::Rect(50, 2, 10, 6));
  EXPECT_EQ(found[0].window, cv::Rect(47, 0, 13, 11));
  EXPECT_EQ(found[0].area_px, 60);
  EXPECT_EQ(found[1].box, cv::Rect(5, 10, 5, 6));
  EXPECT_EQ(found[1].area_px, 21);
}

TEST(Components, NoneInEmptyMasksAndOneInFullOnes) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(7, 3), cv::Size(1, 9)}) {
    EXPECT_TRUE(FindComponents(cv::Mat::zeros(size, CV_8UC1), {.margin_px = 3}).empty());
    const cv::Mat full(size, CV_8UC1, cv::Scalar(255));
    const auto found = FindComponents(full, {.margin_px = 3});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].window, cv::Rect({}, size));
    const BorderRegions border = BorderOf(found[0], 1, 2);
    EXPECT_EQ(cv::countNonZero(border.expanded), 0) << "nothing lies outside";
    EXPECT_EQ(border.free_share, 0);
  }
}

TEST(Grown, IsTheDilationByASquare) {
  std::mt19937 random(6);
  for (int round = 0; round < 200; ++round) {
    const cv::Size size(1 + static_cast<int>(random() % 30), 1 + static_cast<int>(random() % 30));
    const int radius_px = round % 9;
    const cv::Mat mask = RandomMask(size, 0.05, random);
    cv::Mat dilated;
    cv::dilate(mask, dilated,
               cv::getStructuringElement(cv::MORPH_RECT, {2 * radius_px + 1, 2 * radius_px + 1}));
    EXPECT_EQ(LargestDifference(Grown(mask, radius_px), dilated), 0)
        << size << " px by " << radius_px;
  }
}

/// A picture of the pixels for which `holds`.
cv::Mat Where(cv::Size size, const std::function<bool(cv::Point)>& holds) {
  cv::Mat picture(size, CV_8UC1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      picture.at<std::uint8_t>(y, x) = holds({x, y}) ? 255 : 0;
    }
  }
  return picture;
}

/// True when a pixel of `pixels` lies up to `distance_px` rows and columns from `p`.
bool IsNear(const cv::Mat& pixels, cv::Point p, int distance_px) {
  for (int y = p.y - distance_px; y <= p.y + distance_px; ++y) {
    for (int x = p.x - distance_px; x <= p.x + distance_px; ++x) {
      if (x < 0 || y < 0 || x >= pixels.cols || y >= pixels.rows) continue;
      if (pixels.at<std::uint8_t>(y, x) != 0) return true;
    }
  }
  return false;
}

/// The definitions of section 2 and of the header, pixel by pixel.
void ExpectAsDefined(const BorderRegions& regions, const Component& component, int half_width_px,
                     int ring_px, const cv::Mat& others) {
  const cv::Mat& c = component.pixels;
  const cv::Size size = c.size();
  const auto in = [](const cv::Mat& pixels, cv::Point p) {
    return pixels.at<std::uint8_t>(p) != 0;
  };
  const cv::Mat not_c = Where(size, [&](cv::Point p) { return !in(c, p); });
  const cv::Mat tb = Where(size, [&](cv::Point p) { return in(c, p) && IsNear(not_c, p, 1); });
  const cv::Mat expanded = Where(size, [&](cv::Point p) { return IsNear(tb, p, half_width_px); });
  const cv::Mat both = Where(size, [&](cv::Point p) { return in(c, p) || in(expanded, p); });
  const cv::Mat judged = Where(
      size, [&](cv::Point p) { return others.empty() || !IsNear(others, p, half_width_px + 1); });
  const auto expect = [&](const cv::Mat& region, const char* name,
                          const std::function<bool(cv::Point)>& holds) {
    const cv::Mat defined = Where(size, [&](cv::Point p) { return in(judged, p) && holds(p); });
    EXPECT_EQ(LargestDifference(region, defined), 0) << name;
  };
  expect(regions.true_border, "C_tb", [&](cv::Point p) { return in(tb, p); });
  expect(regions.expanded, "C'", [&](cv::Point p) { return in(expanded, p); });
  expect(regions.expansion, "C_eb", [&](cv::Point p) { return in(expanded, p) && !in(tb, p); });
  expect(regions.outer, "C_ob",
         [&](cv::Point p) { return !in(both, p) && IsNear(both, p, ring_px); });
  expect(regions.inside, "C_ic",
         [&](cv::Point p) { return in(c, p) && !in(tb, p) && IsNear(tb, p, ring_px); });
  expect(regions.outside, "C_oc", [&](cv::Point p) { return !in(c, p) && IsNear(tb, p, ring_px); });
  const double border_px = cv::countNonZero(expanded);
  EXPECT_DOUBLE_EQ(regions.free_share,
                   border_px > 0 ? cv::countNonZero(expanded & judged) / border_px : 0);
}

TEST(Components, BorderRegionsAreAsDefined) {
  std::mt19937 random(5);
  int cut = 0;
  for (int round = 0; round < 60; ++round) {
    cv::Mat mask;
    cv::medianBlur(RandomMask({34, 26}, 0.5, random), mask, 5);
    const int half_width_px = 1 + round % 3;
    const int ring_px = 1 + round % 4;
    const ComponentRule rule{.margin_px = half_width_px + ring_px};
    for (const Component& component : FindComponents(mask, rule)) {
      SCOPED_TRACE(::testing::Message() << "round " << round << ", box " << component.box);
      ExpectAsDefined(BorderOf(component, half_width_px, ring_px), component, half_width_px,
                      ring_px, {});
      cv::Mat others = mask(component.window) & ~component.pixels;
      if (round % 2 == 0) others |= RandomMask(others.size(), 0.01, random);
      const BorderRegions regions = BorderOf(component, half_width_px, ring_px, others);
      ExpectAsDefined(regions, component, half_width_px, ring_px, others);
      if (regions.free_share > 0 && regions.free_share < 1) ++cut;
    }
  }
  EXPECT_GT(cut, 50) << "the rounds must try what `others` do";
}

}  // namespace
}  // namespace vantage
