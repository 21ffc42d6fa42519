// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace vantage::drawing {
namespace {

constexpr int kShift = 4;  // OpenCV's fixed-point coordinates: 1/16 of a pixel
constexpr double kFraction = 1 << kShift;

bool Finite(const cv::Point2d& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

/// Laid over a part of a picture: shapes are drawn into `mask` as opacities, then blended at once,
/// so that they do not darken themselves where they overlap.
class Layer {
 public:
  /// Covers what of `bounds` lies in the picture.
  Layer(cv::Mat& image, const cv::Rect2d& bounds) : image_(image) {
    const double left = std::max(std::floor(bounds.x), 0.0);
    const double top = std::max(std::floor(bounds.y), 0.0);
    const double right = std::min(std::ceil(bounds.x + bounds.width) + 1, double(image.cols));
    const double bottom = std::min(std::ceil(bounds.y + bounds.height) + 1, double(image.rows));
    if (!(right > left && bottom > top)) return;
    area_ = cv::Rect(int(left), int(top), int(right - left), int(bottom - top));
    mask = cv::Mat1b::zeros(area_.size());
  }
  bool empty() const { return mask.empty(); }

  /// Fixed-point position in the mask.
  cv::Point At(const cv::Point2d& p) const {
    return {static_cast<int>(std::lround((p.x - area_.x) * kFraction)),
            static_cast<int>(std::lround((p.y - area_.y) * kFraction))};
  }

  void Blend(const cv::Scalar& color, double opacity) {
    const int weight = static_cast<int>(std::lround(std::clamp(opacity, 0.0, 1.0) * 256));
    const int bgr[3] = {int(color[0]), int(color[1]), int(color[2])};
    for (int y = 0; y < area_.height; ++y) {
      const uchar* alpha = mask.ptr<uchar>(y);
      uchar* pixel = image_.ptr<uchar>(area_.y + y) + 3 * area_.x;
      for (int x = 0; x < area_.width; ++x, pixel += 3) {
        if (alpha[x] == 0) continue;
        const int a = alpha[x] * weight;  // of 255 * 256
        for (int c = 0; c < 3; ++c) {
          pixel[c] = static_cast<uchar>(pixel[c] + (bgr[c] - pixel[c]) * a / (255 * 256));
        }
      }
    }
  }

  cv::Mat1b mask;

 private:
  cv::Mat& image_;
  cv::Rect area_;
};

cv::Rect2d BoundsOf(const std::vector<cv::Point2d>& points, double margin) {
  double min_x = INFINITY, min_y = INFINITY, max_x = -INFINITY, max_y = -INFINITY;
  for (const cv::Point2d& p : points) {
    if (!Finite(p)) continue;
    min_x = std::min(min_x, p.x);
    min_y = std::min(min_y, p.y);
    max_x = std::max(max_x, p.x);
    max_y = std::max(max_y, p.y);
  }
  return {min_x - margin, min_y - margin, max_x - min_x + 2 * margin, max_y - min_y + 2 * margin};
}

/// The part of a segment near the picture (Liang and Barsky); false when there is none. Fixed-point
/// coordinates overflow far outside.
bool Clip(const cv::Mat& image, cv::Point2d& a, cv::Point2d& b) {
  if (!Finite(a) || !Finite(b)) return false;
  constexpr double kMargin = 64;
  double from = 0, to = 1;
  const cv::Point2d d = b - a;
  const auto cut = [&](double slope, double room) {
    if (slope == 0) return room >= 0;
    const double t = room / slope;
    if (slope < 0) {
      from = std::max(from, t);
    } else {
      to = std::min(to, t);
    }
    return from <= to;
  };
  if (!cut(-d.x, a.x + kMargin) || !cut(d.x, image.cols + kMargin - a.x) ||
      !cut(-d.y, a.y + kMargin) || !cut(d.y, image.rows + kMargin - a.y)) {
    return false;
  }
  const cv::Point2d start = a;
  a = start + from * d;
  b = start + to * d;
  return true;
}

/// The text's opacities with a rim of `margin` pixels, drawn large and reduced: OpenCV's own
/// antialiasing leaves small type ragged. `base` is the base line's start in it.
constexpr int kOversampling = 4;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapitalHeight = 21;  // of that font at scale 1

double FontScale(const TextStyle& style) {
  return kOversampling * style.height_px / kCapitalHeight;
}
int FontThickness(const TextStyle& style) {
  return std::max(1, cvRound((style.bold ? 0.19 : 0.135) * kOversampling * style.height_px));
}

cv::Mat1b LargeText(const std::string& text, const TextStyle& style, int margin, cv::Size size,
                    int thickness, cv::Point2d fraction) {
  cv::Mat1b large = cv::Mat1b::zeros(size * kOversampling);
  const cv::Point base(cvRound((margin + fraction.x) * kOversampling),
                       cvRound((margin + std::ceil(style.height_px) + fraction.y) * kOversampling));
  cv::putText(large, text, base, kFont, FontScale(style), cv::Scalar(255), thickness, cv::LINE_AA);
  cv::Mat1b small;
  cv::resize(large, small, size, 0, 0, cv::INTER_AREA);
  return small;
}

}  // namespace

void FadingLine(cv::Mat& image, const std::vector<cv::Point2d>& points,
                const std::vector<double>& opacity, const cv::Scalar& color, int thickness_px) {
  Layer layer(image, BoundsOf(points, thickness_px + 1));
  if (layer.empty()) return;
  for (std::size_t i = 1; i < points.size(); ++i) {
    cv::Point2d a = points[i - 1];
    cv::Point2d b = points[i];
    if (!Clip(image, a, b)) continue;
    cv::line(layer.mask, layer.At(a), layer.At(b), cv::Scalar(255 * opacity[i]), thickness_px,
             cv::LINE_AA, kShift);
  }
  layer.Blend(color, 1);
}

void Line(cv::Mat& image, cv::Point2d from, cv::Point2d to, const cv::Scalar& color,
          int thickness_px, double opacity) {
  FadingLine(image, {from, to}, {opacity, opacity}, color, thickness_px);
}

void Rectangle(cv::Mat& image, const cv::Rect2d& box, const cv::Scalar& color, int thickness_px,
               double opacity) {
  const cv::Point2d low = box.tl();
  const cv::Point2d high = box.br();
  FadingLine(image, {low, {high.x, low.y}, high, {low.x, high.y}, low},
             std::vector<double>(5, opacity), color, thickness_px);
}

void FilledRectangle(cv::Mat& image, const cv::Rect2d& box, const cv::Scalar& color,
                     double opacity) {
  const cv::Rect2d pixels(std::round(box.x), std::round(box.y), std::round(box.width) - 1,
                          std::round(box.height) - 1);
  Layer layer(image, pixels);
  if (layer.empty()) return;
  layer.mask.setTo(255);
  layer.Blend(color, opacity);
}

void Disc(cv::Mat& image, cv::Point2d center, double radius_px, const cv::Scalar& color,
          int thickness_px, double opacity) {
  if (!Finite(center)) return;
  const double reach = radius_px + thickness_px + 1;
  Layer layer(image, {center.x - reach, center.y - reach, 2 * reach, 2 * reach});
  if (layer.empty()) return;
  cv::circle(layer.mask, layer.At(center), static_cast<int>(std::lround(radius_px * kFraction)),
             cv::Scalar(255), thickness_px > 0 ? thickness_px : cv::FILLED, cv::LINE_AA, kShift);
  layer.Blend(color, opacity);
}

void Polygon(cv::Mat& image, const std::vector<cv::Point2d>& corners, const cv::Scalar& color,
             int outline_px, double opacity) {
  if (outline_px > 0) {
    std::vector<cv::Point2d> closed = corners;
    closed.push_back(corners.front());
    FadingLine(image, closed, std::vector<double>(closed.size(), opacity), color, outline_px);
    return;
  }
  Layer layer(image, BoundsOf(corners, 1));
  if (layer.empty()) return;
  std::vector<cv::Point> fixed;
  for (const cv::Point2d& corner : corners) {
    if (!Finite(corner) || std::abs(corner.x) > 1e6 || std::abs(corner.y) > 1e6) return;
    fixed.push_back(layer.At(corner));
  }
  cv::fillPoly(layer.mask, std::vector{fixed}, cv::Scalar(255), cv::LINE_AA, kShift);
  layer.Blend(color, opacity);
}

double TextWidth(const std::string& text, const TextStyle& style) {
  int base_line = 0;
  return cv::getTextSize(text, kFont, FontScale(style), FontThickness(style), &base_line).width /
         double(kOversampling);
}

void Text(cv::Mat& image, const std::string& text, cv::Point2d at, const TextStyle& style) {
  if (!Finite(at) || text.empty()) return;
  const double width = TextWidth(text, style);
  if (style.anchor == Anchor::kCenter) at.x -= width / 2;
  if (style.anchor == Anchor::kRight) at.x -= width;
  const int margin = static_cast<int>(std::ceil(style.halo_px + 0.3 * style.height_px)) + 1;
  const cv::Point2d corner(at.x - margin, at.y - margin - std::ceil(style.height_px));
  const cv::Point2d whole(std::floor(corner.x), std::floor(corner.y));
  const cv::Size size(static_cast<int>(std::ceil(width)) + 2 * margin + 1,
                      static_cast<int>(std::ceil(style.height_px)) + 2 * margin + 1);
  const auto blend = [&](const cv::Scalar& color, int thickness, double opacity) {
    Layer layer(image, {whole.x, whole.y, size.width - 1.0, size.height - 1.0});
    if (layer.empty()) return;
    const cv::Mat1b letters = LargeText(text, style, margin, size, thickness, corner - whole);
    const cv::Point skipped(std::max(0, -static_cast<int>(whole.x)),
                            std::max(0, -static_cast<int>(whole.y)));
    letters(cv::Rect(skipped, layer.mask.size())).copyTo(layer.mask);
    layer.Blend(color, opacity);
  };
  const int thickness = FontThickness(style);
  if (style.halo_px > 0) {
    blend({12, 10, 8}, thickness + cvRound(2 * style.halo_px * kOversampling), 0.7);
  }
  blend(style.color, thickness, 1);
}

void Caption(cv::Mat& image, const std::vector<CaptionLine>& lines) {
  const double height_px = std::max(8.0, image.rows / 64.0);
  TextStyle style{.height_px = height_px, .bold = true};
  double width_px = 0;
  for (const CaptionLine& line : lines) width_px = std::max(width_px, TextWidth(line.text, style));
  const double line_px = 1.9 * height_px;
  FilledRectangle(
      image,
      {0, 0, width_px + 1.8 * height_px, line_px * static_cast<double>(lines.size()) + height_px},
      {38, 32, 27}, 0.75);
  double base = 0;
  for (const CaptionLine& line : lines) {
    style.color = line.color;
    Text(image, line.text, {0.9 * height_px, base += line_px}, style);
  }
}

std::vector<double> Multiples(double step, double low, double high) {
  std::vector<double> multiples;
  const auto last = static_cast<std::int64_t>(std::floor(high / step));
  for (auto i = static_cast<std::int64_t>(std::ceil(low / step)); i <= last; ++i) {
    multiples.push_back(static_cast<double>(i) * step);
  }
  return multiples;
}

}  // namespace vantage::drawing
