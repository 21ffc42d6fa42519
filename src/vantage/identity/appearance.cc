// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/appearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
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
  cv::Rect rectangle;             ///< as far as it is in the picture
  std::optional<CellIndex> cell;  ///< none: partly outside, only hides others
};

/// The people who are in the picture at least in part, the nearest first.
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
                       .cell = inside == whole ? std::optional(peak.cell) : std::nullopt});
  }
  std::ranges::stable_sort(figures, {}, &Figure::distance_m);
  return figures;
}

/// CV_8UC1 of the figure's rectangle: 255 where no rectangle of `nearer` figures covers it and the
/// camera's pixels are informative (as in CameraView).
cv::Mat OpenPixels(const cv::Rect& rectangle, std::span<const Figure> nearer,
                   const cv::Mat& informative) {
  cv::Mat open = informative.empty() ? cv::Mat(rectangle.size(), CV_8UC1, cv::Scalar(255))
                                     : informative(rectangle).clone();
  for (const Figure& figure : nearer) {
    const cv::Rect hidden = figure.rectangle & rectangle;
    if (!hidden.empty()) open(hidden - rectangle.tl()).setTo(0);
  }
  return open;
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

/// The bands of a figure, whose rectangle all three show; false when none can be told.
bool ColorsOf(const cv::Mat& picture, const cv::Mat& mask, const cv::Mat& open,
              BandColors& colors) {
  colors.fill(kMissing);
  cv::Mat lab;
  cv::cvtColor(picture, lab, cv::COLOR_BGR2Lab);
  const auto row = [&](int band) {  // where a band begins, from the feet
    return static_cast<int>(std::lround(lab.rows * (1 - double{1} * band / kAppearanceBands)));
  };
  bool any = false;
  for (int band = 0; band < kAppearanceBands; ++band) {
    const cv::Range rows(row(band + 1), row(band));
    any |= BandColor(lab.rowRange(rows), mask.rowRange(rows), open.rowRange(rows),
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
    const std::vector<Figure> figures = FiguresIn(view.camera, person_, people);
    for (std::size_t i = 0; i < figures.size(); ++i) {
      const auto& [distance_m, rectangle, cell] = figures[i];
      if (!cell) continue;
      Appearance seen{.frame = frame, .cell = *cell, .camera = static_cast<int>(camera)};
      if (ColorsOf(pictures[camera](rectangle), masks[camera](rectangle),
                   OpenPixels(rectangle, std::span(figures).first(i), view.informative),
                   seen.colors)) {
        appearances.push_back(seen);
      }
    }
  }
}

}  // namespace vantage
