// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

/// Internal to the linking module.

namespace vantage::linking {

/// A move as the kernel sees it.
struct KernelMove {
  std::ptrdiff_t offset = 0;  ///< in the padded frame
  double cost = 0;
};

/// For each of `count` places from `from` on in a padded frame, the least of value + cost over the
/// moves: near[i] = min over moves m of from[i + m.offset] + m.cost. The arithmetic is exact for
/// integers below 2^53. Vector code, the best instruction set at run time.
void StepOverMoves(const double* from, std::span<const KernelMove> moves, std::size_t count,
                   double* near);

}  // namespace vantage::linking
