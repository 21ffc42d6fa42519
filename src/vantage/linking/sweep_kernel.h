// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

/// Internal to the linking module.

namespace vantage::linking {

/// A move as the kernel sees it.
struct KernelMove {
  std::ptrdiff_t offset = 0;  ///< in the padded frame
  double cost = 0;
};

/// One step of the dynamic program along a row: out[i] = cost[i] + the least of edge[i] and, over
/// the moves m, ahead[i + m.offset] + m.cost; and most[i] at most. Exact, for integers below 2^53.
/// Vector code, the best instruction set at run time.
void StepRow(const double* ahead, std::span<const KernelMove> moves, const double* edge,
             const std::int32_t* cost, std::size_t count, const double* most, double* out);

}  // namespace vantage::linking
