// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/scene/blind_pixels.h"

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "vantage/video/picture.h"

namespace vantage::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kKey = "blind";

/// Corners as cv::fillPoly takes them: whole 1/2^kShift of a pixel.
constexpr int kShift = 4;
/// Keeps these within 32 bits with room for cv::fillPoly's own arithmetic.
constexpr double kFarthest_px = 100'000;
constexpr std::size_t kMaxCorners = 1000;
constexpr std::size_t kMaxPolygons = 1000;

Result<std::vector<cv::Point>> Corners(const TableReader& table, std::size_t number,
                                       const std::vector<std::vector<double>>& rows) {
  if (rows.size() < 3 || rows.size() > kMaxCorners) {
    return table.FailAt(kKey, fmt::format("polygon {} has {} corners; it must have 3 to {}", number,
                                          rows.size(), kMaxCorners));
  }
  std::vector<cv::Point> corners;
  for (const std::vector<double>& row : rows) {
    for (const double pixel : row) {
      if (std::abs(pixel) <= kFarthest_px) continue;
      return table.FailAt(kKey, fmt::format("polygon {} holds {}; its corners are pixels, between "
                                            "-{} and {}",
                                            number, pixel, kFarthest_px, kFarthest_px));
    }
    corners.emplace_back(static_cast<int>(std::lround(row[0] * (1 << kShift))),
                         static_cast<int>(std::lround(row[1] * (1 << kShift))));
  }
  return corners;
}

Result<cv::Mat> DrawPolygons(const TableReader& table, ImageSize size) {
  VANTAGE_ASSIGN_OR_RETURN(const auto polygons, table.ListOfRows(kKey, 2));
  if (polygons.empty()) return cv::Mat();
  if (polygons.size() > kMaxPolygons) {
    return table.FailAt(kKey, fmt::format("has {} polygons; it may have {}, or name a picture",
                                          polygons.size(), kMaxPolygons));
  }
  if (const Status status = CheckPictureSize("the camera", size.width, size.height); !status) {
    return table.FailAt(kKey, status.error().message);
  }
  cv::Mat blind = cv::Mat::zeros(size.height, size.width, CV_8UC1);
  const cv::Rect picture(0, 0, size.width << kShift, size.height << kShift);
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    VANTAGE_ASSIGN_OR_RETURN(const std::vector<cv::Point> corners,
                             Corners(table, i + 1, polygons[i]));
    if ((cv::boundingRect(corners) & picture).empty()) {
      return table.FailAt(kKey, fmt::format("polygon {} lies outside the {} x {} px picture; its "
                                            "corners are [x, y]",
                                            i + 1, size.width, size.height));
    }
    cv::fillPoly(blind, std::vector{corners}, cv::Scalar(255), cv::LINE_8, kShift);
  }
  return blind;
}

/// Where the picture is not black.
Result<cv::Mat> ReadMask(const TableReader& table, const fs::path& path, ImageSize size) {
  VANTAGE_ASSIGN_OR_RETURN(const cv::Mat picture, ReadPicture(path));
  if (picture.cols != size.width || picture.rows != size.height) {
    return table.FailAt(
        kKey, fmt::format("{} is {} x {} px; it must be {} x {} px, as the camera is calibrated",
                          path.string(), picture.cols, picture.rows, size.width, size.height));
  }
  cv::Mat blind;
  cv::inRange(picture, cv::Scalar::all(0), cv::Scalar::all(0), blind);
  cv::bitwise_not(blind, blind);
  return cv::countNonZero(blind) == 0 ? cv::Mat() : blind;
}

}  // namespace

Result<cv::Mat> ReadBlindPixels(const TableReader& table, const fs::path& folder, ImageSize size,
                                std::vector<fs::path>& inputs) {
  if (!table.Has(kKey)) return cv::Mat();
  const auto read = [&]() -> Result<cv::Mat> {
    if (!table.HasText(kKey)) return DrawPolygons(table, size);
    VANTAGE_ASSIGN_OR_RETURN(const std::string path, table.Text(kKey));
    inputs.push_back(folder / path);
    return ReadMask(table, inputs.back(), size);
  };
  VANTAGE_ASSIGN_OR_RETURN(const cv::Mat blind, read());
  if (!blind.empty() && cv::countNonZero(blind) == size.width * size.height) {
    return table.FailAt(kKey, "covers the whole picture; leave out a camera that sees nothing");
  }
  return blind;
}

}  // namespace vantage::internal
