// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/fast_kernel.h"

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
void SumColumns(std::size_t at, int rows, const CoverImages& images) {
  const DF d;
  V log_m = hn::Zero(d), first = hn::Zero(d), second = hn::Zero(d);
  for (int y = 0; y < rows; ++y, at += images.stride) {
    hn::Store(first, d, images.sum_first + at);
    if constexpr (kSecond) hn::Store(second, d, images.sum_second + at);
    log_m = hn::Add(log_m, hn::Load(d, images.difference + at));
    hn::Store(hn::Zero(d), d, images.difference + at);
    // Cells that add up to nothing leave rounding behind, never a probability above 1.
    const V m = hn::Exp(d, hn::Min(log_m, hn::Zero(d)));
    first = hn::Add(first, hn::Mul(m, hn::Load(d, images.first + at)));
    if constexpr (kSecond) {
      second = hn::Add(second, hn::Mul(m, hn::Load(d, images.second + at)));
    }
  }
  hn::Store(first, d, images.sum_first + at);
  if constexpr (kSecond) hn::Store(second, d, images.sum_second + at);
  hn::Store(hn::Zero(d), d, images.difference + at);
}

void SumCoveredOnTarget(const ColumnRun& run, const CoverImages& images) {
  const int rows = run.bottom - run.top;
  const std::size_t at =
      static_cast<std::size_t>(run.top) * images.stride + static_cast<std::size_t>(run.x);
  for (std::size_t lane = 0; lane < kColumns; lane += hn::Lanes(DF())) {
    if (images.second == nullptr) {
      SumColumns<false>(at + lane, rows, images);
    } else {
      SumColumns<true>(at + lane, rows, images);
    }
  }
}

}  // namespace
}  // namespace vantage::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::internal {

HWY_EXPORT(SumCoveredOnTarget);

void SumCovered(const ColumnRun& run, const CoverImages& images) {
  HWY_DYNAMIC_DISPATCH(SumCoveredOnTarget)(run, images);
}

}  // namespace vantage::internal
#endif  // HWY_ONCE
