// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "vantage/occupancy/solver.h"
#include "vantage/occupancy/views.h"

namespace vantage::bench {

/// Occupancy maps as the authors of the Probabilistic Occupancy Map compute them, written plainly:
/// masks at the cameras' full resolution, every iteration multiplies the absence of each cell into
/// the pixels of its rectangle (cells above `ignored` are left out), then box sums from integral
/// images; double precision. Masks and rectangles are of the same size.
class AuthorsPom {
 public:
  AuthorsPom(const std::vector<CameraView>& views, const OccupancyOptions& options)
      : views_(views), options_(options) {}

  /// The probability of presence of every cell. Thread-safe.
  void Solve(std::span<const cv::Mat> masks, std::span<float> q) const;

 private:
  const std::vector<CameraView>& views_;
  const OccupancyOptions options_;
};

}  // namespace vantage::bench
