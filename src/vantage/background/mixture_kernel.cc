// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/mixture_kernel.h"

#include <algorithm>
#include <cstddef>

// Compiles the rest of this file once for each instruction set; StepRow takes the best at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vantage/background/mixture_kernel.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which must come first.
#include <hwy/highway.h>

#include "vantage/background/color-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::HWY_NAMESPACE {
namespace {

constexpr int kPixels = GaussianBlock::kPixels;
// Pixels whose colours are converted at a time: 1.5 KiB, within the first cache.
constexpr int kTilePixels = 8 * kPixels;
constexpr std::size_t kBlockFloats = sizeof(GaussianBlock) / sizeof(float);

using DF = HWY_CAPPED(float, kPixels);
using DI = hn::RebindToSigned<DF>;
using DLevel = hn::Rebind<std::uint8_t, DF>;
using V = hn::Vec<DF>;
using Lanes = hn::Mask<DF>;  // which of the pixels of a vector

/// One Gaussian of as many pixels as a vector has lanes; `at` points to its first mean.
struct Gaussian {
  Color<V> mean;
  V variance, weight;

  explicit Gaussian(const float* at)
      : mean{hn::Load(DF(), at), hn::Load(DF(), at + kPixels), hn::Load(DF(), at + 2 * kPixels)},
        variance(hn::Load(DF(), at + 3 * kPixels)),
        weight(hn::Load(DF(), at + 4 * kPixels)) {}
  void Store(float* at) const {
    hn::Store(mean.c0, DF(), at);
    hn::Store(mean.c1, DF(), at + kPixels);
    hn::Store(mean.c2, DF(), at + 2 * kPixels);
    hn::Store(variance, DF(), at + 3 * kPixels);
    hn::Store(weight, DF(), at + 4 * kPixels);
  }
};

HWY_INLINE V Square(V x) { return hn::Mul(x, x); }

HWY_INLINE Color<V> Minus(const Color<V>& a, const Color<V>& b) {
  return {hn::Sub(a.c0, b.c0), hn::Sub(a.c1, b.c1), hn::Sub(a.c2, b.c2)};
}

/// ||x||^2, summed over the three channels.
HWY_INLINE V SquaredNorm(const Color<V>& x) {
  return hn::Add(hn::Add(Square(x.c0), Square(x.c1)), Square(x.c2));
}

/// eq. 4 and 5 by the differences from the old mean.
HWY_INLINE void Learn(const MixtureStep& step, const Color<V>& difference, V d_squared,
                      Gaussian& g) {
  const DF d;
  const V alpha = hn::Set(d, step.alpha);
  g.mean = {hn::Add(g.mean.c0, hn::Mul(alpha, difference.c0)),
            hn::Add(g.mean.c1, hn::Mul(alpha, difference.c1)),
            hn::Add(g.mean.c2, hn::Mul(alpha, difference.c2))};
  g.variance = hn::Max(hn::Add(g.variance, hn::Mul(alpha, hn::Sub(d_squared, g.variance))),
                       hn::Set(d, step.min_variance));
}

/// Where the fittest Gaussian stays the fittest whatever the others are: their weights sum to at
/// most 1 - w and no variance is below the floor, so that their fitness is at most
/// (1 - w) / sigma_min.
HWY_INLINE Lanes StaysFittest(const MixtureStep& step, const Gaussian& fittest) {
  const DF d;
  const V rest = hn::Sub(hn::Set(d, step.total), fittest.weight);
  return hn::Ge(hn::Mul(Square(fittest.weight), hn::Set(d, step.min_variance)),
                hn::Mul(Square(rest), fittest.variance));
}

/// The common case: every pixel matches its fittest Gaussian, which stays that. Touches nothing
/// else. False, and nothing done, in any other case.
HWY_INLINE bool StepFittest(const MixtureStep& step, const Color<V>& color, float* fittest) {
  const DF d;
  Gaussian g(fittest);
  const Color<V> difference = Minus(color, g.mean);
  const V d_squared = SquaredNorm(difference);
  const Lanes matched =
      hn::Lt(d_squared, hn::Mul(hn::Set(d, step.match_sigmas_squared), g.variance));
  g.weight = hn::Add(g.weight, hn::Set(d, step.increment));  // eq. 3
  Learn(step, difference, d_squared, g);
  if (!hn::AllTrue(d, hn::And(matched, StaysFittest(step, g)))) return false;
  g.Store(fittest);
  return true;
}

/// Swaps the Gaussians k - 1 and k of a pixel where the second is fitter (w_a / sigma_a
/// < w_b / sigma_b, without root and quotient); the slot follows. True when that was anywhere.
HWY_INLINE bool SwapIfFitter(Lanes sorted, int k, float* before, float* after, V& slot) {
  const DF d;
  const V va = hn::Load(d, before + 3 * kPixels);
  const V vb = hn::Load(d, after + 3 * kPixels);
  const V wa = hn::Load(d, before + 4 * kPixels);
  const V wb = hn::Load(d, after + 4 * kPixels);
  const Lanes fitter = hn::AndNot(sorted, hn::Lt(hn::Mul(Square(wa), vb), hn::Mul(Square(wb), va)));
  if (hn::AllFalse(d, fitter)) return false;
  for (int plane = 0; plane < GaussianBlock::kPlanes;
       ++plane, before += kPixels, after += kPixels) {
    const V a = hn::Load(d, before);
    const V b = hn::Load(d, after);
    hn::Store(hn::IfThenElse(fitter, b, a), d, before);
    hn::Store(hn::IfThenElse(fitter, a, b), d, after);
  }
  const V first = hn::Set(d, static_cast<float>(k - 1));
  const V second = hn::Set(d, static_cast<float>(k));
  const V moved = hn::IfThenElse(hn::Eq(slot, second), first,
                                 hn::IfThenElse(hn::Eq(slot, first), second, slot));
  slot = hn::IfThenElse(fitter, moved, slot);
  return true;
}

/// The whole step for any pixels; for those of the common case it gives the same bits. `slot`
/// becomes the Gaussian that took the colour. Returns where the pixels are foreground.
HWY_NOINLINE Lanes StepMixture(const MixtureStep& step, const Color<V>& color, Lanes held,
                               float* fittest, float* others, V& slot) {
  const DF d;
  const int count = step.gaussians;
  const auto at = [&](int k) {
    return k == 0 ? fittest : others + static_cast<std::size_t>(k - 1) * kBlockFloats;
  };

  V fitter = hn::Zero(d);  // weight of all Gaussians before the one that matches
  slot = hn::Set(d, static_cast<float>(count - 1));
  Lanes unmatched = hn::Eq(fitter, fitter);  // all
  for (int k = 0; k < count && !hn::AllFalse(d, unmatched); ++k) {
    const Gaussian g(at(k));
    const V reach = hn::Mul(hn::Set(d, step.match_sigmas_squared), g.variance);
    const Lanes near =
        hn::And(hn::Lt(SquaredNorm(Minus(color, g.mean)), reach), hn::Gt(g.weight, hn::Zero(d)));
    const Lanes match = hn::And(near, unmatched);
    slot = hn::IfThenElse(match, hn::Set(d, static_cast<float>(k)), slot);
    unmatched = hn::AndNot(match, unmatched);
    fitter = hn::Add(fitter, hn::IfThenElseZero(unmatched, g.weight));
  }
  // Among the first N of eq. 1: those before it do not exceed T yet (eq. 2, read the right way).
  const Lanes foreground = hn::Or(unmatched, hn::Gt(fitter, hn::Set(d, step.share)));
  const Lanes hold = hn::And(held, foreground);

  const V decay = hn::IfThenElse(hold, hn::Set(d, step.hold), hn::Set(d, step.decay));
  const V increment = hn::IfThenZeroElse(hold, hn::Set(d, step.increment));
  V total = hn::Zero(d);
  for (int k = 0; k < count; ++k) {
    Gaussian g(at(k));
    const Lanes here = hn::Eq(slot, hn::Set(d, static_cast<float>(k)));
    const Lanes match = hn::AndNot(unmatched, here);
    const Lanes replaced = hn::And(unmatched, here);
    g.weight = hn::Mul(g.weight, decay);
    g.weight = hn::IfThenZeroElse(hn::Lt(g.weight, hn::Set(d, step.forgotten)), g.weight);
    g.weight = hn::IfThenElse(match, hn::Add(g.weight, increment), g.weight);  // eq. 3
    g.weight = hn::IfThenElse(replaced, hn::Set(d, step.new_weight), g.weight);
    const Color<V> difference = Minus(color, g.mean);
    Gaussian learnt = g;
    Learn(step, difference, SquaredNorm(difference), learnt);
    const auto choose = [&](V old_value, V learnt_value, V new_value) {
      return hn::IfThenElse(replaced, new_value, hn::IfThenElse(match, learnt_value, old_value));
    };
    g.mean = {choose(g.mean.c0, learnt.mean.c0, color.c0),
              choose(g.mean.c1, learnt.mean.c1, color.c1),
              choose(g.mean.c2, learnt.mean.c2, color.c2)};
    g.variance = choose(g.variance, learnt.variance, hn::Set(d, step.initial_variance));
    g.Store(at(k));
    total = hn::Add(total, g.weight);
  }
  if (!hn::AllFalse(d, unmatched)) {  // their weights sum to 1 again
    for (int k = 0; k < count; ++k) {
      float* weight = at(k) + 4 * kPixels;
      const V w = hn::Load(d, weight);
      const V normal = hn::Div(hn::Mul(w, hn::Set(d, step.total)), total);
      hn::Store(hn::IfThenElse(unmatched, normal, w), d, weight);
    }
  }

  // Insertion sort, since at most one Gaussian has moved.
  const Lanes sorted = hn::And(hn::Eq(slot, hn::Zero(d)), StaysFittest(step, Gaussian(fittest)));
  for (int i = 1; i < count; ++i) {
    for (int k = i; k > 0 && SwapIfFitter(sorted, k, at(k - 1), at(k), slot); --k) {
    }
  }
  return foreground;
}

/// Lanes' numbers 0..255 as bytes.
HWY_INLINE void StoreBytes(V numbers, std::uint8_t* out) {
  hn::StoreU(hn::DemoteTo(DLevel(), hn::ConvertTo(DI(), numbers)), DLevel(), out);
}

/// Bytes as numbers of the lanes.
HWY_INLINE V LoadBytes(const std::uint8_t* in) {
  return hn::ConvertTo(DF(), hn::PromoteTo(DI(), hn::LoadU(DLevel(), in)));
}

/// The levels of the pixels of a tile, channel by channel.
HWY_INLINE void Deinterleave(const std::uint8_t* bgr, int pixels,
                             std::uint8_t (&levels)[3][kTilePixels]) {
  const HWY_CAPPED(std::uint8_t, kPixels) d;
  for (int x = 0; x < pixels; x += static_cast<int>(hn::Lanes(d))) {
    hn::Vec<decltype(d)> blue, green, red;
    hn::LoadInterleaved3(d, bgr + 3 * x, blue, green, red);
    hn::Store(blue, d, levels[0] + x);
    hn::Store(green, d, levels[1] + x);
    hn::Store(red, d, levels[2] + x);
  }
}

HWY_INLINE Color<V> LoadLevels(const std::uint8_t (&levels)[3][kTilePixels], int x) {
  return {LoadBytes(levels[0] + x), LoadBytes(levels[1] + x), LoadBytes(levels[2] + x)};
}

/// Steps whole blocks. `row` points to the first; its width is a multiple of 16.
template <bool kLuv>
HWY_INLINE void StepTile(const MixtureStep& step, const MixtureRow& row) {
  const DF d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  HWY_ALIGN std::uint8_t levels[3][kTilePixels];
  Deinterleave(row.bgr, row.width, levels);
  // A loop of their own lets the processor work on several vectors at once, which the long way to
  // L*u*v* needs.
  HWY_ALIGN float luv[3][kTilePixels];
  if constexpr (kLuv) {
    for (int x = 0; x < row.width; x += lanes) {
      const Color<V> color = LuvFromLevels(d, LoadLevels(levels, x));
      hn::Store(color.c0, d, luv[0] + x);
      hn::Store(color.c1, d, luv[1] + x);
      hn::Store(color.c2, d, luv[2] + x);
    }
  }
  for (int x = 0; x < row.width; x += lanes) {
    Color<V> color;
    if constexpr (kLuv) {
      color = {hn::Load(d, luv[0] + x), hn::Load(d, luv[1] + x), hn::Load(d, luv[2] + x)};
    } else {
      color = LoadLevels(levels, x);
    }
    const int block = x / kPixels;
    float* fittest = row.fittest[block].values + x % kPixels;
    V slot = hn::Zero(d);
    V foreground = hn::Zero(d);
    if (step.rescale || !StepFittest(step, color, fittest)) {
      const V held = row.held == nullptr ? hn::Zero(d) : LoadBytes(row.held + x);
      float* others = step.gaussians == 1
                          ? nullptr
                          : row.others[block * (step.gaussians - 1)].values + x % kPixels;
      const Lanes found =
          StepMixture(step, color, hn::Gt(held, hn::Zero(d)), fittest, others, slot);
      foreground = hn::IfThenElseZero(found, hn::Set(d, 255.0F));
    }
    StoreBytes(slot, row.slots + x);
    StoreBytes(foreground, row.mask + x);
  }
}

template <bool kLuv>
void StepRowIn(const MixtureStep& step, const MixtureRow& row) {
  for (int x = 0; x < row.width; x += kTilePixels) {
    const int pixels = std::min(kTilePixels, row.width - x);
    const int block = x / kPixels;
    MixtureRow tile = {.width = pixels,
                       .bgr = row.bgr + 3 * x,
                       .held = row.held == nullptr ? nullptr : row.held + x,
                       .fittest = row.fittest + block,
                       .others = row.others + block * (step.gaussians - 1),
                       .slots = row.slots + x,
                       .mask = row.mask + x};
    if (pixels % kPixels == 0) {
      StepTile<kLuv>(step, tile);
      continue;
    }
    // The last pixels of the row, black ones beside them.
    std::uint8_t bgr[3 * kTilePixels] = {};
    std::uint8_t held[kTilePixels] = {};
    std::uint8_t mask[kTilePixels];
    std::copy_n(tile.bgr, 3 * pixels, bgr);
    if (tile.held != nullptr) std::copy_n(tile.held, pixels, held);
    tile.width = (pixels + kPixels - 1) / kPixels * kPixels;
    tile.bgr = bgr;
    tile.held = held;
    tile.mask = mask;
    StepTile<kLuv>(step, tile);
    std::copy_n(mask, pixels, row.mask + x);
  }
}

void StepRowOnTarget(const MixtureStep& step, const MixtureRow& row) {
  (step.luv ? StepRowIn<true> : StepRowIn<false>)(step, row);
}

void MeansAsBgrOnTarget(const GaussianBlock& block, bool luv, std::uint8_t* bgr) {
  const DF d;
  const V half = hn::Set(d, 0.5F);
  std::uint8_t levels[3][kPixels];
  for (std::size_t i = 0; i < kPixels; i += hn::Lanes(d)) {
    const float* mean = block.values + i;
    Color<V> color = {hn::Load(d, mean), hn::Load(d, mean + kPixels),
                      hn::Load(d, mean + 2 * kPixels)};
    if (luv) color = LevelsFromLuv(d, color);
    StoreBytes(hn::Add(color.c0, half), levels[0] + i);
    StoreBytes(hn::Add(color.c1, half), levels[1] + i);
    StoreBytes(hn::Add(color.c2, half), levels[2] + i);
  }
  for (int i = 0; i < kPixels; ++i, bgr += 3) {
    for (int c = 0; c < 3; ++c) bgr[c] = levels[c][i];
  }
}

const char* NameOfTarget() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace vantage::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage {

HWY_EXPORT(StepRowOnTarget);
HWY_EXPORT(MeansAsBgrOnTarget);
HWY_EXPORT(NameOfTarget);

void StepRow(const MixtureStep& step, const MixtureRow& row) {
  HWY_DYNAMIC_DISPATCH(StepRowOnTarget)(step, row);
}

void MeansAsBgr(const GaussianBlock& block, bool luv, std::uint8_t* bgr) {
  HWY_DYNAMIC_DISPATCH(MeansAsBgrOnTarget)(block, luv, bgr);
}

const char* MixtureInstructionSet() { return HWY_DYNAMIC_DISPATCH(NameOfTarget)(); }

}  // namespace vantage
#endif  // HWY_ONCE
