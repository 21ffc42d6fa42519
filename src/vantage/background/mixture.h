// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/background/mixture_kernel.h"
#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"

namespace vantage {

enum class ColorSpace {
  kLuv,  ///< CIE L*u*v*, L* in 0..100: distances are near to what the eye sees
  kRgb,  ///< levels 0..255
};

enum class LearningRate {
  kModified,  ///< alpha' = max(alpha, 1 / (1 + t)): a mean of the first frames (eq. 6)
  kOriginal,  ///< alpha' = alpha: the first frame is the background until it is outweighed
};

/// Standard deviations in one colour space's units. The one variance of a Gaussian follows d^2, the
/// squared distance summed over three channels: sigma is sqrt(3) times that of one channel.
struct SigmaOptions {
  double initial = 0;  ///< of a new Gaussian, >= min
  double min = 0;      ///< floor, > 0
};

/// Options of the mixture of Gaussians (algorithms.md section 1). The two colour spaces have
/// standard deviations of their own, so that either is ready whichever is chosen.
struct MixtureOptions {
  ColorSpace color = ColorSpace::kLuv;
  LearningRate rate = LearningRate::kModified;
  /// K, Gaussians per pixel, 1 <= gaussians <= 8.
  int gaussians = 3;
  /// Learning rate per frame, 0 < alpha <= 1. What stands still is background after about
  /// log(background_share) / log(1 - alpha) frames.
  double alpha = 0.002;
  /// T, the least prior probability of background, 0 < background_share < 1. At 0.5 people who
  /// stand for a while stay foreground twice as long as at the 0.7 of others; ghosts of what did
  /// fade are left to ghost detection.
  double background_share = 0.5;
  /// A Gaussian matches nearer than this many of its sigmas, > 0.
  double match_sigmas = 2.5;
  /// Weight of a new Gaussian, 0 < initial_weight < 1; alpha' where that is more.
  double initial_weight = 0.05;
  /// beta of eq. 17, > 0; at least 1 / background_share - 1, so that absorbed pixels are background
  /// in the next frame.
  double absorb_weight = 1;
  /// Units of L*.
  SigmaOptions luv{.initial = 15, .min = 5};
  /// Levels of 255.
  SigmaOptions rgb{.initial = 50, .min = 20};

  const SigmaOptions& sigma() const { return color == ColorSpace::kLuv ? luv : rgb; }
};
void VisitOptions(MixtureOptions& options, OptionVisitor& visitor);
/// Fields one by one, then the rules that join two of them.
Status Validate(const MixtureOptions& options);

/// Background model of one fixed camera: at each pixel a mixture of K Gaussians over a colour,
/// after Stauffer and Grimson (thesis 3.3.1). Its results are the same bits for every thread count
/// and every instruction set.
class MixtureModel {
 public:
  static Result<MixtureModel> Create(ImageSize size, const MixtureOptions& options);

  /// One step. `bgr` is CV_8UC3 of the model's size; `mask` becomes CV_8UC1 of that size, 255 where
  /// the pixel is foreground, else 0.
  ///
  /// `held` (CV_8UC1 of the model's size, or empty for none) is not 0 where an object is known to
  /// stand. What is foreground there takes part in matching, mean and variance, but the weights of
  /// its mixture neither grow nor decay, so that it does not fade into the background; a colour
  /// that matches nothing still replaces the least fit Gaussian. What is background there learns
  /// as everywhere.
  ///
  /// Fails on an empty frame and on matrices of another size or type; the model is then as before.
  Status Apply(const cv::Mat& bgr, cv::Mat& mask, int threads, const cv::Mat& held = {});

  /// Mean of the fittest Gaussian of each pixel (eq. 8) inside `region`, CV_8UC3 blue green red.
  /// Black before the first frame.
  cv::Mat BackgroundImage(const cv::Rect& region) const;
  cv::Mat BackgroundImage() const { return BackgroundImage({0, 0, size_.width, size_.height}); }

  /// Takes the colours that the last frame has where `pixels` (CV_8UC1 of the model's size) is not
  /// 0 for background from the next frame on (eq. 17).
  Status Absorb(const cv::Mat& pixels);

  /// After a sudden change of light: multiplies the mean of every Gaussian by the factors `gain`
  /// (CV_32FC3 of the model's size; blue, green, red; of 8-bit levels, which stay within [0, 255]),
  /// and its standard deviation by their mean where that is above 1.
  /// Fails on another size or type and on factors that are negative or not finite; the model is
  /// then as before.
  Status Relight(const cv::Mat& gain, int threads);

  /// The next frame fills the model anew, as the first one did; the modified rate starts again.
  void Restart() { learnt_frames_ = 0; }

  ImageSize size() const { return size_; }
  /// Frames applied.
  std::int64_t frames() const { return frames_; }

 private:
  MixtureModel() = default;
  int row_blocks() const;
  /// The Gaussian k of all pixels of a block; blocks are numbered row by row.
  GaussianBlock& BlockOf(std::size_t block, int k);
  MixtureStep NextStep();
  void FillRow(const std::uint8_t* bgr, int row);

  ImageSize size_;
  MixtureOptions options_;
  std::int64_t frames_ = 0;
  std::int64_t learnt_frames_ = 0;  ///< since the model was filled, that frame included
  double scale_ = 1;                ///< s of MixtureStep
  /// Rows are padded to whole blocks. A frame mostly touches the fittest Gaussians only: they are
  /// apart from the others, of which each block has K - 1 in falling order of fitness.
  std::vector<GaussianBlock> fittest_, others_;
  /// Which Gaussian took the last frame's colour, for each pixel of each block.
  std::vector<std::uint8_t> slots_;
};

}  // namespace vantage
