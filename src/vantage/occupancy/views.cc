// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/views.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

using Eigen::Vector2d;

bool SpeaksFor(const Camera& camera, const Vector2d& foot_m, const PixelBox& box, Visibility rule) {
  switch (rule) {
    case Visibility::kGround: {
      const auto foot_px = camera.ImageFromWorld({foot_m.x(), foot_m.y(), 0});
      return foot_px && camera.InPicture(*foot_px);
    }
    case Visibility::kComplete:
      return box.min_x >= -0.5 && box.min_y >= -0.5 && box.max_x <= camera.size().width - 0.5 &&
             box.max_y <= camera.size().height - 0.5;
    case Visibility::kCentre:
      return camera.InPicture({(box.min_x + box.max_x) / 2, (box.min_y + box.max_y) / 2});
    case Visibility::kContinuous:
      return true;  // as far as any pixel is in the picture
  }
  return false;
}

/// The pixels of one axis whose centres lie in [low, high], clipped to [0, size).
std::pair<int, int> PixelRange(double low, double high, int size) {
  const double first = std::clamp(std::ceil(low), 0.0, static_cast<double>(size));
  const double end = std::clamp(std::floor(high) + 1, first, static_cast<double>(size));
  return {static_cast<int>(first), static_cast<int>(end)};
}

cv::Rect Rectangle(const PixelBox& box, ImageSize size) {
  const auto [left, right] = PixelRange(box.min_x, box.max_x, size.width);
  const auto [top, bottom] = PixelRange(box.min_y, box.max_y, size.height);
  const cv::Rect rectangle(left, top, right - left, bottom - top);
  return rectangle.empty() ? cv::Rect() : rectangle;
}

/// Share of a rectangle that is inside a picture.
float VisibleShare(const PixelBox& box, ImageSize size) {
  const double width = std::min(box.max_x, size.width - 0.5) - std::max(box.min_x, -0.5);
  const double height = std::min(box.max_y, size.height - 0.5) - std::max(box.min_y, -0.5);
  const double area = std::max(width, 0.0) * std::max(height, 0.0);
  return static_cast<float>(std::min(area / (box.width() * box.height()), 1.0));
}

/// Takes the rectangles without any informative pixel from the view.
void DropBlindRectangles(CameraView& view) {
  cv::Mat share;
  view.informative.convertTo(share, CV_32F, 1.0 / 255);
  cv::resize(share, share, cv::Size(view.size.width, view.size.height), 0, 0, cv::INTER_AREA);
  cv::Mat_<int> sums;
  cv::integral(share > 0, sums, CV_32S);
  for (cv::Rect& r : view.rectangles) {
    const int right = r.x + r.width, bottom = r.y + r.height;
    const int speaking =
        sums(bottom, right) - sums(r.y, right) - sums(bottom, r.x) + sums(r.y, r.x);
    if (speaking == 0) r = cv::Rect();
  }
}

}  // namespace

ImageSize ReducedSize(ImageSize size, double reduction) {
  const auto side = [reduction](int length) {
    return std::max(1, static_cast<int>(std::lround(length / reduction)));
  };
  return {side(size.width), side(size.height)};
}

int AutomaticReduction(const Camera& camera, const GroundGrid& grid, const PersonOptions& person) {
  constexpr double kMinWidth_px = 5;
  constexpr int kLargest = 16;
  std::vector<double> widths_px;
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    const std::optional<PixelBox> box = PersonBox(camera, grid.Center(cell), person);
    if (box && SpeaksFor(camera, grid.Center(cell), *box, Visibility::kCentre)) {
      widths_px.push_back(box->width());
    }
  }
  if (widths_px.empty()) return 1;
  const auto quarter = widths_px.begin() + static_cast<std::ptrdiff_t>(widths_px.size() / 4);
  std::nth_element(widths_px.begin(), quarter, widths_px.end());
  const auto [width_px, height_px] = camera.size();
  int reduction = 1;
  for (int side = 2; side <= kLargest; ++side) {
    const bool divides = width_px % side == 0 && height_px % side == 0;
    if (divides && *quarter / side >= kMinWidth_px) reduction = side;
  }
  return reduction;
}

Result<CameraView> BuildView(const Camera& camera, const GroundGrid& grid,
                             const PersonOptions& person, Visibility rule, double reduction,
                             const cv::Mat& informative) {
  if (!(reduction >= 1) || !std::isfinite(reduction)) {
    return Fail("occupancy.reduction is {}; it must be at least 1", reduction);
  }
  if (grid.count() < 1) return Fail("the grid has no cells; at least one is needed");
  const auto [width, height] = camera.size();
  if (!informative.empty() &&
      (informative.type() != CV_8UC1 || informative.cols != width || informative.rows != height)) {
    return Fail(
        "the informative pixels are {} x {} px with {} channels of {} bytes; they must be {} x {} "
        "with one of 1 byte",
        informative.cols, informative.rows, informative.channels(), informative.elemSize1(), width,
        height);
  }
  CameraView view;
  view.mask_size = camera.size();
  view.size = ReducedSize(camera.size(), reduction);
  VANTAGE_ASSIGN_OR_RETURN(const Camera reduced, camera.Scaled(view.size));
  view.rectangles.resize(static_cast<std::size_t>(grid.count()));
  if (rule == Visibility::kContinuous) view.weights.resize(view.rectangles.size());
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    const Vector2d foot_m = grid.Center(cell);
    const std::optional<PixelBox> box = PersonBox(reduced, foot_m, person);
    if (!box || !SpeaksFor(reduced, foot_m, *box, rule)) continue;
    const auto index = static_cast<std::size_t>(cell);
    view.rectangles[index] = Rectangle(*box, view.size);
    if (!view.weights.empty()) view.weights[index] = VisibleShare(*box, view.size);
  }
  if (!informative.empty()) {
    view.informative = informative;
    DropBlindRectangles(view);
  }
  return view;
}

std::vector<std::uint8_t> VisibleCells(std::span<const CameraView> views) {
  std::vector<std::uint8_t> visible(views.empty() ? 0 : views.front().rectangles.size(), 0);
  for (const CameraView& view : views) {
    for (std::size_t cell = 0; cell < visible.size(); ++cell) {
      if (!view.rectangles[cell].empty()) visible[cell] = 1;
    }
  }
  return visible;
}

}  // namespace vantage
