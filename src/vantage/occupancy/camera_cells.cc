// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/camera_cells.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace vantage::internal {
namespace {

constexpr int kMaxSide = 32768;
/// A camera says nothing of a person of whom it sees less, in pixels of the view.
constexpr double kMinArea = 1e-3;

Status CheckView(const CameraView& view, std::size_t index, std::size_t cells) {
  if (view.rectangles.size() != cells) {
    return Fail(
        "the view of camera {} has {} cells and that of camera 0 has {}; all views must be "
        "of the same grid",
        index, view.rectangles.size(), cells);
  }
  if (!view.weights.empty() && view.weights.size() != cells) {
    return Fail("the view of camera {} has weights for {} of its {} cells", index,
                view.weights.size(), cells);
  }
  for (const ImageSize size : {view.mask_size, view.size}) {
    if (size.width < 1 || size.height < 1 || size.width > kMaxSide || size.height > kMaxSide) {
      return Fail("the view of camera {} is {} x {} px; each side must be 1 to {}", index,
                  size.width, size.height, kMaxSide);
    }
  }
  const cv::Rect picture(0, 0, view.size.width, view.size.height);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const cv::Rect& r = view.rectangles[cell];
    if (!r.empty() && (r & picture) != r) {
      return Fail("the rectangle of cell {} leaves the {} x {} px picture of camera {}", cell,
                  picture.width, picture.height, index);
    }
  }
  for (const float weight : view.weights) {
    if (!(weight >= 0 && weight <= 1)) {
      return Fail("a weight of the view of camera {} is {}; it must be between 0 and 1", index,
                  weight);
    }
  }
  const cv::Mat& informative = view.informative;
  if (!informative.empty() &&
      (informative.type() != CV_8UC1 || informative.cols != view.mask_size.width ||
       informative.rows != view.mask_size.height)) {
    return Fail(
        "the informative pixels of camera {} are {} x {}; they must be as its masks, "
        "{} x {} with one channel of 1 byte",
        index, informative.cols, informative.rows, view.mask_size.width, view.mask_size.height);
  }
  return {};
}

/// Averages over blocks of `side` x `side` pixels, as shares of 255. The sums are whole numbers; 16
/// bits hold that of a column of up to 257 pixels. kSide is `side` where the compiler is to know
/// it, or 0.
template <int kSide>
void AverageBlocks(const cv::Mat& mask, int side, cv::Mat& image) {
  if constexpr (kSide != 0) side = kSide;
  const float scale = 1.0F / static_cast<float>(255 * side * side);
  std::vector<std::uint16_t> columns(static_cast<std::size_t>(image.cols) *
                                     static_cast<std::size_t>(side));
  for (int y = 0; y < image.rows; ++y) {
    std::fill(columns.begin(), columns.end(), std::uint16_t{0});
    for (int row = y * side; row < (y + 1) * side; ++row) {
      const std::uint8_t* const pixels = mask.ptr<std::uint8_t>(row);
      for (std::size_t x = 0; x < columns.size(); ++x) {
        columns[x] = static_cast<std::uint16_t>(columns[x] + pixels[x]);
      }
    }
    float* const out = image.ptr<float>(y);
    for (int x = 0; x < image.cols; ++x) {
      int sum = 0;
      for (int i = 0; i < side; ++i) sum += columns[static_cast<std::size_t>(x * side + i)];
      out[x] = static_cast<float>(sum) * scale;
    }
  }
}

/// The mask at another size, as shares of 255.
cv::Mat Reduced(const cv::Mat& mask, ImageSize size) {
  cv::Mat image(size.height, size.width, CV_32FC1);
  const int side = mask.cols / size.width;
  if (side > 257 || side * size.width != mask.cols || side * size.height != mask.rows) {
    cv::Mat shares;
    mask.convertTo(shares, CV_32F, 1.0 / 255);
    cv::resize(shares, image, image.size(), 0, 0, cv::INTER_AREA);
    return image;
  }
  switch (side) {
    case 2:
      AverageBlocks<2>(mask, side, image);
      break;
    case 4:
      AverageBlocks<4>(mask, side, image);
      break;
    case 8:
      AverageBlocks<8>(mask, side, image);
      break;
    default:
      AverageBlocks<0>(mask, side, image);
  }
  return image;
}

}  // namespace

Result<CameraCells> MakeCameraCells(const CameraView& view, std::size_t index, std::size_t cells) {
  VANTAGE_RETURN_IF_ERROR(CheckView(view, index, cells));
  CameraCells camera;
  camera.mask_size = view.mask_size;
  camera.size = view.size;
  camera.pixels = static_cast<double>(view.size.width) * view.size.height;
  cv::Mat_<double> sums;
  if (!view.informative.empty()) {
    camera.informative = view.informative > 0;
    camera.informative_share = Reduced(camera.informative, view.size);
    camera.pixels = cv::sum(camera.informative_share)[0];
    cv::integral(camera.informative_share, sums, CV_64F);
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const cv::Rect& r = view.rectangles[cell];
    const float weight = view.weights.empty() ? 1.0F : view.weights[cell];
    if (r.empty() || weight == 0) continue;
    const double area = sums.empty()
                            ? r.area()
                            : sums(r.y + r.height, r.x + r.width) - sums(r.y + r.height, r.x) -
                                  sums(r.y, r.x + r.width) + sums(r.y, r.x);
    if (area > kMinArea) camera.cells.push_back({static_cast<CellIndex>(cell), r, weight, area});
  }
  return camera;
}

Result<Foreground> MakeForeground(const CameraCells& camera, std::size_t index,
                                  const cv::Mat& mask) {
  const auto [width, height] = camera.mask_size;
  if (mask.type() != CV_8UC1 || mask.cols != width || mask.rows != height) {
    return Fail(
        "the mask of camera {} is {} x {} px with {} channels of {} bytes; it must be "
        "{} x {} with one of 1 byte",
        index, mask.cols, mask.rows, mask.channels(), mask.elemSize1(), width, height);
  }
  if (camera.informative.empty()) return Foreground{Reduced(mask, camera.size)};
  cv::Mat informative;
  cv::bitwise_and(mask, camera.informative, informative);
  return Foreground{Reduced(informative, camera.size)};
}

}  // namespace vantage::internal
