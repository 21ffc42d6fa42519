// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/fast_kernel.h"

#include <cstddef>

// Compiles the rest of this file once for each instruction set; SumCovered takes the best at run
// time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vantage/occupancy/fast_kernel.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which must come first.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vantage::internal::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using DF = HWY_CAPPED(float, kColumns);
using V = hn::Vec<DF>;

template <bool kSecond>
void SumColumns(std::size_t at, const CoverRun& run) {
  const DF d;
  V log_m = hn::Zero(d), first = hn::Zero(d), second = hn::Zero(d);
  for (int y = 0; y < run.rows; ++y, at += kColumns) {
    hn::Store(first, d, run.sum_first + at);
    if constexpr (kSecond) hn::Store(second, d, run.sum_second + at);
    log_m = hn::Add(log_m, hn::Load(d, run.difference + at));
    hn::Store(hn::Zero(d), d, run.difference + at);
    // Cells that add up to nothing leave rounding behind, never a probability above 1.
    const V m = hn::Exp(d, hn::Min(log_m, hn::Zero(d)));
    first = hn::Add(first, hn::Mul(m, hn::Load(d, run.first + at)));
    if constexpr (kSecond) second = hn::Add(second, hn::Mul(m, hn::Load(d, run.second + at)));
  }
  hn::Store(first, d, run.sum_first + at);
  if constexpr (kSecond) hn::Store(second, d, run.sum_second + at);
  hn::Store(hn::Zero(d), d, run.difference + at);
}

void SumCoveredOnTarget(const CoverRun& run) {
  for (std::size_t lane = 0; lane < kColumns; lane += hn::Lanes(DF())) {
    if (run.second == nullptr) {
      SumColumns<false>(lane, run);
    } else {
      SumColumns<true>(lane, run);
    }
  }
}

}  // namespace
}  // namespace vantage::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::internal {

HWY_EXPORT(SumCoveredOnTarget);

void SumCovered(const CoverRun& run) { HWY_DYNAMIC_DISPATCH(SumCoveredOnTarget)(run); }

}  // namespace vantage::internal
#endif  // HWY_ONCE
