// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/color.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vantage {
namespace {

// u'_n and v'_n of D65, the white of sRGB.
constexpr float kWhiteU = 0.19783945F;
constexpr float kWhiteV = 0.46834203F;

// L*(Y) is interpolated between this many nodes: off by at most 0.0006.
constexpr int kLightnessSteps = 4096;

struct Tables {
  std::array<float, 256> linear{};                     // of an sRGB level
  std::array<float, kLightnessSteps + 2> lightness{};  // L* of Y = i / kLightnessSteps
  Tables() {
    for (int level = 0; level < 256; ++level) {
      const double value = level / 255.0;
      linear[static_cast<size_t>(level)] = static_cast<float>(
          value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
    }
    for (int i = 0; i < kLightnessSteps + 2; ++i) {
      const double y = static_cast<double>(i) / kLightnessSteps;
      lightness[static_cast<size_t>(i)] =
          static_cast<float>(y > 216.0 / 24389.0 ? 116 * std::cbrt(y) - 16 : y * 24389.0 / 27.0);
    }
  }
};

const Tables& SharedTables() {
  static const Tables tables;
  return tables;
}

std::uint8_t LevelOf(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
}

std::uint8_t LevelOfLinear(float value) {
  const float encoded =
      value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1 / 2.4F) - 0.055F;
  return LevelOf(255 * encoded);
}

}  // namespace

void LuvFromBgr(const std::uint8_t* bgr, float* luv, int pixels) {
  const Tables& tables = SharedTables();
  for (int i = 0; i < pixels; ++i, bgr += 3, luv += 3) {
    const float b = tables.linear[bgr[0]];
    const float g = tables.linear[bgr[1]];
    const float r = tables.linear[bgr[2]];
    const float x = 0.4124564F * r + 0.3575761F * g + 0.1804375F * b;
    const float y = 0.2126729F * r + 0.7151522F * g + 0.0721750F * b;
    const float z = 0.0193339F * r + 0.1191920F * g + 0.9503041F * b;
    const float at = y * kLightnessSteps;
    const auto node = static_cast<std::size_t>(at);
    const float low = tables.lightness[node];
    const float l = low + (at - static_cast<float>(node)) * (tables.lightness[node + 1] - low);
    // Black has no chromaticity; L* = 0 makes u* and v* 0 whatever stands here.
    const float scale = 1 / std::max(x + 15 * y + 3 * z, 1e-12F);
    luv[0] = l;
    luv[1] = 13 * l * (4 * x * scale - kWhiteU);
    luv[2] = 13 * l * (9 * y * scale - kWhiteV);
  }
}

void BgrFromLuv(const float* luv, std::uint8_t* bgr, int pixels) {
  for (int i = 0; i < pixels; ++i, luv += 3, bgr += 3) {
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
    bgr[0] = LevelOfLinear(0.0556434F * x - 0.2040259F * y + 1.0572252F * z);
    bgr[1] = LevelOfLinear(-0.9692660F * x + 1.8760108F * y + 0.0415560F * z);
    bgr[2] = LevelOfLinear(3.2404542F * x - 1.5371385F * y - 0.4985314F * z);
  }
}

void FloatFromBgr(const std::uint8_t* bgr, float* levels, int pixels) {
  std::copy_n(bgr, 3 * pixels, levels);
}

void BgrFromFloat(const float* levels, std::uint8_t* bgr, int pixels) {
  std::transform(levels, levels + 3 * pixels, bgr, LevelOf);
}

}  // namespace vantage
