// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

/// Internal to the linking module.

namespace vantage::linking {

/// Costs are integers in units of 2^-20: sums are exact, whatever their order.
using Cost = std::int64_t;
inline constexpr double kUnitsPerCost = 1 << 20;

/// `cost` in units, rounded to the nearest.
Cost ToUnits(double cost);

/// The cost of a node (algorithms.md section 4), -log(p / (1 - p)) in units, for probabilities in
/// [0, 1], which are clipped to [clip, 1 - clip]. Its own logarithm, made of exactly rounded
/// operations: the same integer on every machine, whatever its mathematical library.
class NodeCost {
 public:
  /// 0 < clip < 0.5.
  explicit NodeCost(double clip);

  std::int32_t operator()(float probability) const;
  /// Cost at the clip: none is above it or below its negative.
  std::int32_t largest() const { return largest_; }

 private:
  std::int32_t largest_;
};

}  // namespace vantage::linking
