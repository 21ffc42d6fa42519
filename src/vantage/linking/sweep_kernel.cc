// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/sweep_kernel.h"

#include <cstddef>

// Compiles the rest of this file once for each instruction set; StepOverMoves takes the best at run
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

void StepOnTarget(const double* HWY_RESTRICT from, std::span<const KernelMove> moves,
                  std::size_t count, double* HWY_RESTRICT near) {
  const hn::ScalableTag<double> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    auto least = hn::Add(hn::LoadU(d, from + i + moves[0].offset), hn::Set(d, moves[0].cost));
    for (std::size_t m = 1; m < moves.size(); ++m) {
      const auto value = hn::LoadU(d, from + i + moves[m].offset);
      least = hn::Min(least, hn::Add(value, hn::Set(d, moves[m].cost)));
    }
    hn::StoreU(least, d, near + i);
  }
  for (; i < count; ++i) {
    double least = from[static_cast<std::ptrdiff_t>(i) + moves[0].offset] + moves[0].cost;
    for (const KernelMove& move : moves.subspan(1)) {
      const double value = from[static_cast<std::ptrdiff_t>(i) + move.offset] + move.cost;
      least = value < least ? value : least;
    }
    near[i] = least;
  }
}

}  // namespace
}  // namespace vantage::linking::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::linking {

HWY_EXPORT(StepOnTarget);

void StepOverMoves(const double* from, std::span<const KernelMove> moves, std::size_t count,
                   double* near) {
  HWY_DYNAMIC_DISPATCH(StepOnTarget)(from, moves, count, near);
}

}  // namespace vantage::linking
#endif
