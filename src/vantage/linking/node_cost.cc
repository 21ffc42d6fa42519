// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/node_cost.h"

#include <algorithm>
#include <cmath>

namespace vantage::linking {
namespace {

/// Natural logarithm of a positive finite number. log(m 2^e) = e log 2 + 2 artanh(s), where
/// s = (m - 1) / (m + 1); with m in [1/sqrt 2, sqrt 2], s^2 <= 0.0295 and twelve terms of the
/// series leave less than 1e-18.
double Log(double x) {
  constexpr double kLog2 = 0.693147180559945309417232121458;
  constexpr double kRootOfHalf = 0.707106781186547524400844362105;
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);  // exact, in [0.5, 1)
  if (mantissa < kRootOfHalf) {
    mantissa *= 2;
    --exponent;
  }
  const double s = (mantissa - 1) / (mantissa + 1);
  const double s2 = s * s;
  double series = 0;
  for (int k = 23; k >= 1; k -= 2) series = series * s2 + 1.0 / k;
  return exponent * kLog2 + 2 * s * series;
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
  const Cost cost = ToUnits(Log((1 - p) / p));
  return static_cast<std::int32_t>(std::clamp<Cost>(cost, -largest_, largest_));
}

}  // namespace vantage::linking
