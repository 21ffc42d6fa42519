// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/background/mixture.h"

/// For tests only: the mixture of Gaussians pixel by pixel, every weight decayed in every step.
/// Weights are doubles and compared as floats: under the modified rate the first ones are counts of
/// frames divided by t, often equal, and rounding must not choose between them.

namespace vantage::testing {

class PlainMixtureModel {
 public:
  PlainMixtureModel(ImageSize size, const MixtureOptions& options);

  /// As those of MixtureModel, unchecked.
  void Apply(const cv::Mat& bgr, cv::Mat& mask, const cv::Mat& held = {});
  void Absorb(const cv::Mat& pixels);
  void Restart() { learnt_frames_ = 0; }
  cv::Mat BackgroundImage() const;

 private:
  struct Gaussian {
    float mean[3];
    float variance;
    double weight;  ///< 0: not in use
  };

  Gaussian* MixtureAt(std::size_t pixel);
  void Fill(Gaussian* mixture, const float* color) const;
  bool Step(Gaussian* mixture, const float* color, double alpha, bool held,
            std::uint8_t& slot) const;
  void SortByFitness(Gaussian* mixture, std::uint8_t& slot) const;

  ImageSize size_;
  MixtureOptions options_;
  int learnt_frames_ = 0;
  std::vector<Gaussian> gaussians_;  ///< K in a row for each pixel, fittest first
  std::vector<std::uint8_t> slots_;
};

}  // namespace vantage::testing
