// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "vantage/occupancy/occupancy_options.h"

namespace vantage::internal {

/// r of evidence "person" (formula in solver.h).
class PersonEvidence {
 public:
  explicit PersonEvidence(const OccupancyOptions& options)
      : worth_(options.worth), cost_(options.background_cost) {}

  /// m and mb: sums of M and M B over the rectangle; n: absence of the cell; area: of the
  /// rectangle, in pixels.
  double Ratio(double m, double mb, double n, double area) const {
    return worth_ * (mb - cost_ * (m - mb)) / (n * area);
  }

 private:
  double worth_;
  double cost_;
};

/// r of evidence "picture", the original program's (algorithms.md section 3).
class PictureEvidence {
 public:
  /// Of a whole picture: number of pixels and sums of B, M and M B.
  PictureEvidence(const OccupancyOptions& options, double pixels, double sum_b, double sum_m,
                  double sum_mb)
      : surface_(pixels * (1 + options.noise) - sum_m),
        difference_(surface_ + 2 * sum_mb - sum_b),
        min_surface_(kMinSurface * pixels),
        scale_(1 / (2 * options.variance)) {}

  double Ratio(double m, double mb, double n) const {
    const double l = 1 - 1 / n;
    const double present = (difference_ + m - 2 * mb) / (surface_ + m);
    const double absent =
        (difference_ + l * (m - 2 * mb)) / std::max(surface_ + l * m, min_surface_);
    return scale_ * (absent * absent - present * present);  // L(x) = -x^2 / (2 v)
  }

 private:
  /// A surface below this share of the picture is rounding (or what `ignored` leaves out of M).
  static constexpr double kMinSurface = 1e-6;

  double surface_;     // S_c
  double difference_;  // D_c
  double min_surface_;
  double scale_;
};

}  // namespace vantage::internal
