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

/// The lanes of the vector that begins at column `lane` which are in [left, right).
HWY_INLINE hn::Mask<DF> ColumnsOf(const CoverPiece& piece, std::size_t lane) {
  const DF d;
  const auto within = [&](std::size_t column) {
    return hn::FirstN(d, column > lane ? column - lane : 0);
  };
  return hn::AndNot(within(piece.left), within(piece.right));
}

void AddPiecesOnTarget(std::span<const CoverPiece> pieces, const float* HWY_RESTRICT values,
                       float* HWY_RESTRICT difference) {
  const DF d;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (values[i] == 0) continue;
    const V value = hn::Set(d, values[i]);
    for (std::size_t lane = 0; lane < kColumns; lane += hn::Lanes(d)) {
      const V add = hn::IfThenElseZero(ColumnsOf(pieces[i], lane), value);
      float* const top = difference + pieces[i].top + lane;
      float* const bottom = difference + pieces[i].bottom + lane;
      hn::Store(hn::Add(hn::Load(d, top), add), d, top);
      hn::Store(hn::Sub(hn::Load(d, bottom), add), d, bottom);
    }
  }
}

void SumPiecesOnTarget(std::span<const CoverPiece> pieces, const float* HWY_RESTRICT sums,
                       float* HWY_RESTRICT out) {
  const DF d;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    V sum = hn::Zero(d);
    for (std::size_t lane = 0; lane < kColumns; lane += hn::Lanes(d)) {
      const V gained = hn::Sub(hn::Load(d, sums + pieces[i].bottom + lane),
                               hn::Load(d, sums + pieces[i].top + lane));
      sum = hn::Add(sum, hn::IfThenElseZero(ColumnsOf(pieces[i], lane), gained));
    }
    out[i] = hn::GetLane(hn::SumOfLanes(d, sum));
  }
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

HWY_EXPORT(AddPiecesOnTarget);
HWY_EXPORT(SumPiecesOnTarget);
HWY_EXPORT(SumCoveredOnTarget);

void AddPieces(std::span<const CoverPiece> pieces, const float* values, float* difference) {
  HWY_DYNAMIC_DISPATCH(AddPiecesOnTarget)(pieces, values, difference);
}

void SumPieces(std::span<const CoverPiece> pieces, const float* sums, float* out) {
  HWY_DYNAMIC_DISPATCH(SumPiecesOnTarget)(pieces, sums, out);
}

void SumCovered(const CoverRun& run) { HWY_DYNAMIC_DISPATCH(SumCoveredOnTarget)(run); }

}  // namespace vantage::internal
#endif  // HWY_ONCE
