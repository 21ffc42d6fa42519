// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/sensor.h"

#include <algorithm>
#include <cmath>

#include "vantage/simulation/hash.h"

namespace vantage::simulation::internal {
namespace {

constexpr int kWhite = 3840;  // code of white: 15 for each of the 256 levels
constexpr int kLargest = 4095;
constexpr std::size_t kNoiseCount = 1U << 18;

/// Nearly normal, of standard deviation 1: the sum of eight uniform bytes.
float NoiseAt(std::uint64_t key) {
  const std::uint64_t bytes = Mix(key);
  int sum = 0;
  for (unsigned i = 0; i < 8; ++i) sum += static_cast<int>((bytes >> (8 * i)) & 0xffU);
  constexpr float kMean = 8 * 127.5F;
  constexpr float kDeviation = 209.02F;  // sqrt(8 (256^2 - 1) / 12)
  return (static_cast<float>(sum) - kMean) / kDeviation;
}

float SrgbCurve(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
}

}  // namespace

Sensor::Sensor(const StageCamera& camera, std::uint64_t seed, int index)
    : camera_(&camera),
      key_(Hash(seed, index)),
      gain_(static_cast<float>(camera.exposure) * camera.balance) {
  const ImageSize size = camera.camera.size();
  middle_px_ =
      Eigen::Vector2f(static_cast<float>(size.width - 1), static_cast<float>(size.height - 1)) / 2;
  corner_px2_ = std::max(1.0F, middle_px_.squaredNorm());
  curve_.resize(kLargest + 1);
  for (int code = 0; code <= kLargest; ++code) {
    const float root = static_cast<float>(code) / kWhite;
    curve_[static_cast<std::size_t>(code)] =
        static_cast<std::uint8_t>(std::lround(255 * std::min(1.0F, SrgbCurve(root * root))));
  }
  // Of a root the deviation is half of that of the light, at white. Neighbours share some of it, as
  // after a colour filter's interpolation.
  const float deviation = static_cast<float>(camera.noise) / 2 * kWhite;
  constexpr float kShared = 0.35F;
  const float own = deviation / std::sqrt(1 + kShared * kShared);
  noise_.resize(kNoiseCount);
  for (std::size_t i = 0; i < kNoiseCount; ++i) {
    const float noise = NoiseAt(key_ + i) + kShared * NoiseAt(key_ + i + 3);
    noise_[i] = static_cast<std::int16_t>(std::lround(std::clamp(own * noise, -4095.0F, 4095.0F)));
  }
}

LightCode Sensor::Expose(const Eigen::Vector3f& radiance, int x, int y) const {
  const Eigen::Vector2f from_middle =
      Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - middle_px_;
  const float dimming =
      1 - static_cast<float>(camera_->vignetting) * from_middle.squaredNorm() / corner_px2_;
  const Eigen::Vector3f light = dimming * radiance.cwiseProduct(gain_);
  LightCode code;
  for (std::size_t i = 0; i < 3; ++i) {
    const float root = std::sqrt(std::max(0.0F, light[static_cast<Eigen::Index>(2 - i)]));
    code[i] =
        static_cast<std::int16_t>(std::min(static_cast<float>(kLargest), root * kWhite + 0.5F));
  }
  return code;
}

void Sensor::ReadOut(const std::vector<LightCode>& codes, FrameIndex frame, int begin, int end,
                     cv::Mat& picture) const {
  const auto samples = static_cast<std::size_t>(picture.cols) * 3;
  for (int y = begin; y < end; ++y) {
    const std::int16_t* code =
        codes[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.cols)].data();
    auto* out = picture.ptr<std::uint8_t>(y);
    // Each row takes its noise from a place of the table of its own.
    std::size_t at = Hash(key_, frame, y) % kNoiseCount;
    std::size_t done = 0;
    while (done < samples) {
      const std::size_t count = std::min(samples - done, kNoiseCount - at);
      const std::int16_t* noise = noise_.data() + at;
      for (std::size_t i = 0; i < count; ++i) {
        const int noisy = std::clamp(code[done + i] + noise[i], 0, kLargest);
        out[done + i] = curve_[static_cast<std::size_t>(noisy)];
      }
      done += count;
      at = 0;
    }
  }
}

}  // namespace vantage::simulation::internal
