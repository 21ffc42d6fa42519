// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/mixture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <new>
#include <opencv2/core.hpp>
#include <string_view>
#include <utility>

#include "vantage/background/color.h"
#include "vantage/base/parallel.h"

namespace vantage {
namespace {

constexpr int kMaxSide_px = 16384;
// Rows per task: fixed, so that the work is cut the same way for every thread count.
constexpr int kBlockRows = 16;
// Less is forgotten when the decay is written into the weights.
constexpr float kForgottenWeight = 1e-12F;
// That happens before s falls below this: every 2,760 frames at alpha = 0.005.
constexpr double kLeastScale = 1e-6;

void ForEachRow(int threads, int rows, const std::function<void(int)>& do_row) {
  ParallelFor(threads, (rows + kBlockRows - 1) / kBlockRows, [&](std::int64_t block) {
    const int begin = static_cast<int>(block) * kBlockRows;
    const int end = std::min(begin + kBlockRows, rows);
    for (int row = begin; row < end; ++row) do_row(row);
  });
}

/// Checks a matrix that comes with a frame; `what` starts the sentence.
Status CheckMatrix(const cv::Mat& matrix, ImageSize size, int type, std::string_view what) {
  if (matrix.type() == type && matrix.cols == size.width && matrix.rows == size.height) return {};
  return Fail("background: {} {}x{} px of type {}; they must be {}x{} px of type {}", what,
              matrix.cols, matrix.rows, cv::typeToString(matrix.type()), size.width, size.height,
              cv::typeToString(type));
}

/// w_a / sigma_a < w_b / sigma_b, without root and quotient.
bool LessFit(GaussianBlock& a, GaussianBlock& b, int pixel) {
  return a.weight(pixel) * a.weight(pixel) * b.variance(pixel) <
         b.weight(pixel) * b.weight(pixel) * a.variance(pixel);
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
  MixtureModel model;
  model.size_ = size;
  model.options_ = options;
  const auto blocks =
      static_cast<std::size_t>(model.row_blocks()) * static_cast<std::size_t>(size.height);
  try {
    model.fittest_.resize(blocks);
    model.others_.resize(blocks * static_cast<std::size_t>(options.gaussians - 1));
    model.slots_.resize(blocks * GaussianBlock::kPixels);
  } catch (const std::bad_alloc&) {
    return Fail(
        "background: not enough memory for {} Gaussians at each of {}x{} px; use smaller frames",
        options.gaussians, size.width, size.height);
  }
  return model;
}

Status MixtureModel::Apply(const cv::Mat& bgr, cv::Mat& mask, int threads, const cv::Mat& held) {
  if (bgr.empty()) return Fail("background: frame {} is empty", frames_);
  if (bgr.type() != CV_8UC3 || bgr.cols != size_.width || bgr.rows != size_.height) {
    return Fail(
        "background: frame {} is {}x{} px of type {}; it must be {}x{} px of 8-bit BGR (CV_8UC3)",
        frames_, bgr.cols, bgr.rows, cv::typeToString(bgr.type()), size_.width, size_.height);
  }
  if (!held.empty()) {
    VANTAGE_RETURN_IF_ERROR(CheckMatrix(held, size_, CV_8UC1, "the held pixels are"));
  }
  // `mask` may be the same object as either.
  const cv::Mat frame = bgr;
  const cv::Mat held_pixels = held;
  mask.create(size_.height, size_.width, CV_8UC1);
  const bool fill = learnt_frames_ == 0;
  if (fill) mask = 0;
  const MixtureStep step = NextStep();
  const auto do_row = [&](int row) {
    if (fill) return FillRow(frame.ptr(row), row);
    const std::size_t block =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(row_blocks());
    StepRow(step, {.width = size_.width,
                   .bgr = frame.ptr(row),
                   .held = held_pixels.empty() ? nullptr : held_pixels.ptr(row),
                   .fittest = &fittest_[block],
                   .others = step.gaussians > 1 ? &BlockOf(block, 1) : nullptr,
                   .slots = &slots_[block * GaussianBlock::kPixels],
                   .mask = mask.ptr(row)});
  };
  ForEachRow(threads, size_.height, do_row);
  ++frames_;
  ++learnt_frames_;
  return {};
}

/// Constants of the next step; moves the scale on.
MixtureStep MixtureModel::NextStep() {
  // eq. 6
  const double alpha =
      options_.rate == LearningRate::kModified
          ? std::max(options_.alpha, 1.0 / (1.0 + static_cast<double>(learnt_frames_)))
          : options_.alpha;
  const double before = scale_;
  const double decayed = (1 - alpha) * before;
  const bool rescale = learnt_frames_ > 0 && decayed < kLeastScale;
  scale_ = learnt_frames_ == 0 || rescale ? 1 : decayed;
  const auto squared = [](double sigma) { return static_cast<float>(sigma * sigma); };
  return {.gaussians = options_.gaussians,
          .luv = options_.color == ColorSpace::kLuv,
          .rescale = rescale,
          .alpha = static_cast<float>(alpha),
          .match_sigmas_squared = squared(options_.match_sigmas),
          .initial_variance = squared(options_.sigma().initial),
          .min_variance = squared(options_.sigma().min),
          .share = static_cast<float>(options_.background_share / before),
          .increment = static_cast<float>(alpha / scale_),
          .new_weight = static_cast<float>(std::max(options_.initial_weight, alpha) / scale_),
          .total = static_cast<float>(1 / scale_),
          .decay = rescale ? static_cast<float>(decayed) : 1,
          .hold = static_cast<float>(before / scale_),
          .forgotten = rescale ? kForgottenWeight : 0};
}

/// The first frame fills the model, as a step with alpha' = 1 would.
void MixtureModel::FillRow(const std::uint8_t* bgr, int row) {
  constexpr int kPixels = GaussianBlock::kPixels;
  const std::size_t width = static_cast<std::size_t>(row_blocks()) * kPixels;
  std::vector<float> colors(3 * width);  // those of the padding stay black
  (options_.color == ColorSpace::kLuv ? LuvFromBgr : FloatFromBgr)(bgr, colors.data(), size_.width);
  const double sigma = options_.sigma().initial;
  const auto variance = static_cast<float>(sigma * sigma);
  std::size_t block = static_cast<std::size_t>(row) * static_cast<std::size_t>(row_blocks());
  std::fill_n(slots_.begin() + static_cast<std::ptrdiff_t>(block * kPixels), width, 0);
  const float* color = colors.data();
  for (std::size_t x = 0; x < width; x += kPixels, ++block) {
    for (int k = 0; k < options_.gaussians; ++k) {
      GaussianBlock& g = BlockOf(block, k);
      g = {};
      for (int i = 0; i < kPixels; ++i) g.variance(i) = variance;
    }
    GaussianBlock& g = fittest_[block];
    for (int i = 0; i < kPixels; ++i, color += 3) {
      for (int c = 0; c < 3; ++c) g.mean(i)[c * kPixels] = color[c];
      g.weight(i) = 1;
    }
  }
}

cv::Mat MixtureModel::BackgroundImage(const cv::Rect& region) const {
  constexpr int kPixels = GaussianBlock::kPixels;
  const cv::Rect inside = region & cv::Rect(0, 0, size_.width, size_.height);
  cv::Mat image(inside.height, inside.width, CV_8UC3);
  const int right = inside.x + inside.width;
  for (int y = 0; y < inside.height; ++y) {
    const std::size_t start =
        static_cast<std::size_t>(inside.y + y) * static_cast<std::size_t>(row_blocks());
    std::uint8_t* out = image.ptr(y);
    for (int x = inside.x; x < right;) {
      const int block = x / kPixels;
      const int end = std::min((block + 1) * kPixels, right);
      std::uint8_t bgr[3 * kPixels];
      MeansAsBgr(fittest_[start + static_cast<std::size_t>(block)],
                 options_.color == ColorSpace::kLuv, bgr);
      out = std::copy_n(bgr + 3 * (x % kPixels), 3 * (end - x), out);
      x = end;
    }
  }
  return image;
}

Status MixtureModel::Absorb(const cv::Mat& pixels) {
  VANTAGE_RETURN_IF_ERROR(CheckMatrix(pixels, size_, CV_8UC1, "the pixels to absorb are"));
  if (learnt_frames_ == 0) return {};
  constexpr int kPixels = GaussianBlock::kPixels;
  constexpr int kValues = GaussianBlock::kPlanes * kPixels;
  const auto beta = static_cast<float>(options_.absorb_weight);
  const auto added = static_cast<float>(options_.absorb_weight / scale_);
  for (int y = 0; y < size_.height; ++y) {
    if (cv::countNonZero(pixels.row(y)) == 0) continue;  // most rows, and much faster so
    const std::uint8_t* chosen = pixels.ptr(y);
    for (int x = 0; x < size_.width; ++x) {
      if (chosen[x] == 0) continue;
      const std::size_t block =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(row_blocks()) +
          static_cast<std::size_t>(x / kPixels);
      const int pixel = x % kPixels;
      std::uint8_t& slot = slots_[block * kPixels + static_cast<std::size_t>(pixel)];
      // eq. 17; the sum stays 1 (eq. 18).
      BlockOf(block, slot).weight(pixel) += added;
      for (int k = 0; k < options_.gaussians; ++k) BlockOf(block, k).weight(pixel) /= 1 + beta;
      for (; slot > 0; --slot) {
        GaussianBlock& a = BlockOf(block, slot - 1);
        GaussianBlock& b = BlockOf(block, slot);
        if (!LessFit(a, b, pixel)) break;
        for (int i = pixel; i < kValues; i += kPixels) std::swap(a.values[i], b.values[i]);
      }
    }
  }
  return {};
}

Status MixtureModel::Relight(const cv::Mat& gain, int threads) {
  VANTAGE_RETURN_IF_ERROR(CheckMatrix(gain, size_, CV_32FC3, "the factors of the light are"));
  for (int y = 0; y < size_.height; ++y) {
    const float* factors = gain.ptr<float>(y);
    for (int i = 0; i < 3 * size_.width; ++i) {
      if (!(factors[i] >= 0) || std::isinf(factors[i])) {
        return Fail("background: the light at ({}, {}) is multiplied by {}; it must be at least 0",
                    i / 3, y, factors[i]);
      }
    }
  }
  constexpr int kPixels = GaussianBlock::kPixels;
  const bool luv = options_.color == ColorSpace::kLuv;
  ForEachRow(threads, size_.height, [&](int y) {
    const float* factors = gain.ptr<float>(y);
    for (int x = 0; x < size_.width; ++x, factors += 3) {
      const float brighter = std::max(1.0F, (factors[0] + factors[1] + factors[2]) / 3);
      const std::size_t block =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(row_blocks()) +
          static_cast<std::size_t>(x / kPixels);
      for (int k = 0; k < options_.gaussians; ++k) {
        GaussianBlock& g = BlockOf(block, k);
        if (g.weight(x % kPixels) == 0) continue;
        float* mean = g.mean(x % kPixels);
        std::array<float, 3> color = {mean[0], mean[kPixels], mean[2 * kPixels]};
        if (luv) color = LevelsFromLuv(color);
        for (std::size_t c = 0; c < 3; ++c) {
          color[c] = std::clamp(color[c] * factors[c], 0.0F, 255.0F);
        }
        if (luv) color = LuvFromLevels(color);
        for (std::size_t c = 0; c < 3; ++c) mean[c * kPixels] = color[c];
        // More light multiplies the noise too. The same factor for all: their order stays.
        g.variance(x % kPixels) *= brighter * brighter;
      }
    }
  });
  return {};
}

int MixtureModel::row_blocks() const {
  return (size_.width + GaussianBlock::kPixels - 1) / GaussianBlock::kPixels;
}

GaussianBlock& MixtureModel::BlockOf(std::size_t block, int k) {
  if (k == 0) return fittest_[block];
  return others_[block * static_cast<std::size_t>(options_.gaussians - 1) +
                 static_cast<std::size_t>(k - 1)];
}

}  // namespace vantage
