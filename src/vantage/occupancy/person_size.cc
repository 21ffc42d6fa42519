// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/person_size.h"

#include <algorithm>
#include <numeric>
#include <opencv2/core.hpp>
#include <utility>

#include "vantage/background/components.h"

namespace vantage {
namespace {

/// Smaller figures are measured too coarsely by their pixels.
constexpr int kMinHeight_px = 20;
constexpr int kMinWidth_px = 6;
constexpr double kMinHeight_m = 0.8;
constexpr double kMaxHeight_m = 2.6;
constexpr double kMinAspect = 0.15;
constexpr double kMaxAspect = 0.8;
/// Two cameras saw the same person when feet and heights agree this well.
constexpr double kSamePlace_m = 0.5;
constexpr double kSameHeight = 1.15;

bool IsPlausible(const PersonInBox& person) {
  const double aspect = person.width_m / person.height_m;
  return person.height_m >= kMinHeight_m && person.height_m <= kMaxHeight_m &&
         aspect >= kMinAspect && aspect <= kMaxAspect;
}

bool AreTheSame(const PersonInBox& a, const PersonInBox& b) {
  return (a.foot_m - b.foot_m).norm() <= kSamePlace_m &&
         std::max(a.height_m, b.height_m) <= kSameHeight * std::min(a.height_m, b.height_m);
}

/// The rectangle that a silhouette fills, as the occupancy stage sees it: outer rows and columns of
/// the bounding box of which less than half is foreground (feet, a stretched arm) would add more
/// wrong pixels than right ones. A box of a detector stays as it is.
cv::Rect FilledRectangle(const Component& component) {
  cv::Rect filled({0, 0}, component.pixels.size());
  while (filled.width > 1 && filled.height > 1) {
    const cv::Rect top(filled.x, filled.y, filled.width, 1);
    const cv::Rect bottom(filled.x, filled.br().y - 1, filled.width, 1);
    const cv::Rect left(filled.x, filled.y, 1, filled.height);
    const cv::Rect right(filled.br().x - 1, filled.y, 1, filled.height);
    double emptiest = 0.5;
    cv::Rect without = filled;
    const auto consider = [&](const cv::Rect& edge, const cv::Rect& rest) {
      const double share =
          static_cast<double>(cv::countNonZero(component.pixels(edge))) / edge.area();
      if (share >= emptiest) return;
      emptiest = share;
      without = rest;
    };
    const cv::Size shorter(filled.width, filled.height - 1);
    const cv::Size narrower(filled.width - 1, filled.height);
    consider(top, {filled.tl() + cv::Point(0, 1), shorter});
    consider(bottom, {filled.tl(), shorter});
    consider(left, {filled.tl() + cv::Point(1, 0), narrower});
    consider(right, {filled.tl(), narrower});
    if (without == filled) break;
    filled = without;
  }
  return filled + component.box.tl();
}

/// Of ascending numbers, at least one; of the two in the middle the lower.
double Median(std::span<const double> sorted) { return sorted[(sorted.size() - 1) / 2]; }

/// The shortest stretch of ascending numbers that holds half of them; the first of equal ones.
std::span<const double> ShortestHalf(std::span<const double> sorted) {
  const std::size_t half = sorted.size() / 2 + 1;
  std::size_t best = 0;
  for (std::size_t i = 1; i + half <= sorted.size(); ++i) {
    if (sorted[i + half - 1] - sorted[i] < sorted[best + half - 1] - sorted[best]) best = i;
  }
  return sorted.subspan(best, half);
}

RobustLength Robust(std::span<const double> sorted) {
  const std::span<const double> half = ShortestHalf(sorted);
  return {.value_m = Median(half), .spread_m = (half.back() - half.front()) / 2};
}

}  // namespace

double PersonSizeReport::RectangleWidth_m(double cell_m) const {
  return width->value_m + std::max(2.5 * width->spread_m, CellAllowance_m(cell_m));
}

double PersonSizeReport::RectangleHeight_m() const {
  return height->value_m + 1.5 * height->spread_m;
}

std::int64_t PersonSizeReport::TotalCounted() const {
  return std::accumulate(counted.begin(), counted.end(), std::int64_t{0});
}

PersonSizeMeter::PersonSizeMeter(std::vector<Camera> cameras, Polygon area,
                                 PersonOptions::Shape shape)
    : cameras_(std::move(cameras)), area_(std::move(area)), shape_(shape) {}

Status PersonSizeMeter::Add(std::span<const cv::Mat> masks) {
  if (masks.size() != cameras_.size()) {
    return Fail("{} masks were given for {} cameras; one for each is needed", masks.size(),
                cameras_.size());
  }
  std::vector<Figure> found;
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const cv::Mat& mask = masks[i];
    if (mask.empty()) continue;
    const ImageSize size = cameras_[i].size();
    if (mask.type() != CV_8UC1 || mask.cols != size.width || mask.rows != size.height) {
      return Fail("the mask of camera {} is not one 8-bit channel of {} x {} px", i, size.width,
                  size.height);
    }
    const cv::Rect inner(1, 1, mask.cols - 2, mask.rows - 2);
    for (const Component& component : FindComponents(mask >= 128, {.min_area_px = kMinHeight_px})) {
      if ((component.box & inner) != component.box) continue;
      const cv::Rect box = FilledRectangle(component);
      if (box.width < kMinWidth_px || box.height < kMinHeight_px) continue;
      const PixelBox edges{box.x - 0.5, box.y - 0.5, box.br().x - 0.5, box.br().y - 0.5};
      const std::optional<PersonInBox> person = PersonFromBox(cameras_[i], edges, shape_);
      if (!person || !IsPlausible(*person) || !area_.Contains(person->foot_m)) continue;
      found.push_back({.camera = i, .person = *person});
    }
  }
  for (Figure& figure : found) {
    figure.confirmed = std::ranges::any_of(found, [&](const Figure& other) {
      return other.camera != figure.camera && AreTheSame(figure.person, other.person);
    });
  }
  figures_.insert(figures_.end(), found.begin(), found.end());
  ++frames_;
  return {};
}

PersonSizeReport PersonSizeMeter::Report() const {
  PersonSizeReport report;
  report.frames = frames_;
  report.figures.resize(cameras_.size());
  report.counted.resize(cameras_.size());
  report.confirmed = std::ranges::count_if(figures_, &Figure::confirmed) >= kFewest;
  std::vector<PersonInBox> counted;
  for (const Figure& figure : figures_) {
    ++report.figures[figure.camera];
    if (report.confirmed && !figure.confirmed) continue;
    ++report.counted[figure.camera];
    counted.push_back(figure.person);
  }
  if (static_cast<std::int64_t>(counted.size()) < kFewest) return report;

  std::vector<double> heights_m;
  for (const PersonInBox& person : counted) heights_m.push_back(person.height_m);
  std::ranges::sort(heights_m);
  report.height = Robust(heights_m);
  const std::span<const double> usual = ShortestHalf(heights_m);
  std::vector<double> widths_m;
  for (const PersonInBox& person : counted) {
    if (person.height_m >= usual.front() && person.height_m <= usual.back()) {
      widths_m.push_back(person.width_m);
    }
  }
  std::ranges::sort(widths_m);
  report.width = Robust(widths_m);
  return report;
}

}  // namespace vantage
