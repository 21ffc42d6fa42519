// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/mixture.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <utility>

#include "vantage/background/color.h"
#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr int kMaxSide_px = 16384;
// Rows per task: fixed, so that the work is cut the same way for every thread count.
constexpr int kBlockRows = 8;
// A weight that decays unseen would end as a denormal number, on which arithmetic is slow.
constexpr float kForgottenWeight = 1e-12F;

/// w_a / sigma_a < w_b / sigma_b, without root and quotient.
template <class Gaussian>
bool LessFit(const Gaussian& a, const Gaussian& b) {
  return a.weight * a.weight * b.variance < b.weight * b.weight * a.variance;
}

/// Restores the order of fitness after a step, which moves one Gaussian; `slot` follows its own.
template <class Gaussian>
void SortByFitness(Gaussian* mixture, int count, std::uint8_t& slot) {
  for (int i = 1; i < count; ++i) {
    for (int k = i; k > 0 && LessFit(mixture[k - 1], mixture[k]); --k) {
      std::swap(mixture[k - 1], mixture[k]);
      if (slot == k) {
        --slot;
      } else if (slot == k - 1) {
        ++slot;
      }
    }
  }
}

}  // namespace

void VisitOptions(MixtureOptions& o, OptionVisitor& v) {
  v.Choice({"color", "", "colour space of the model"}, o.color,
           {{"luv", ColorSpace::kLuv}, {"rgb", ColorSpace::kRgb}});
  v.Choice({"rate", "", "learning rate: modified starts at 1 and falls to alpha"}, o.rate,
           {{"modified", LearningRate::kModified}, {"original", LearningRate::kOriginal}});
  v.Number({"gaussians", "", "Gaussians per pixel"}, o.gaussians, Range::Between(1, 8));
  v.Number({"alpha", "", "learning rate per frame"}, o.alpha, Range::AboveUpTo(0, 1));
  v.Number({"background_share", "", "least prior probability of background"}, o.background_share,
           Range::Inside(0, 1));
  v.Number({"match_sigmas", "", "standard deviations within which a colour matches"},
           o.match_sigmas, Range::Above(0));
  v.Number({"initial_weight", "", "weight of a new Gaussian"}, o.initial_weight,
           Range::Inside(0, 1));
  v.Number({"absorb_weight", "", "weight that absorbing a ghost adds, beta"}, o.absorb_weight,
           Range::Above(0));
  v.Number({"luv_initial_sigma", "L*", "standard deviation of a new Gaussian when color is luv"},
           o.luv.initial, Range::AboveUpTo(0, 1000));
  v.Number({"luv_min_sigma", "L*", "least standard deviation when color is luv"}, o.luv.min,
           Range::AboveUpTo(0, 1000));
  v.Number(
      {"rgb_initial_sigma", "levels", "standard deviation of a new Gaussian when color is rgb"},
      o.rgb.initial, Range::AboveUpTo(0, 1000));
  v.Number({"rgb_min_sigma", "levels", "least standard deviation when color is rgb"}, o.rgb.min,
           Range::AboveUpTo(0, 1000));
}

Status Validate(const MixtureOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "background"));
  const double least = 1 / options.background_share - 1;
  if (options.absorb_weight < least) {
    return Fail(
        "background.absorb_weight is {}; it must be at least 1 / background_share - 1 = {:.3g}",
        options.absorb_weight, least);
  }
  if (options.sigma().initial < options.sigma().min) {
    const std::string_view color = options.color == ColorSpace::kLuv ? "luv" : "rgb";
    return Fail("background.{}_initial_sigma is {}; it must be at least {}_min_sigma = {}", color,
                options.sigma().initial, color, options.sigma().min);
  }
  return {};
}

Result<MixtureModel> MixtureModel::Create(ImageSize size, const MixtureOptions& options) {
  VANTAGE_RETURN_IF_ERROR(Validate(options));
  if (size.width < 1 || size.height < 1 || size.width > kMaxSide_px || size.height > kMaxSide_px) {
    return Fail("background: frames of {}x{} px; each side must be between 1 and {} px", size.width,
                size.height, kMaxSide_px);
  }
  const auto squared = [](double sigma) { return static_cast<float>(sigma * sigma); };
  MixtureModel model;
  model.size_ = size;
  model.options_ = options;
  model.constants_ = {.gaussians = options.gaussians,
                      .background_share = static_cast<float>(options.background_share),
                      .match_sigmas_squared = squared(options.match_sigmas),
                      .initial_weight = static_cast<float>(options.initial_weight),
                      .initial_variance = squared(options.sigma().initial),
                      .min_variance = squared(options.sigma().min),
                      .absorb_weight = static_cast<float>(options.absorb_weight)};
  const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  try {
    model.gaussians_.resize(pixels * static_cast<std::size_t>(options.gaussians));
    model.slots_.resize(pixels);
  } catch (const std::bad_alloc&) {
    return Fail(
        "background: not enough memory for {} Gaussians at each of {}x{} px; use smaller frames",
        options.gaussians, size.width, size.height);
  }
  return model;
}

Status MixtureModel::Apply(const cv::Mat& bgr, cv::Mat& mask, int threads) {
  if (bgr.empty()) return Fail("background: frame {} is empty", frames_);
  if (bgr.type() != CV_8UC3 || bgr.cols != size_.width || bgr.rows != size_.height) {
    return Fail(
        "background: frame {} is {}x{} px of type {}; it must be {}x{} px of 8-bit BGR (CV_8UC3)",
        frames_, bgr.cols, bgr.rows, cv::typeToString(bgr.type()), size_.width, size_.height);
  }
  const cv::Mat frame = bgr;  // `mask` may be the same object
  mask.create(size_.height, size_.width, CV_8UC1);
  const bool first = frames_ == 0;
  // eq. 6
  const double alpha = options_.rate == LearningRate::kModified
                           ? std::max(options_.alpha, 1.0 / (1.0 + static_cast<double>(frames_)))
                           : options_.alpha;
  const auto convert = options_.color == ColorSpace::kLuv ? LuvFromBgr : FloatFromBgr;
  const auto do_row = [&](int row, float* colors) {
    convert(frame.ptr(row), colors, size_.width);
    std::uint8_t* out = mask.ptr(row);
    const std::size_t start = static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.width);
    Gaussian* mixture = &gaussians_[start * static_cast<std::size_t>(constants_.gaussians)];
    for (int x = 0; x < size_.width; ++x, mixture += constants_.gaussians, colors += 3) {
      if (first) {
        FillPixel(mixture, colors);
        out[x] = 0;
      } else {
        std::uint8_t& slot = slots_[start + static_cast<std::size_t>(x)];
        out[x] = StepPixel(mixture, colors, static_cast<float>(alpha), slot) ? 0 : 255;
      }
    }
  };
  ParallelFor(threads, (size_.height + kBlockRows - 1) / kBlockRows, [&](std::int64_t block) {
    std::vector<float> colors(3 * static_cast<std::size_t>(size_.width));
    const int begin = static_cast<int>(block) * kBlockRows;
    const int end = std::min(begin + kBlockRows, size_.height);
    for (int row = begin; row < end; ++row) do_row(row, colors.data());
  });
  ++frames_;
  return {};
}

/// The first frame fills the model, as a step with alpha' = 1 would.
void MixtureModel::FillPixel(Gaussian* mixture, const float* color) const {
  mixture[0] = {
      .mean = {color[0], color[1], color[2]}, .variance = constants_.initial_variance, .weight = 1};
  for (int k = 1; k < constants_.gaussians; ++k) {
    mixture[k] = {.mean = {}, .variance = constants_.initial_variance, .weight = 0};
  }
}

/// True when the pixel is background. `slot` becomes the Gaussian that has taken the colour.
bool MixtureModel::StepPixel(Gaussian* mixture, const float* color, float alpha,
                             std::uint8_t& slot) const {
  const int count = constants_.gaussians;
  int match = 0;        // the fittest Gaussian that matches
  float d_squared = 0;  // ||I - mu||^2, summed over the three channels
  float fitter = 0;     // weight of all fitter Gaussians
  for (; match < count && mixture[match].weight > 0; ++match) {
    const Gaussian& g = mixture[match];
    const float d0 = color[0] - g.mean[0];
    const float d1 = color[1] - g.mean[1];
    const float d2 = color[2] - g.mean[2];
    d_squared = d0 * d0 + d1 * d1 + d2 * d2;
    if (d_squared < constants_.match_sigmas_squared * g.variance) break;
    fitter += g.weight;
  }
  const bool matched = match < count && mixture[match].weight > 0;
  // Among the first N of eq. 1: those before it do not exceed T yet (eq. 2, read the right way).
  const bool background = matched && fitter <= constants_.background_share;

  for (int k = 0; k < count; ++k) {
    float& weight = mixture[k].weight;
    weight = weight < kForgottenWeight ? 0 : (1 - alpha) * weight;
  }
  if (matched) {
    Gaussian& g = mixture[match];
    g.weight += alpha;                                                                   // eq. 3
    for (int c = 0; c < 3; ++c) g.mean[c] = (1 - alpha) * g.mean[c] + alpha * color[c];  // eq. 4
    g.variance = std::max((1 - alpha) * g.variance + alpha * d_squared,                  // eq. 5
                          constants_.min_variance);
  } else {
    match = count - 1;
    mixture[match] = {.mean = {color[0], color[1], color[2]},
                      .variance = constants_.initial_variance,
                      .weight = std::max(constants_.initial_weight, alpha)};
    float sum = 0;
    for (int k = 0; k < count; ++k) sum += mixture[k].weight;
    for (int k = 0; k < count; ++k) mixture[k].weight /= sum;
  }
  slot = static_cast<std::uint8_t>(match);
  SortByFitness(mixture, count, slot);
  return background;
}

cv::Mat MixtureModel::BackgroundImage(const cv::Rect& region) const {
  const cv::Rect inside = region & cv::Rect(0, 0, size_.width, size_.height);
  cv::Mat image(inside.height, inside.width, CV_8UC3);
  const auto convert = options_.color == ColorSpace::kLuv ? BgrFromLuv : BgrFromFloat;
  for (int y = 0; y < inside.height; ++y) {
    const std::size_t start =
        static_cast<std::size_t>(inside.y + y) * static_cast<std::size_t>(size_.width) +
        static_cast<std::size_t>(inside.x);
    const Gaussian* mixture = &gaussians_[start * static_cast<std::size_t>(constants_.gaussians)];
    for (int x = 0; x < inside.width; ++x, mixture += constants_.gaussians) {
      convert(mixture->mean, image.ptr(y, x), 1);
    }
  }
  return image;
}

Status MixtureModel::Absorb(const cv::Mat& pixels) {
  if (pixels.type() != CV_8UC1 || pixels.cols != size_.width || pixels.rows != size_.height) {
    return Fail(
        "background: the pixels to absorb are {}x{} px of type {}; they must be {}x{} px of "
        "type CV_8UC1",
        pixels.cols, pixels.rows, cv::typeToString(pixels.type()), size_.width, size_.height);
  }
  if (frames_ == 0) return {};
  const float beta = constants_.absorb_weight;
  std::size_t pixel = 0;
  for (int y = 0; y < size_.height; ++y) {
    const std::uint8_t* chosen = pixels.ptr(y);
    for (int x = 0; x < size_.width; ++x, ++pixel) {
      if (chosen[x] == 0) continue;
      Gaussian* mixture = &gaussians_[pixel * static_cast<std::size_t>(constants_.gaussians)];
      std::uint8_t& slot = slots_[pixel];
      // eq. 17; the sum stays 1 (eq. 18).
      mixture[slot].weight += beta;
      for (int k = 0; k < constants_.gaussians; ++k) mixture[k].weight /= 1 + beta;
      SortByFitness(mixture, constants_.gaussians, slot);
    }
  }
  return {};
}

}  // namespace vantage
