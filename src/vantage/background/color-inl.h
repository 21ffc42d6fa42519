// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT

// The colour spaces of the background model on vectors of Highway, compiled once for each
// instruction set. Only operations that IEEE 754 defines to the bit, never fused and never
// approximate, so that every instruction set gives the same bits.

// Per-target include guard.
#if defined(VANTAGE_BACKGROUND_COLOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_BACKGROUND_COLOR_INL_H_
#undef VANTAGE_BACKGROUND_COLOR_INL_H_
#else
#define VANTAGE_BACKGROUND_COLOR_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vantage::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Three channels of as many pixels as a vector has lanes.
template <class V>
struct Color {
  V c0, c1, c2;
};

/// Polynomial in x, the highest coefficient first.
template <class D, class V = hn::Vec<D>, class... Rest>
HWY_INLINE V Polynomial(D d, V x, float highest, Rest... rest) {
  V sum = hn::Set(d, highest);
  ((sum = hn::Add(hn::Mul(sum, x), hn::Set(d, rest))), ...);
  return sum;
}

/// Linear light of an sRGB value in [0, 1]. The power 2.4 is a polynomial fitted at the levels
/// 11..255 of 8 bits: off by at most 1.4e-6, or 4e-6 of the value.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V LinearFromSrgb(D d, V x) {
  const V power = Polynomial(d, x, 0.0695678322F, -0.301939233F, 0.575610598F, -0.683139395F,
                             0.811082448F, 0.493223591F, 0.0347290713F, 0.000869145446F);
  const V line = hn::Mul(x, hn::Set(d, 1 / 12.92F));
  return hn::IfThenElse(hn::Le(x, hn::Set(d, 0.04045F)), line, power);
}

/// Cube root of y in [216/24389, 1], off by at most 7e-6 of the value.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V CubeRoot(D d, V y) {
  // 1 / cbrt(y) within 3.5 %: a third of the bits of a float is a third of its logarithm.
  const hn::RebindToSigned<D> bits;
  const V third = hn::Mul(hn::ConvertTo(d, hn::BitCast(bits, y)), hn::Set(d, 1 / 3.0F));
  const V r = hn::BitCast(d, hn::Sub(hn::Set(bits, 0x54A20000), hn::ConvertTo(bits, third)));
  // cbrt(y) = y r^2 (1 - e)^(-2/3) with e = 1 - y r^3, where |e| < 0.103.
  const V square = hn::Mul(y, hn::Mul(r, r));
  const V e = hn::Sub(hn::Set(d, 1.0F), hn::Mul(square, r));
  return hn::Mul(square, Polynomial(d, e, 0.499395811F, 0.560316581F, 0.666649177F, 0.999993778F));
}

/// CIE 1976 L*u*v* under D65 of levels 0..255.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Color<V> LuvFromLevels(D d, const Color<V>& bgr) {
  const V unit = hn::Set(d, 1 / 255.0F);
  const V b = LinearFromSrgb(d, hn::Mul(bgr.c0, unit));
  const V g = LinearFromSrgb(d, hn::Mul(bgr.c1, unit));
  const V r = LinearFromSrgb(d, hn::Mul(bgr.c2, unit));
  const auto weighted = [&](float of_r, float of_g, float of_b) {
    return hn::Add(hn::Add(hn::Mul(r, hn::Set(d, of_r)), hn::Mul(g, hn::Set(d, of_g))),
                   hn::Mul(b, hn::Set(d, of_b)));
  };
  // 52 X, Y and X + 15 Y + 3 Z.
  const V x52 = weighted(52 * 0.4124564F, 52 * 0.3575761F, 52 * 0.1804375F);
  const V y = weighted(0.2126729F, 0.7151522F, 0.0721750F);
  const V sum = weighted(0.4124564F + 15 * 0.2126729F + 3 * 0.0193339F,
                         0.3575761F + 15 * 0.7151522F + 3 * 0.1191920F,
                         0.1804375F + 15 * 0.0721750F + 3 * 0.9503041F);
  const V curved = hn::Sub(hn::Mul(CubeRoot(d, y), hn::Set(d, 116.0F)), hn::Set(d, 16.0F));
  const V line = hn::Mul(y, hn::Set(d, 24389.0F / 27));
  const V l = hn::IfThenElse(hn::Gt(y, hn::Set(d, 216.0F / 24389)), curved, line);
  // Black has no chromaticity; L* = 0 makes u* and v* 0 whatever stands here.
  const V scale = hn::Div(hn::Set(d, 1.0F), hn::Max(sum, hn::Set(d, 1e-12F)));
  // u* = 13 L* (4 X / sum - u'_n), v* = 13 L* (9 Y / sum - v'_n); D65 is the white of sRGB.
  const V u = hn::Sub(hn::Mul(x52, scale), hn::Set(d, 13 * 0.19783945F));
  const V v = hn::Sub(hn::Mul(hn::Mul(y, hn::Set(d, 117.0F)), scale), hn::Set(d, 13 * 0.46834203F));
  return {l, hn::Mul(l, u), hn::Mul(l, v)};
}

}  // namespace vantage::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
