// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

#include "vantage/base/options.h"
#include "vantage/base/result.h"

namespace vantage {

/// Options of the mask's clean-up; each of the three steps is off at 0.
struct CleanupOptions {
  /// Radius of the disc that foreground must hold to stay (opening), px, 0 <= open_px <= 50.
  int open_px = 1;
  /// Radius of the disc that background must hold to stay (closing), px, 0 <= close_px <= 50.
  int close_px = 2;
  /// Components of fewer pixels are dropped, px, >= 0.
  int min_area_px = 40;
};
void VisitOptions(CleanupOptions& options, OptionVisitor& visitor);

/// Opens, closes and drops small components (of 8 neighbours), in this order and in place. `mask`
/// is CV_8UC1, 0 or 255.
Status CleanMask(cv::Mat& mask, const CleanupOptions& options);

}  // namespace vantage
