// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/color.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

// Compiles the part between HWY_BEFORE_NAMESPACE and HWY_AFTER_NAMESPACE once for each instruction
// set; LuvFromBgr takes the best at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vantage/background/color.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which must come first.
#include <hwy/highway.h>

#include "vantage/background/color-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::HWY_NAMESPACE {
namespace {

void LuvRow(const std::uint8_t* bgr, float* luv, int pixels) {
  const HWY_CAPPED(float, 16) d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  HWY_ALIGN float planes[3][16] = {};
  for (int x = 0; x < pixels; x += lanes) {
    const int count = std::min(lanes, pixels - x);
    for (int i = 0; i < count; ++i, bgr += 3) {
      for (int c = 0; c < 3; ++c) planes[c][i] = bgr[c];
    }
    const auto color =
        LuvFromLevels(d, Color<hn::Vec<decltype(d)>>{hn::Load(d, planes[0]), hn::Load(d, planes[1]),
                                                     hn::Load(d, planes[2])});
    hn::Store(color.c0, d, planes[0]);
    hn::Store(color.c1, d, planes[1]);
    hn::Store(color.c2, d, planes[2]);
    for (int i = 0; i < count; ++i, luv += 3) {
      for (int c = 0; c < 3; ++c) luv[c] = planes[c][i];
    }
  }
}

}  // namespace
}  // namespace vantage::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage {
namespace {

// u'_n and v'_n of D65, the white of sRGB.
constexpr float kWhiteU = 0.19783945F;
constexpr float kWhiteV = 0.46834203F;

std::uint8_t Rounded(float level) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0F, 255.0F)));
}

float LinearOfLevel(float level) {
  const float value = level / 255;
  return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}

float LevelOfLinear(float value) {
  const float encoded =
      value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1 / 2.4F) - 0.055F;
  return std::clamp(255 * encoded, 0.0F, 255.0F);
}

}  // namespace

HWY_EXPORT(LuvRow);

void LuvFromBgr(const std::uint8_t* bgr, float* luv, int pixels) {
  HWY_DYNAMIC_DISPATCH(LuvRow)(bgr, luv, pixels);
}

void BgrFromLuv(const float* luv, std::uint8_t* bgr, int pixels) {
  for (int i = 0; i < pixels; ++i, luv += 3, bgr += 3) {
    const std::array<float, 3> levels = LevelsFromLuv({luv[0], luv[1], luv[2]});
    std::transform(levels.begin(), levels.end(), bgr, Rounded);
  }
}

void FloatFromBgr(const std::uint8_t* bgr, float* levels, int pixels) {
  std::copy_n(bgr, 3 * pixels, levels);
}

void BgrFromFloat(const float* levels, std::uint8_t* bgr, int pixels) {
  std::transform(levels, levels + 3 * pixels, bgr, Rounded);
}

std::array<float, 3> LuvFromLevels(const std::array<float, 3>& bgr) {
  const float b = LinearOfLevel(bgr[0]);
  const float g = LinearOfLevel(bgr[1]);
  const float r = LinearOfLevel(bgr[2]);
  const float x = 0.4124564F * r + 0.3575761F * g + 0.1804375F * b;
  const float y = 0.2126729F * r + 0.7151522F * g + 0.0721750F * b;
  const float z = 0.0193339F * r + 0.1191920F * g + 0.9503041F * b;
  const float l = y > 216.0F / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389.0F / 27;
  // Black has no chromaticity; L* = 0 makes u* and v* 0 whatever stands here.
  const float scale = 1 / std::max(x + 15 * y + 3 * z, 1e-12F);
  return {l, 13 * l * (4 * x * scale - kWhiteU), 13 * l * (9 * y * scale - kWhiteV)};
}

std::array<float, 3> LevelsFromLuv(const std::array<float, 3>& luv) {
  const float l = luv[0];
  float x = 0;
  float y = 0;
  float z = 0;
  if (l > 0) {
    const float u = luv[1] / (13 * l) + kWhiteU;
    const float v = std::max(luv[2] / (13 * l) + kWhiteV, 1e-6F);
    const float root = (l + 16) / 116;
    y = l > 8 ? root * root * root : l * 27 / 24389;
    x = y * 9 * u / (4 * v);
    z = y * (12 - 3 * u - 20 * v) / (4 * v);
  }
  return {LevelOfLinear(0.0556434F * x - 0.2040259F * y + 1.0572252F * z),
          LevelOfLinear(-0.9692660F * x + 1.8760108F * y + 0.0415560F * z),
          LevelOfLinear(3.2404542F * x - 1.5371385F * y - 0.4985314F * z)};
}

}  // namespace vantage
#endif  // HWY_ONCE
