// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/cleanup.h"

#include <opencv2/imgproc.hpp>
#include <vector>

#include "vantage/background/components.h"

namespace vantage {
namespace {

cv::Mat Disc(int radius_px) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius_px + 1, 2 * radius_px + 1});
}

void DropSmallComponents(cv::Mat& mask, int min_area_px) {
  const std::vector<Component> large = FindComponents(mask, {.min_area_px = min_area_px});
  mask.setTo(0);
  for (const Component& component : large) mask(component.window).setTo(255, component.pixels);
}

}  // namespace

void VisitOptions(CleanupOptions& o, OptionVisitor& v) {
  v.Number({"open", "px", "radius of the opening that removes specks; 0: off"}, o.open_px,
           Range::Between(0, 50));
  v.Number({"close", "px", "radius of the closing that fills gaps; 0: off"}, o.close_px,
           Range::Between(0, 50));
  v.Number({"min_area", "px", "components of fewer pixels are dropped; 0: off"}, o.min_area_px,
           Range::AtLeast(0));
}

Status CleanMask(cv::Mat& mask, const CleanupOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "background"));
  if (mask.empty() || mask.type() != CV_8UC1) {
    return Fail(
        "mask clean-up: the mask is {}x{} px of type {}; it must be a picture of type CV_8UC1",
        mask.cols, mask.rows, cv::typeToString(mask.type()));
  }
  if (options.open_px > 0) cv::morphologyEx(mask, mask, cv::MORPH_OPEN, Disc(options.open_px));
  if (options.close_px > 0) cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, Disc(options.close_px));
  if (options.min_area_px > 1) DropSmallComponents(mask, options.min_area_px);
  return {};
}

}  // namespace vantage
