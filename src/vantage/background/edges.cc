// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace vantage {
namespace {

// Length of the longest gradient that a 3x3 Sobel filter finds in 8-bit levels: sqrt(2) * 4 * 255.
constexpr std::size_t kLengths = 1444;
using Histogram = std::array<std::int32_t, kLengths>;

void AddLengths(const LumaGradient& gradient, const cv::Mat& region, Histogram& histogram) {
  for (int y = 0; y < region.rows; ++y) {
    const std::uint8_t* inside = region.ptr(y);
    const auto* squared = gradient.squared.ptr<std::int32_t>(y);
    for (int x = 0; x < region.cols; ++x) {
      if (inside[x] == 0) continue;
      ++histogram[static_cast<std::size_t>(std::sqrt(static_cast<float>(squared[x])))];
    }
  }
}

/// The last bin of the lower class where the variance between both is largest.
int OtsuThreshold(const Histogram& histogram) {
  double total = 0;
  double sum = 0;
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    total += histogram[bin];
    sum += static_cast<double>(bin) * histogram[bin];
  }
  double low_total = 0;
  double low_sum = 0;
  double best = -1;
  int threshold = 0;
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    if (histogram[bin] == 0) continue;
    low_total += histogram[bin];
    low_sum += static_cast<double>(bin) * histogram[bin];
    if (low_total == total) break;
    const double apart = low_sum / low_total - (sum - low_sum) / (total - low_total);
    const double between = low_total * (total - low_total) * apart * apart;
    if (between > best) {
      best = between;
      threshold = static_cast<int>(bin);
    }
  }
  return threshold;
}

/// True where the gradient's length has a maximum along its direction; of two equal neighbours the
/// one on the right or below is.
bool IsRidge(const LumaGradient& gradient, int x, int y) {
  const auto length = [&](int dx, int dy) {
    const int column = x + dx;
    const int row = y + dy;
    const cv::Mat& squared = gradient.squared;
    if (column < 0 || row < 0 || column >= squared.cols || row >= squared.rows) return 0;
    return squared.at<std::int32_t>(row, column);
  };
  const int here = length(0, 0);
  const int gx = gradient.x.at<std::int16_t>(y, x);
  const int gy = gradient.y.at<std::int16_t>(y, x);
  // tan(22.5 deg) in fixed point; tan(67.5 deg) = tan(22.5 deg) + 2.
  constexpr int kShift = 15;
  constexpr int kTan22 = 13573;
  const int across = std::abs(gx);
  const int down = std::abs(gy) << kShift;
  if (down < across * kTan22) return here > length(-1, 0) && here >= length(1, 0);
  if (down > across * kTan22 + (across << (kShift + 1))) {
    return here > length(0, -1) && here >= length(0, 1);
  }
  const int side = (gx ^ gy) < 0 ? -1 : 1;
  return here > length(-side, -1) && here > length(side, 1);
}

}  // namespace

LumaGradient GradientOf(const cv::Mat& bgr) {
  cv::Mat luma;
  cv::cvtColor(bgr, luma, cv::COLOR_BGR2GRAY);
  const int rows = luma.rows;
  const int columns = luma.cols;
  LumaGradient gradient{cv::Mat(rows, columns, CV_16SC1), cv::Mat(rows, columns, CV_16SC1),
                        cv::Mat(rows, columns, CV_32SC1)};
  // Sums down a column, 1 2 1 and -1 0 1, with a column more on each side.
  std::vector<std::int16_t> smooth(static_cast<std::size_t>(columns) + 2);
  std::vector<std::int16_t> slope(smooth.size());
  for (int y = 0; y < rows; ++y) {
    const std::uint8_t* above = luma.ptr(std::max(0, y - 1));
    const std::uint8_t* here = luma.ptr(y);
    const std::uint8_t* below = luma.ptr(std::min(rows - 1, y + 1));
    for (int x = 0; x < columns; ++x) {
      smooth[static_cast<std::size_t>(x) + 1] =
          static_cast<std::int16_t>(above[x] + 2 * here[x] + below[x]);
      slope[static_cast<std::size_t>(x) + 1] = static_cast<std::int16_t>(below[x] - above[x]);
    }
    smooth.front() = smooth[1];
    smooth.back() = smooth[static_cast<std::size_t>(columns)];
    slope.front() = slope[1];
    slope.back() = slope[static_cast<std::size_t>(columns)];
    auto* gx = gradient.x.ptr<std::int16_t>(y);
    auto* gy = gradient.y.ptr<std::int16_t>(y);
    auto* squared = gradient.squared.ptr<std::int32_t>(y);
    for (int x = 0; x < columns; ++x) {
      const auto i = static_cast<std::size_t>(x);
      const int dx = smooth[i + 2] - smooth[i];
      const int dy = slope[i] + 2 * slope[i + 1] + slope[i + 2];
      gx[x] = static_cast<std::int16_t>(dx);
      gy[x] = static_cast<std::int16_t>(dy);
      squared[x] = dx * dx + dy * dy;
    }
  }
  return gradient;
}

double EdgeThreshold(const LumaGradient* a, const LumaGradient* b, const cv::Mat& region) {
  Histogram lengths{};
  if (a != nullptr) AddLengths(*a, region, lengths);
  if (b != nullptr) AddLengths(*b, region, lengths);
  return OtsuThreshold(lengths);
}

cv::Mat CannyEdges(const LumaGradient& gradient, const cv::Mat& region, double upper) {
  const auto high = static_cast<std::int32_t>(std::floor(upper * upper));
  const auto low = static_cast<std::int32_t>(std::floor(upper * upper / 4));
  constexpr std::uint8_t kWeak = 1;
  constexpr std::uint8_t kEdge = 255;
  cv::Mat edges = cv::Mat::zeros(region.size(), CV_8UC1);
  std::vector<cv::Point> growing;
  for (int y = 0; y < region.rows; ++y) {
    const std::uint8_t* inside = region.ptr(y);
    const auto* squared = gradient.squared.ptr<std::int32_t>(y);
    std::uint8_t* edge = edges.ptr(y);
    for (int x = 0; x < region.cols; ++x) {
      if (inside[x] == 0 || squared[x] <= low || !IsRidge(gradient, x, y)) continue;
      edge[x] = squared[x] > high ? kEdge : kWeak;
      if (edge[x] == kEdge) growing.emplace_back(x, y);
    }
  }
  while (!growing.empty()) {
    const cv::Point from = growing.back();
    growing.pop_back();
    for (int y = std::max(0, from.y - 1); y <= std::min(edges.rows - 1, from.y + 1); ++y) {
      for (int x = std::max(0, from.x - 1); x <= std::min(edges.cols - 1, from.x + 1); ++x) {
        std::uint8_t& edge = edges.at<std::uint8_t>(y, x);
        if (edge != kWeak) continue;
        edge = kEdge;
        growing.emplace_back(x, y);
      }
    }
  }
  for (int y = 0; y < edges.rows; ++y) {
    std::uint8_t* edge = edges.ptr(y);
    for (int x = 0; x < edges.cols; ++x) edge[x] = edge[x] == kEdge ? kEdge : 0;
  }
  return edges;
}

}  // namespace vantage
