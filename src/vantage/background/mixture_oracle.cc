// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/mixture_oracle.h"

#include <algorithm>
#include <utility>

#include "vantage/background/color.h"

namespace vantage::testing {
namespace {

constexpr double kForgottenWeight = 1e-12;

float Squared(double sigma) { return static_cast<float>(sigma * sigma); }

}  // namespace

PlainMixtureModel::PlainMixtureModel(ImageSize size, const MixtureOptions& options)
    : size_(size), options_(options) {
  const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  gaussians_.resize(pixels * static_cast<std::size_t>(options.gaussians));
  slots_.resize(pixels);
}

void PlainMixtureModel::Apply(const cv::Mat& bgr, cv::Mat& mask, const cv::Mat& held) {
  mask.create(size_.height, size_.width, CV_8UC1);
  const double alpha = options_.rate == LearningRate::kModified
                           ? std::max(options_.alpha, 1.0 / (1 + learnt_frames_))  // eq. 6
                           : options_.alpha;
  const auto convert = options_.color == ColorSpace::kLuv ? LuvFromBgr : FloatFromBgr;
  std::vector<float> colors(3 * static_cast<std::size_t>(size_.width));
  std::size_t pixel = 0;
  for (int y = 0; y < size_.height; ++y) {
    convert(bgr.ptr(y), colors.data(), size_.width);
    const float* color = colors.data();
    for (int x = 0; x < size_.width; ++x, ++pixel, color += 3) {
      bool background = true;
      if (learnt_frames_ == 0) {
        Fill(MixtureAt(pixel), color);
        slots_[pixel] = 0;
      } else {
        const bool held_here = !held.empty() && held.at<std::uint8_t>(y, x) != 0;
        background = Step(MixtureAt(pixel), color, alpha, held_here, slots_[pixel]);
      }
      mask.at<std::uint8_t>(y, x) = background ? 0 : 255;
    }
  }
  ++learnt_frames_;
}

PlainMixtureModel::Gaussian* PlainMixtureModel::MixtureAt(std::size_t pixel) {
  return &gaussians_[pixel * static_cast<std::size_t>(options_.gaussians)];
}

/// The first frame fills the model, as a step with alpha' = 1 would.
void PlainMixtureModel::Fill(Gaussian* mixture, const float* color) const {
  const float variance = Squared(options_.sigma().initial);
  mixture[0] = {.mean = {color[0], color[1], color[2]}, .variance = variance, .weight = 1};
  for (int k = 1; k < options_.gaussians; ++k) {
    mixture[k] = {.mean = {}, .variance = variance, .weight = 0};
  }
}

/// True when the pixel is background. `slot` becomes the Gaussian that has taken the colour.
bool PlainMixtureModel::Step(Gaussian* mixture, const float* color, double rate, bool held,
                             std::uint8_t& slot) const {
  const int count = options_.gaussians;
  const float reach = Squared(options_.match_sigmas);
  int match = 0;        // the fittest Gaussian that matches
  float d_squared = 0;  // ||I - mu||^2, summed over the three channels
  double fitter = 0;    // weight of all fitter Gaussians
  for (; match < count && mixture[match].weight > 0; ++match) {
    const Gaussian& g = mixture[match];
    const float d0 = color[0] - g.mean[0];
    const float d1 = color[1] - g.mean[1];
    const float d2 = color[2] - g.mean[2];
    d_squared = d0 * d0 + d1 * d1 + d2 * d2;
    if (d_squared < reach * g.variance) break;
    fitter += g.weight;
  }
  const bool matched = match < count && mixture[match].weight > 0;
  // Among the first N of eq. 1: those before it do not exceed T yet (eq. 2, read the right way).
  const bool background =
      matched && static_cast<float>(fitter) <= static_cast<float>(options_.background_share);
  const double moved = held && !background ? 0 : rate;  // of the weights
  const auto alpha = static_cast<float>(rate);

  for (int k = 0; k < count; ++k) {
    double& weight = mixture[k].weight;
    weight = weight < kForgottenWeight ? 0 : (1 - moved) * weight;
  }
  if (matched) {
    Gaussian& g = mixture[match];
    g.weight += moved;                                                                   // eq. 3
    for (int c = 0; c < 3; ++c) g.mean[c] = (1 - alpha) * g.mean[c] + alpha * color[c];  // eq. 4
    g.variance = std::max((1 - alpha) * g.variance + alpha * d_squared,                  // eq. 5
                          Squared(options_.sigma().min));
  } else {
    match = count - 1;
    mixture[match] = {.mean = {color[0], color[1], color[2]},
                      .variance = Squared(options_.sigma().initial),
                      .weight = std::max(options_.initial_weight, rate)};
    double sum = 0;
    for (int k = 0; k < count; ++k) sum += mixture[k].weight;
    for (int k = 0; k < count; ++k) mixture[k].weight /= sum;
  }
  slot = static_cast<std::uint8_t>(match);
  SortByFitness(mixture, slot);
  return background;
}

/// Restores the order of fitness after a step, which moves one Gaussian; `slot` follows its own.
void PlainMixtureModel::SortByFitness(Gaussian* mixture, std::uint8_t& slot) const {
  const auto fitness = [](const Gaussian& g) {
    return static_cast<float>(g.weight * g.weight / g.variance);
  };
  for (int i = 1; i < options_.gaussians; ++i) {
    for (int k = i; k > 0 && fitness(mixture[k - 1]) < fitness(mixture[k]); --k) {
      std::swap(mixture[k - 1], mixture[k]);
      if (slot == k) {
        --slot;
      } else if (slot == k - 1) {
        ++slot;
      }
    }
  }
}

void PlainMixtureModel::Absorb(const cv::Mat& pixels) {
  const double beta = options_.absorb_weight;
  for (std::size_t pixel = 0; pixel < slots_.size(); ++pixel) {
    if (pixels.at<std::uint8_t>(static_cast<int>(pixel) / size_.width,
                                static_cast<int>(pixel) % size_.width) == 0) {
      continue;
    }
    Gaussian* mixture = MixtureAt(pixel);
    mixture[slots_[pixel]].weight += beta;  // eq. 17
    for (int k = 0; k < options_.gaussians; ++k) mixture[k].weight /= 1 + beta;
    SortByFitness(mixture, slots_[pixel]);
  }
}

cv::Mat PlainMixtureModel::BackgroundImage() const {
  cv::Mat image(size_.height, size_.width, CV_8UC3);
  const auto convert = options_.color == ColorSpace::kLuv ? BgrFromLuv : BgrFromFloat;
  for (std::size_t pixel = 0; pixel < slots_.size(); ++pixel) {
    convert(gaussians_[pixel * static_cast<std::size_t>(options_.gaussians)].mean,
            image.data + 3 * pixel, 1);
  }
  return image;
}

}  // namespace vantage::testing
