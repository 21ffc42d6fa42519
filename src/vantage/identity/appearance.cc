// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/appearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace vantage {
namespace {

// A band of which less can be seen says nothing: what is left is its edge.
constexpr double kSeenShare = 0.7;
// A median of fewer pixels is noise.
constexpr int kFewestPixels = 8;

constexpr auto kMissing = std::numeric_limits<float>::quiet_NaN();

/// A person in one view.
struct Figure {
  double distance_m = 0;
  cv::Rect rectangle;
  CellIndex cell = 0;
};

/// The people whose rectangle is wholly in the picture, the nearest first; those who are partly
/// outside hide others, too, and have an empty cell of -1.
std::vector<Figure> FiguresIn(const Camera& camera, const PersonOptions& person,
                              std::span<const Peak> people) {
  const cv::Rect picture(0, 0, camera.size().width, camera.size().height);
  std::vector<Figure> figures;
  for (const Peak& peak : people) {
    const auto box = PersonBox(camera, peak.position_m, person);
    if (!box) continue;
    // Far outside a rectangle does not fit int.
    const auto pixel = [](double value) {
      return static_cast<int>(std::lround(std::clamp(value, -1e6, 1e6)));
    };
    const cv::Rect whole(cv::Point(pixel(box->min_x), pixel(box->min_y)),
                         cv::Point(pixel(box->max_x), pixel(box->max_y)));
    const cv::Rect inside = whole & picture;
    if (inside.empty()) continue;
    const Eigen::Vector3d foot_m(peak.position_m.x(), peak.position_m.y(), 0);
    figures.push_back({.distance_m = (foot_m - camera.center_m()).norm(),
                       .rectangle = inside,
                       .cell = inside == whole ? peak.cell : -1});
  }
  std::ranges::stable_sort(figures, {}, &Figure::distance_m);
  return figures;
}

/// Median of each channel of `lab` where both masks are set; false when it cannot be told.
bool BandColor(const cv::Mat& lab, const cv::Mat& mask, const cv::Mat& open,
               std::span<float> color) {
  std::array<std::array<int, 256>, 3> histograms = {};
  int seen = 0;
  int pixels = 0;
  for (int y = 0; y < lab.rows; ++y) {
    const auto* colors = lab.ptr<cv::Vec3b>(y);
    const auto* foreground = mask.ptr<std::uint8_t>(y);
    const auto* unhidden = open.ptr<std::uint8_t>(y);
    for (int x = 0; x < lab.cols; ++x) {
      if (unhidden[x] == 0) continue;
      ++seen;
      if (foreground[x] < 128) continue;
      ++pixels;
      for (int channel = 0; channel < 3; ++channel) {
        ++histograms[static_cast<std::size_t>(channel)][colors[x][channel]];
      }
    }
  }
  if (seen < kSeenShare * static_cast<double>(lab.total()) || pixels < kFewestPixels) return false;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    int value = 0;
    for (int below = histograms[channel][0]; 2 * below < pixels;) {
      below += histograms[channel][static_cast<std::size_t>(++value)];
    }
    color[channel] = static_cast<float>(value);
  }
  return true;
}

/// The bands of a figure; false when none can be told.
bool ColorsOf(const cv::Mat& picture, const cv::Mat& mask, const cv::Mat& open,
              const cv::Rect& rectangle, BandColors& colors) {
  colors.fill(kMissing);
  cv::Mat lab;
  cv::cvtColor(picture(rectangle), lab, cv::COLOR_BGR2Lab);
  const auto row = [&](int band) {  // where a band begins, from the feet
    return static_cast<int>(
        std::lround(rectangle.height * (1 - double{1} * band / kAppearanceBands)));
  };
  bool any = false;
  for (int band = 0; band < kAppearanceBands; ++band) {
    const cv::Rect rows(0, row(band + 1), rectangle.width, row(band) - row(band + 1));
    any |= BandColor(lab(rows), mask(rectangle)(rows), open(rectangle)(rows),
                     std::span(colors).subspan(3 * static_cast<std::size_t>(band), 3));
  }
  return any;
}

}  // namespace

AppearanceSampler::AppearanceSampler(std::vector<View> views, const PersonOptions& person)
    : views_(std::move(views)), person_(person) {}

void AppearanceSampler::Look(std::int64_t frame, std::span<const cv::Mat> pictures,
                             std::span<const cv::Mat> masks, std::span<const Peak> people,
                             Appearances& appearances) const {
  for (std::size_t camera = 0; camera < views_.size(); ++camera) {
    if (pictures[camera].empty() || masks[camera].empty()) continue;
    const View& view = views_[camera];
    cv::Mat open = view.informative.empty()
                       ? cv::Mat(pictures[camera].size(), CV_8UC1, cv::Scalar(255))
                       : view.informative.clone();
    for (const Figure& figure : FiguresIn(view.camera, person_, people)) {
      Appearance seen{.frame = frame, .cell = figure.cell, .camera = static_cast<int>(camera)};
      if (figure.cell >= 0 &&
          ColorsOf(pictures[camera], masks[camera], open, figure.rectangle, seen.colors)) {
        appearances.push_back(seen);
      }
      open(figure.rectangle).setTo(0);
    }
  }
}

}  // namespace vantage
