// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/ghost_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "vantage/rendering/drawing.h"

namespace vantage {
namespace {

constexpr int kWide_px = 640;
const cv::Scalar kValid(90, 200, 60);
const cv::Scalar kGhost(0, 165, 255);
const cv::Scalar kAbsorbed(60, 60, 230);
const cv::Scalar kUndecided(190, 190, 190);
const cv::Scalar kForeground(255, 160, 60);

cv::Scalar ColorOf(const JudgedComponent& judged, const cv::Mat& ghosts) {
  if (!judged.decided) return kUndecided;
  if (!judged.ghost) return kValid;
  const cv::Mat pixels = judged.component.pixels;
  const bool absorbed =
      !ghosts.empty() && cv::countNonZero(ghosts(judged.component.window) & pixels) > 0;
  return absorbed ? kAbsorbed : kGhost;
}

}  // namespace

cv::Mat DrawGhosts(const cv::Mat& bgr, const cv::Mat& mask, const GhostVerdict& verdict) {
  const int scale = bgr.cols < kWide_px ? 2 : 1;
  cv::Mat tinted = bgr.clone();
  const cv::Mat tint(bgr.size(), CV_8UC3, kForeground);
  cv::Mat mixed;
  cv::addWeighted(bgr, 0.7, tint, 0.3, 0, mixed);
  mixed.copyTo(tinted, mask);
  cv::Mat picture;
  cv::resize(tinted, picture, {}, scale, scale, cv::INTER_NEAREST);
  for (const JudgedComponent& judged : verdict.judged) {
    const cv::Rect& window = judged.component.window;
    const cv::Scalar color = ColorOf(judged, verdict.ghosts);
    cv::Mat large;
    cv::resize(judged.component.pixels, large, {}, scale, scale, cv::INTER_NEAREST);
    std::vector<std::vector<cv::Point>> contours;
    cv::findContours(large, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE,
                     window.tl() * scale);
    cv::drawContours(picture, contours, -1, color, scale);
  }
  // Above the outlines, which may lie over one another.
  for (const JudgedComponent& judged : verdict.judged) {
    const cv::Rect& box = judged.component.box;
    drawing::TextStyle style{.height_px = 9, .color = ColorOf(judged, verdict.ghosts)};
    style.anchor = drawing::Anchor::kCenter;
    style.halo_px = 1.5;
    const double baseline_px = std::max(style.height_px + 2, box.y * scale - 3.0);
    drawing::Text(picture, judged.decided ? fmt::format("{:.2f}", judged.value) : "?",
                  {(box.x + box.width / 2.0) * scale, baseline_px}, style);
  }
  return picture;
}

}  // namespace vantage
