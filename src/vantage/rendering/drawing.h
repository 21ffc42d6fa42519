// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

/// Drawing that OpenCV lacks: with opacity, below the pixel, and legible text. Internal to
/// rendering. Pictures are CV_8UC3 (blue, green, red); points are pixels, (0, 0) the centre of the
/// first one. Whatever lies outside the picture is clipped, however far; points that are not finite
/// are skipped.

namespace vantage::drawing {

/// Lines through `points`, each `opacity[i]` at its point; the last ones lie on top.
/// Points without a place (NaN) interrupt the line.
void FadingLine(cv::Mat& image, const std::vector<cv::Point2d>& points,
                const std::vector<double>& opacity, const cv::Scalar& color, int thickness_px);

void Line(cv::Mat& image, cv::Point2d from, cv::Point2d to, const cv::Scalar& color,
          int thickness_px, double opacity = 1);

void Rectangle(cv::Mat& image, const cv::Rect2d& box, const cv::Scalar& color, int thickness_px,
               double opacity = 1);

void FilledRectangle(cv::Mat& image, const cv::Rect2d& box, const cv::Scalar& color,
                     double opacity = 1);

/// Disc of that radius, or a ring of that thickness when it is above 0.
void Disc(cv::Mat& image, cv::Point2d center, double radius_px, const cv::Scalar& color,
          int thickness_px = 0, double opacity = 1);

/// `outline_px` 0 fills the polygon.
void Polygon(cv::Mat& image, const std::vector<cv::Point2d>& corners, const cv::Scalar& color,
             int outline_px, double opacity = 1);

/// Where a text stands: `at` is this point of the box around its capitals.
enum class Anchor { kLeft, kCenter, kRight };

struct TextStyle {
  double height_px = 12;  ///< of capitals
  cv::Scalar color = {235, 235, 235};
  Anchor anchor = Anchor::kLeft;
  double halo_px = 0;  ///< dark rim
  bool bold = false;
};

/// Width of the text in pixels.
double TextWidth(const std::string& text, const TextStyle& style);

/// `at`: on the base line. Characters beyond ASCII show as question marks.
void Text(cv::Mat& image, const std::string& text, cv::Point2d at, const TextStyle& style);

/// Lines of text on a dark ground in the upper left corner.
struct CaptionLine {
  std::string text;
  cv::Scalar color = {235, 235, 235};
};
void Caption(cv::Mat& image, const std::vector<CaptionLine>& lines);

/// The multiples of `step` (> 0) in [low, high], ascending: where the lines of a grid are.
std::vector<double> Multiples(double step, double low, double high);

}  // namespace vantage::drawing
