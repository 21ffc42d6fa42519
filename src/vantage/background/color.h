// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace vantage {

/// Rows of pixels between 8-bit BGR (sRGB) and the colour spaces of the background model, three
/// floats a pixel.

/// CIE 1976 L*u*v* with the white point D65: L* in [0, 100], u* in about [-84, 176], v* in about
/// [-135, 108]; within 0.01 of the exact formulas. Same bits on every instruction set: what the
/// mixture model computes.
void LuvFromBgr(const std::uint8_t* bgr, float* luv, int pixels);
/// The nearest 8-bit BGR; colours outside sRGB are clipped.
void BgrFromLuv(const float* luv, std::uint8_t* bgr, int pixels);

/// 8-bit levels as floats and back, rounded; the channels stay in the order blue, green, red.
void FloatFromBgr(const std::uint8_t* bgr, float* levels, int pixels);
void BgrFromFloat(const float* levels, std::uint8_t* bgr, int pixels);

/// One colour by the exact formulas, levels between the whole ones included.
std::array<float, 3> LuvFromLevels(const std::array<float, 3>& bgr);
/// Levels in [0, 255], not rounded; colours outside sRGB are clipped.
std::array<float, 3> LevelsFromLuv(const std::array<float, 3>& luv);

}  // namespace vantage
