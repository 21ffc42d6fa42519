// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/color.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "vantage/background/test_targets.h"

namespace vantage {
namespace {

/// Every 5th level of each channel, blue green red.
std::vector<std::uint8_t> Samples() {
  std::vector<std::uint8_t> bgr;
  for (int b = 0; b < 256; b += 5) {
    for (int g = 0; g < 256; g += 5) {
      for (int r = 0; r < 256; r += 5) {
        for (const int level : {b, g, r}) bgr.push_back(static_cast<std::uint8_t>(level));
      }
    }
  }
  return bgr;
}

double Linear(std::uint8_t level) {
  static const std::array<double, 256> linear = [] {
    std::array<double, 256> values{};
    for (std::size_t i = 0; i < 256; ++i) {
      const double v = static_cast<double>(i) / 255.0;
      values[i] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    }
    return values;
  }();
  return linear[level];
}

/// CIE 1976 by the book, in double.
std::array<double, 3> ExactLuv(const std::uint8_t* bgr) {
  const double b = Linear(bgr[0]);
  const double g = Linear(bgr[1]);
  const double r = Linear(bgr[2]);
  const double x = 0.4124564 * r + 0.3575761 * g + 0.1804375 * b;
  const double y = 0.2126729 * r + 0.7151522 * g + 0.0721750 * b;
  const double z = 0.0193339 * r + 0.1191920 * g + 0.9503041 * b;
  if (y == 0) return {0, 0, 0};
  const double l = y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : 24389.0 / 27 * y;
  const double sum = x + 15 * y + 3 * z;
  const double white = 0.95047 + 15 + 3 * 1.08883;
  return {l, 13 * l * (4 * x / sum - 4 * 0.95047 / white), 13 * l * (9 * y / sum - 9 / white)};
}

TEST(Color, EveryLuvFollowsTheFormulasWithinAHundredthOnEveryTarget) {
  testing::HighwayTargets targets;
  std::vector<std::uint8_t> bgr(std::size_t{3} * 256 * 256);
  std::vector<float> luv(bgr.size());
  std::vector<float> other(bgr.size());
  double worst = 0;
  for (int b = 0; b < 256; ++b) {
    for (std::size_t i = 0; i < bgr.size(); i += 3) {
      bgr[i] = static_cast<std::uint8_t>(b);
      bgr[i + 1] = static_cast<std::uint8_t>(i / 3 / 256);
      bgr[i + 2] = static_cast<std::uint8_t>(i / 3 % 256);
    }
    targets.ChooseBest();
    LuvFromBgr(bgr.data(), luv.data(), 256 * 256);
    for (std::size_t i = 0; i < bgr.size(); i += 3) {
      const std::array<double, 3> exact = ExactLuv(&bgr[i]);
      for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(luv[i + c] - exact[c]));
    }
    if (b % 5 != 0) continue;
    for (std::size_t t = 0; t < targets.size(); ++t) {
      targets.Choose(t);
      LuvFromBgr(bgr.data(), other.data(), 256 * 256);
      ASSERT_EQ(luv, other) << b;
    }
  }
  EXPECT_LT(worst, 0.01);
}

TEST(Color, OneColourByTheExactFormulasIsNearToThatOfARow) {
  const std::vector<std::uint8_t> bgr = Samples();
  std::vector<float> luv(bgr.size());
  LuvFromBgr(bgr.data(), luv.data(), static_cast<int>(bgr.size() / 3));
  for (std::size_t i = 0; i < bgr.size(); i += 3) {
    const std::array<float, 3> levels = {float(bgr[i]), float(bgr[i + 1]), float(bgr[i + 2])};
    const std::array<float, 3> exact = LuvFromLevels(levels);
    const std::array<float, 3> back = LevelsFromLuv(exact);
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(exact[c], luv[i + c], 0.01F);
      ASSERT_NEAR(back[c], levels[c], 0.02F);
    }
  }
}

TEST(Color, BlackWhiteAndRedHaveTheKnownValues) {
  const std::vector<std::uint8_t> bgr = {0, 0, 0, 255, 255, 255, 0, 0, 255};
  std::vector<float> luv(9);
  LuvFromBgr(bgr.data(), luv.data(), 3);
  const std::vector<float> expected = {0, 0, 0, 100, 0, 0, 53.24F, 175.01F, 37.76F};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(luv[i], expected[i], 0.03) << i;
}

TEST(Color, ThereAndBackGivesTheSameLevels) {
  const std::vector<std::uint8_t> bgr = Samples();
  const int pixels = static_cast<int>(bgr.size() / 3);
  std::vector<float> values(bgr.size());
  std::vector<std::uint8_t> back(bgr.size());
  LuvFromBgr(bgr.data(), values.data(), pixels);
  BgrFromLuv(values.data(), back.data(), pixels);
  EXPECT_EQ(bgr, back);
  FloatFromBgr(bgr.data(), values.data(), pixels);
  BgrFromFloat(values.data(), back.data(), pixels);
  EXPECT_EQ(bgr, back);
}

TEST(Color, ColoursThatNoScreenShowsAreClipped) {
  const std::vector<float> luv = {60, 400, 0, 100, -300, 0, 30, 0, -500, -5, 1, 1};
  std::vector<std::uint8_t> bgr(12, 7);
  BgrFromLuv(luv.data(), bgr.data(), 4);
  EXPECT_EQ(bgr[2], 255);  // redder than red
  EXPECT_EQ(std::vector(bgr.begin() + 9, bgr.end()), std::vector<std::uint8_t>(3, 0));
}

}  // namespace
}  // namespace vantage
