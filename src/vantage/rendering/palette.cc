// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/palette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vantage {
namespace {

using Rgb = std::array<double, 3>;  // linear light, 0 to 1

/// Oklab (B. Ottosson, 2020), a space in which equal steps look equal, in polar form.
Rgb LinearFromOklch(double lightness, double chroma, double hue) {
  const double a = chroma * std::cos(hue);
  const double b = chroma * std::sin(hue);
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

/// sRGB's transfer curve, to 0..255.
double Encode(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return std::round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055));
}

bool InGamut(const Rgb& rgb) {
  return std::all_of(rgb.begin(), rgb.end(), [](double x) { return x >= 0 && x <= 1; });
}

}  // namespace

cv::Scalar ColorOf(TrackId id) {
  constexpr std::array kLightness = {0.80, 0.70, 0.89};
  constexpr double kGoldenTurn = 0.6180339887498949;  // of a full circle
  constexpr double kFirstHue = 4.4;                   // id 0 is blue
  constexpr double kTwoPi = 6.283185307179586;
  // The unsigned value keeps negative ids in range; 2^20 colours are more than can be told apart.
  const auto number = static_cast<std::uint64_t>(id) % (std::uint64_t{1} << 20);
  const double turn = std::fmod(static_cast<double>(number) * kGoldenTurn, 1.0);
  const double hue = kFirstHue + kTwoPi * turn;
  const double lightness = kLightness[number % kLightness.size()];
  double chroma = 0.19;
  Rgb rgb = LinearFromOklch(lightness, chroma, hue);
  while (!InGamut(rgb)) {
    chroma *= 0.97;
    rgb = LinearFromOklch(lightness, chroma, hue);
  }
  return {Encode(rgb[2]), Encode(rgb[1]), Encode(rgb[0])};
}

cv::Scalar TextColorOn(const cv::Scalar& color) {
  const double luma = 0.114 * color[0] + 0.587 * color[1] + 0.299 * color[2];
  return luma > 120 ? cv::Scalar(20, 16, 14) : cv::Scalar(245, 245, 245);
}

}  // namespace vantage
