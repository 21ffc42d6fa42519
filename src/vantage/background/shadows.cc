// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/shadows.h"

#include <cstdint>
#include <opencv2/core.hpp>

namespace vantage {
namespace {

// The background picture is asked for in tiles of this side that hold foreground.
constexpr int kTile_px = 64;

bool IsShadow(const cv::Vec3b& seen, const cv::Vec3b& behind, double tau, double color_squared) {
  double seen_behind = 0;
  double behind_behind = 0;
  for (int c = 0; c < 3; ++c) {
    seen_behind += seen[c] * behind[c];
    behind_behind += behind[c] * behind[c];
  }
  if (behind_behind == 0) return false;
  const double a = seen_behind / behind_behind;  // brightness distortion
  if (a <= tau || a >= 1) return false;
  double distortion = 0;  // of the chromaticity
  for (int c = 0; c < 3; ++c) {
    const double off = seen[c] - a * behind[c];
    distortion += off * off;
  }
  return distortion < color_squared;
}

}  // namespace

void VisitOptions(ShadowOptions& o, OptionVisitor& v) {
  v.Flag({"shadows", "", "take cast shadows out of the mask"}, o.enabled);
  v.Number({"shadow_tau", "", "share of the background's brightness that a shadow keeps at least"},
           o.tau, Range::Inside(0, 1));
  v.Number({"shadow_color", "levels", "what a shadow's colour may differ, brightness apart"},
           o.color_levels, Range::Above(0));
}

Result<int> RejectShadows(const cv::Mat& bgr, cv::Mat& mask, const BackgroundPicture& background,
                          const ShadowOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "background"));
  if (mask.empty() || mask.type() != CV_8UC1 || bgr.type() != CV_8UC3 ||
      bgr.size() != mask.size()) {
    return Fail(
        "shadows: the mask is {}x{} px of type {} and the frame {}x{} px of type {}; they must be "
        "of one size and of types CV_8UC1 and CV_8UC3",
        mask.cols, mask.rows, cv::typeToString(mask.type()), bgr.cols, bgr.rows,
        cv::typeToString(bgr.type()));
  }
  if (!options.enabled) return 0;
  const double color_squared = options.color_levels * options.color_levels;
  const cv::Rect whole({}, mask.size());
  int taken = 0;
  for (int top = 0; top < mask.rows; top += kTile_px) {
    for (int left = 0; left < mask.cols; left += kTile_px) {
      const cv::Rect tile = cv::Rect(left, top, kTile_px, kTile_px) & whole;
      if (cv::countNonZero(mask(tile)) == 0) continue;
      const cv::Mat behind = background(tile);
      VANTAGE_RETURN_IF_ERROR(CheckBackgroundPicture("shadows", behind, tile.size()));
      for (int y = 0; y < tile.height; ++y) {
        std::uint8_t* foreground = mask.ptr(top + y, left);
        const auto* seen = bgr.ptr<cv::Vec3b>(top + y, left);
        const auto* hidden = behind.ptr<cv::Vec3b>(y);
        for (int x = 0; x < tile.width; ++x) {
          if (foreground[x] == 0 || !IsShadow(seen[x], hidden[x], options.tau, color_squared)) {
            continue;
          }
          foreground[x] = 0;
          ++taken;
        }
      }
    }
  }
  return taken;
}

}  // namespace vantage
