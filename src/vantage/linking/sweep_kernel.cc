// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/sweep_kernel.h"

#include <algorithm>
#include <cstddef>

// Compiles the rest of this file once for each instruction set; StepRow takes the best at run
// time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vantage/linking/sweep_kernel.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which must come first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vantage::linking::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

void StepRowOnTarget(const double* HWY_RESTRICT ahead, std::span<const KernelMove> moves,
                     const double* HWY_RESTRICT edge, const std::int32_t* HWY_RESTRICT cost,
                     std::size_t count, const double* HWY_RESTRICT most, double* HWY_RESTRICT out) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<std::int32_t, decltype(d)> d32;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    auto least = hn::LoadU(d, edge + i);
    for (std::size_t m = 0; m < moves.size(); ++m) {
      const auto value = hn::LoadU(d, ahead + i + moves[m].offset);
      least = hn::Min(least, hn::Add(value, hn::Set(d, moves[m].cost)));
    }
    const auto value = hn::Add(least, hn::PromoteTo(d, hn::LoadU(d32, cost + i)));
    hn::StoreU(hn::Min(value, hn::LoadU(d, most + i)), d, out + i);
  }
  for (; i < count; ++i) {
    double least = edge[i];
    for (const KernelMove& move : moves) {
      const double value = ahead[static_cast<std::ptrdiff_t>(i) + move.offset] + move.cost;
      least = value < least ? value : least;
    }
    out[i] = std::min(least + cost[i], most[i]);
  }
}

}  // namespace
}  // namespace vantage::linking::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::linking {

HWY_EXPORT(StepRowOnTarget);

void StepRow(const double* ahead, std::span<const KernelMove> moves, const double* edge,
             const std::int32_t* cost, std::size_t count, const double* most, double* out) {
  HWY_DYNAMIC_DISPATCH(StepRowOnTarget)(ahead, moves, edge, cost, count, most, out);
}

}  // namespace vantage::linking
#endif
