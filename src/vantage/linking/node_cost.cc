// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/node_cost.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vantage::linking {
namespace {

/// Natural logarithm of a positive normal number. log(m 2^e) = e log 2 + 2 artanh(s), where
/// s = (m - 1) / (m + 1); with m in [1/sqrt 2, sqrt 2], s^2 <= 0.0295 and twelve terms of the
/// series leave less than 1e-18.
double Log(double x) {
  constexpr double kLog2 = 0.693147180559945309417232121458;
  constexpr double kRootOf2 = 1.41421356237309504880168872421;
  constexpr int kMantissaBits = 52;
  constexpr std::uint64_t kMantissa = (std::uint64_t{1} << kMantissaBits) - 1;
  constexpr std::uint64_t kOne = std::bit_cast<std::uint64_t>(1.0);
  const auto bits = std::bit_cast<std::uint64_t>(x);
  auto exponent = static_cast<std::int64_t>(bits >> kMantissaBits) - 1023;
  auto mantissa = std::bit_cast<double>((bits & kMantissa) | kOne);  // in [1, 2)
  if (mantissa > kRootOf2) {
    mantissa /= 2;
    ++exponent;
  }
  const double s = (mantissa - 1) / (mantissa + 1);
  const double s2 = s * s;
  double series = 0;
  for (int k = 23; k >= 1; k -= 2) series = series * s2 + 1.0 / k;
  return static_cast<double>(exponent) * kLog2 + 2 * s * series;
}

}  // namespace

Cost ToUnits(double cost) { return std::llround(cost * kUnitsPerCost); }

// Clipped as a cost: 1 - clip itself may round to 1.
NodeCost::NodeCost(double clip)
    : largest_(static_cast<std::int32_t>(ToUnits(Log((1 - clip) / clip)))) {}

std::int32_t NodeCost::operator()(float probability) const {
  const auto p = static_cast<double>(probability);
  if (p <= 0) return largest_;
  if (p >= 1) return -largest_;
  // Adding and taking away 1.5 * 2^52 rounds to an integer: one addition in place of a call.
  constexpr double kRound = 0x1.8p52;
  const double cost = (Log((1 - p) / p) * kUnitsPerCost + kRound) - kRound;
  const auto largest = static_cast<double>(largest_);
  return static_cast<std::int32_t>(std::clamp(cost, -largest, largest));
}

}  // namespace vantage::linking
