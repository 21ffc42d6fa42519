// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/camera_shift.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace vantage {
namespace {

constexpr int kLongSide_px = 400;   // larger pictures are halved first
constexpr int kLeastSide_px = 24;   // of a part
constexpr double kAgreement = 0.4;  // least correlation of edges that are the same
constexpr double kUnmoved = 0.7;    // correlation that leaves nothing to ask
constexpr double kBetter = 0.7;     // of the disagreement that a shift may leave

/// Strength of the edges, CV_32FC1, made smaller by `scale`.
cv::Mat EdgesOf(const cv::Mat& bgr, double scale) {
  cv::Mat luma, x, y, edges;
  cv::cvtColor(bgr, luma, cv::COLOR_BGR2GRAY);
  if (scale < 1) cv::resize(luma, luma, {}, scale, scale, cv::INTER_AREA);
  cv::Sobel(luma, x, CV_32F, 1, 0);
  cv::Sobel(luma, y, CV_32F, 0, 1);
  cv::magnitude(x, y, edges);
  // The root keeps a few strong edges from outvoting all others.
  cv::sqrt(edges, edges);
  return edges * 4;
}

/// Correlation of two pictures inside `inside`.
double Correlation(const cv::Mat& a, const cv::Mat& b, const cv::Rect& inside) {
  cv::Scalar mean_a, deviation_a, mean_b, deviation_b;
  cv::meanStdDev(a(inside), mean_a, deviation_a);
  cv::meanStdDev(b(inside), mean_b, deviation_b);
  const double spread = deviation_a[0] * deviation_b[0];
  if (spread <= 0) return 0;
  return (a(inside).dot(b(inside)) / inside.area() - mean_a[0] * mean_b[0]) / spread;
}

/// Where the background's edges are found in the frame.
struct Match {
  cv::Point2d shift;  ///< in these pictures' pixels
  bool same = false;  ///< the edges are the same ones, shifted or not
  bool moved = false;
};

Match MatchEdges(const cv::Mat& frame, const cv::Mat& background) {
  cv::Mat window;
  cv::createHanningWindow(window, frame.size(), CV_32F);
  const cv::Point2d shift = cv::phaseCorrelate(background, frame, window);
  const cv::Rect whole({}, frame.size());
  const cv::Rect both = whole & (whole + cv::Point(shift));
  // Less than a third in common proves nothing.
  if (3 * both.area() < whole.area()) return {};
  cv::Mat moved;
  const cv::Matx23d by(1, 0, shift.x, 0, 1, shift.y);
  cv::warpAffine(background, moved, by, frame.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  const double with = Correlation(frame, moved, both);
  const double without = Correlation(frame, background, both);
  return {.shift = shift,
          .same = std::max(with, without) >= kAgreement,
          .moved = with >= kAgreement && 1 - with <= kBetter * (1 - without)};
}

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::optional<CameraShift> EstimateCameraShift(const cv::Mat& frame, const cv::Mat& background,
                                               double least_px) {
  if (std::min(frame.cols, frame.rows) < kLeastSide_px) return std::nullopt;
  double scale = 1;
  while (scale * std::max(frame.cols, frame.rows) > kLongSide_px) scale /= 2;
  const cv::Mat seen = EdgesOf(frame, scale);
  const cv::Mat behind = EdgesOf(background, scale);
  if (std::min(seen.cols, seen.rows) < kLeastSide_px) return std::nullopt;
  const auto length = [](const cv::Point2d& p) { return std::hypot(p.x, p.y); };

  if (Correlation(seen, behind, cv::Rect({}, seen.size())) >= kUnmoved) return std::nullopt;
  if (const Match whole = MatchEdges(seen, behind);
      whole.moved && length(whole.shift) / scale >= least_px) {
    return CameraShift{whole.shift / scale, length(whole.shift) / scale};
  }
  const cv::Size part(seen.cols / 3, seen.rows / 3);
  if (std::min(part.width, part.height) < kLeastSide_px) return std::nullopt;
  int same = 0;
  std::vector<double> x_px, y_px, length_px;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const cv::Rect inside({column * part.width, row * part.height}, part);
      const Match match = MatchEdges(seen(inside), behind(inside));
      if (match.same) ++same;
      if (!match.moved || length(match.shift) / scale < least_px) continue;
      x_px.push_back(match.shift.x / scale);
      y_px.push_back(match.shift.y / scale);
      length_px.push_back(length(match.shift) / scale);
    }
  }
  if (same < 4 || 2 * static_cast<int>(length_px.size()) < same) return std::nullopt;
  return CameraShift{{MedianOf(x_px), MedianOf(y_px)}, MedianOf(length_px)};
}

}  // namespace vantage
