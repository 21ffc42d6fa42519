// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/simulation/stage.h"

/// Internal to the simulation module: from radiance to the numbers that a camera delivers.

namespace vantage::simulation::internal {

/// Codes of a pixel's light, blue green red: square roots of exposed radiance. The noise of counted
/// light has a variance in proportion to it, and so the same spread of its root everywhere.
using LightCode = std::array<std::int16_t, 3>;

class Sensor {
 public:
  /// `seed`: of all noise; `index`: of the camera. The stage camera must outlive the sensor.
  Sensor(const StageCamera& camera, std::uint64_t seed, int index);

  LightCode Expose(const Eigen::Vector3f& radiance, int x, int y) const;

  /// Reads rows [begin, end) of codes out into `picture` (CV_8UC3), with noise of this frame, and
  /// the curve of sRGB.
  void ReadOut(const std::vector<LightCode>& codes, FrameIndex frame, int begin, int end,
               cv::Mat& picture) const;

 private:
  const StageCamera* camera_;
  std::uint64_t key_;
  Eigen::Vector3f gain_;  // red green blue
  Eigen::Vector2f middle_px_;
  float corner_px2_ = 1;
  std::vector<std::uint8_t> curve_;
  std::vector<std::int16_t> noise_;
};

}  // namespace vantage::simulation::internal
