// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>

namespace vantage {

/// Every `step_px`-th pixel of every `step_px`-th row of an 8-bit picture, from step_px / 2 on; of
/// the picture's type. 1 <= step_px; a picture has at least one sample where its smaller side is at
/// least step_px.
cv::Mat SamplePixels(const cv::Mat& picture, int step_px);

/// What a change of the light makes of a background picture B, per channel:
///   I(x) = s(x) (a B(x) + b),
/// one gain a and offset b for the picture and a smooth field s for light from one side.
struct LightChange {
  std::array<double, 3> gain = {1, 1, 1};    ///< a of blue, green, red
  std::array<double, 3> offset = {0, 0, 0};  ///< b, levels
  cv::Mat field;                             ///< s, CV_32FC3, one value per block of samples
  double factor = 1;                         ///< median of I / B over blocks, mean of the channels
  double explained = 0;                      ///< share of the samples near s (a B + b)
  /// Share of the samples that are foreground, near s (a B + b) and not near B: the foreground that
  /// is nothing but light.
  double lit = 0;
  double changed = 0;  ///< share of blocks where the light changed the level of a channel
  /// Median over textured blocks of the correlation of frame and background inside a block: near 1
  /// when the same things are seen in another light. 1 where nothing is textured.
  double structure = 0;

  /// The level of `channel` where the background has `level` and s is `light`, clipped to 0..255.
  double Predict(double light, int channel, double level) const;
};

/// The light's change between the samples of a background and of a frame, both CV_8UC3 of one size.
/// `foreground` (CV_8UC1) are the samples of the frame's mask. Samples where `ignored` (CV_8UC1, or
/// empty: none) is not 0 say nothing about the light: people seen just before. Others are outvoted
/// as long as the background shows in most of the picture. Everything is 0 where fewer than a tenth
/// of the samples can be used.
LightChange EstimateLightChange(const cv::Mat& frame, const cv::Mat& background,
                                const cv::Mat& foreground, const cv::Mat& ignored);

/// I(x) / B(x) of each pixel, CV_32FC3 of the size of `background` (CV_8UC3): what the background's
/// levels must be multiplied by. Between 1/32 and 32; levels do not leave 0..255.
cv::Mat GainPicture(const LightChange& change, const cv::Mat& background);

}  // namespace vantage
