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

/// c0 + c1 x.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Line(D d, V x, float c0, float c1) {
  return hn::Add(hn::Set(d, c0), hn::Mul(hn::Set(d, c1), x));
}

/// Linear light of an sRGB level in 0..255, times a weight. The power 2.4 is a polynomial fitted at
/// the levels from 11: off by at most 1.4e-6, or 4e-6 of the value. By Estrin's scheme, since the
/// chain of Horner's would take longest here.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V LinearFromLevel(D d, V x, float weight) {
  const auto line = [&](float c0, float c1) { return Line(d, x, weight * c0, weight * c1); };
  const V x2 = hn::Mul(x, x);
  const V low = hn::Add(line(0.000869145446F, 0.000136192436F),
                        hn::Mul(x2, line(7.58513789e-06F, 4.89152708e-08F)));
  const V high = hn::Add(line(-1.61565493e-10F, 5.33860611e-13F),
                         hn::Mul(x2, line(-1.09819248e-15F, 9.92263937e-19F)));
  const V power = hn::Add(low, hn::Mul(hn::Mul(x2, x2), high));
  const V straight = hn::Mul(x, hn::Set(d, weight / (255 * 12.92F)));
  return hn::IfThenElse(hn::Le(x, hn::Set(d, 0.04045F * 255)), straight, power);
}

/// 116 cbrt(y) of y in [216/24389, 1], off by at most 7e-6 of the value.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V CubeRoot116(D d, V y) {
  // 1 / cbrt(y) within 3.5 %: a third of the bits of a float is a third of its logarithm.
  const hn::RebindToSigned<D> bits;
  const V third = hn::Mul(hn::ConvertTo(d, hn::BitCast(bits, y)), hn::Set(d, 1 / 3.0F));
  const V r = hn::BitCast(d, hn::Sub(hn::Set(bits, 0x54A20000), hn::ConvertTo(bits, third)));
  // cbrt(y) = y r^2 (1 - e)^(-2/3) with e = 1 - y r^3, where |e| < 0.103.
  const V root = hn::Mul(y, hn::Mul(r, r));
  const V e = hn::Sub(hn::Set(d, 1.0F), hn::Mul(root, r));
  const V power =
      hn::Add(Line(d, e, 116 * 0.999993778F, 116 * 0.666649177F),
              hn::Mul(hn::Mul(e, e), Line(d, e, 116 * 0.560316581F, 116 * 0.499395811F)));
  return hn::Mul(root, power);
}

/// CIE 1976 L*u*v* under D65, the white of sRGB, of levels 0..255.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Color<V> LuvFromLevels(D d, const Color<V>& bgr) {
  // What each channel adds to Y. X and X + 15 Y + 3 Z are weighted sums of these.
  constexpr float kYb = 0.0721750F;
  constexpr float kYg = 0.7151522F;
  constexpr float kYr = 0.2126729F;
  const V b = LinearFromLevel(d, bgr.c0, kYb);
  const V g = LinearFromLevel(d, bgr.c1, kYg);
  const V r = LinearFromLevel(d, bgr.c2, kYr);
  const auto weighted = [&](float of_b, float of_g, float of_r) {
    return hn::Add(hn::Add(hn::Mul(r, hn::Set(d, of_r / kYr)), hn::Mul(g, hn::Set(d, of_g / kYg))),
                   hn::Mul(b, hn::Set(d, of_b / kYb)));
  };
  const V y = hn::Add(hn::Add(r, g), b);
  const V curved = hn::Sub(CubeRoot116(d, y), hn::Set(d, 16.0F));
  const V straight = hn::Mul(y, hn::Set(d, 24389.0F / 27));
  const V l = hn::IfThenElse(hn::Gt(y, hn::Set(d, 216.0F / 24389)), curved, straight);
  // u* = 13 L* (4 X / sum - u'_n), v* = 13 L* (9 Y / sum - v'_n): all over 117 = 13 * 9.
  constexpr float kX = 52.0F / 117;
  const V x = weighted(kX * 0.1804375F, kX * 0.3575761F, kX * 0.4124564F);
  const V sum = weighted((0.1804375F + 15 * kYb + 3 * 0.9503041F) / 117,
                         (0.3575761F + 15 * kYg + 3 * 0.1191920F) / 117,
                         (0.4124564F + 15 * kYr + 3 * 0.0193339F) / 117);
  // Black has no chromaticity; L* = 0 makes u* and v* 0 whatever stands here.
  const V scale = hn::Div(hn::Set(d, 1.0F), hn::Max(sum, hn::Set(d, 1e-12F)));
  const V u = hn::Sub(hn::Mul(x, scale), hn::Set(d, 13 * 0.19783945F));
  const V v = hn::Sub(hn::Mul(y, scale), hn::Set(d, 13 * 0.46834203F));
  return {l, hn::Mul(l, u), hn::Mul(l, v)};
}

/// sRGB level in 0..255 of linear light, clipped, within 0.002.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V LevelFromLinear(D d, V linear) {
  const V x = hn::Min(hn::Max(linear, hn::Zero(d)), hn::Set(d, 1.0F));
  const V straight = hn::Mul(x, hn::Set(d, 255 * 12.92F));
  // The power 1 / 2.4 is s^(5/3) of the fourth root s: a polynomial.
  const V s = hn::Sqrt(hn::Sqrt(x));
  const V s2 = hn::Mul(s, s);
  const V power = hn::Add(hn::Add(Line(d, s, -15.6417485F, 41.3166425F),
                                  hn::Mul(s2, Line(d, s, 320.128295F, -147.258334F))),
                          hn::Mul(hn::Mul(s2, s2), Line(d, s, 73.8310663F, -17.3775961F)));
  return hn::IfThenElse(hn::Le(x, hn::Set(d, 0.0031308F)), straight,
                        hn::Min(power, hn::Set(d, 255.0F)));
}

/// Levels in 0..255, not rounded; colours outside sRGB are clipped.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Color<V> LevelsFromLuv(D d, const Color<V>& luv) {
  const V l = luv.c0;
  // Black (L* = 0) has no chromaticity: Y = 0 makes all 0 whatever stands here.
  const V inverse = hn::Div(hn::Set(d, 1 / 13.0F), hn::Max(l, hn::Set(d, 1e-9F)));
  const V u = hn::Add(hn::Mul(luv.c1, inverse), hn::Set(d, 0.19783945F));
  const V v =
      hn::Max(hn::Add(hn::Mul(luv.c2, inverse), hn::Set(d, 0.46834203F)), hn::Set(d, 1e-6F));
  const V root = hn::Mul(hn::Add(l, hn::Set(d, 16.0F)), hn::Set(d, 1 / 116.0F));
  const V y = hn::IfThenElse(hn::Gt(l, hn::Set(d, 8.0F)), hn::Mul(root, hn::Mul(root, root)),
                             hn::Mul(l, hn::Set(d, 27.0F / 24389)));
  const V scale = hn::Div(y, hn::Mul(v, hn::Set(d, 4.0F)));  // Y / (4 v')
  const V x = hn::Mul(scale, hn::Mul(u, hn::Set(d, 9.0F)));
  const V z = hn::Mul(scale, hn::Sub(hn::Sub(hn::Set(d, 12.0F), hn::Mul(u, hn::Set(d, 3.0F))),
                                     hn::Mul(v, hn::Set(d, 20.0F))));
  const auto level = [&](float of_x, float of_y, float of_z) {
    const V linear = hn::Add(hn::Add(hn::Mul(x, hn::Set(d, of_x)), hn::Mul(y, hn::Set(d, of_y))),
                             hn::Mul(z, hn::Set(d, of_z)));
    return LevelFromLinear(d, linear);
  };
  return {level(0.0556434F, -0.2040259F, 1.0572252F), level(-0.9692660F, 1.8760108F, 0.0415560F),
          level(3.2404542F, -1.5371385F, -0.4985314F)};
}

}  // namespace vantage::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
