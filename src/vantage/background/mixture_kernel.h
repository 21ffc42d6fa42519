// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace vantage {

/// One Gaussian of each of 16 pixels side by side: whole cache lines for every instruction set.
struct alignas(64) GaussianBlock {
  static constexpr int kPixels = 16;
  static constexpr int kPlanes = 5;  ///< mean (3), variance, weight
  float values[kPlanes * kPixels];

  float* mean(int pixel) { return &values[pixel]; }  ///< of the channel c: [c * kPixels]
  const float* mean(int pixel) const { return &values[pixel]; }
  float& variance(int pixel) { return values[3 * kPixels + pixel]; }
  /// w / s, see MixtureStep; 0: not in use.
  float& weight(int pixel) { return values[4 * kPixels + pixel]; }
};

/// What is the same for all pixels in one step of the mixture (algorithms.md section 1).
///
/// Decay is lazy: the true weight of a Gaussian is w = s * weight with one scale s for the whole
/// model. A frame multiplies s by 1 - alpha' and adds alpha' / s to the Gaussian that matches, so
/// that the others are not touched. Before s gets too small, one frame writes the decay into all
/// weights and s starts again at 1.
struct MixtureStep {
  int gaussians;
  bool luv;      ///< else levels
  bool rescale;  ///< the decay is written: every Gaussian is visited
  float alpha;   ///< alpha' of eq. 6
  float match_sigmas_squared, initial_variance, min_variance;
  /// T / s, with s from before this step.
  float share;
  /// alpha' / s, the new Gaussian's weight / s and 1 / s, with s from after this step.
  float increment, new_weight, total;
  /// What makes weights of before into those after, where weights decay and where they are held.
  float decay, hold;
  /// Weights less than this end: they would become denormal numbers, on which arithmetic is slow.
  float forgotten;
};

/// One row. `fittest` has a block for each 16 pixels, `others` K - 1 of them for each 16 in falling
/// order of fitness; `slots` has a byte for each pixel of these blocks.
struct MixtureRow {
  int width;
  const std::uint8_t* bgr;
  const std::uint8_t* held;  ///< null: none
  GaussianBlock* fittest;
  GaussianBlock* others;
  std::uint8_t* slots;  ///< becomes which Gaussian took the colour
  std::uint8_t* mask;   ///< becomes 255 in foreground, else 0
};

/// Steps each pixel of a row. What becomes of a pixel depends neither on its neighbours nor on the
/// instruction set: every target of Highway gives the same bits.
void StepRow(const MixtureStep& step, const MixtureRow& row);

/// Means of a block's Gaussians as 8-bit blue green red, 3 bytes a pixel; the same bits on every
/// target.
void MeansAsBgr(const GaussianBlock& block, bool luv, std::uint8_t* bgr);

/// Highway's name of the instruction set that StepRow takes here, e.g. "AVX3" for AVX-512.
const char* MixtureInstructionSet();

}  // namespace vantage
