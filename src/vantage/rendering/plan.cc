// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/plan.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "vantage/rendering/drawing.h"
#include "vantage/rendering/palette.h"

namespace vantage {
namespace {

using Eigen::Vector2d;

const cv::Scalar kGround = {38, 32, 27};      // seen by nobody
const cv::Scalar kSeenGround = {84, 73, 63};  // seen by every camera
const cv::Scalar kGridLine = {120, 108, 98};
const cv::Scalar kLabel = {186, 176, 168};
const cv::Scalar kAreaLine = {236, 232, 228};
const cv::Scalar kObstacle = {60, 56, 120};
const cv::Scalar kDoor = {150, 200, 110};
const cv::Scalar kDark = {12, 10, 8};
const cv::Scalar kCamera = {250, 236, 214};

/// 1, 2 or 5 times a power of ten: the smallest that is at least `least`.
double NiceStep(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::string Number(double value) { return fmt::format("{:.6g}", value); }

}  // namespace

Plan::Plan(const Scene& scene, cv::Size size)
    : Plan(scene, scene.area.min_m(), scene.area.max_m(), size) {
  for (const SceneCamera& camera : scene.cameras) {
    DrawCamera(ground_, camera.camera, camera.name, kCamera);
  }
}

Plan::Plan(const Scene& scene, const Vector2d& low, const Vector2d& high, cv::Size size) {
  const double label_px = 26;
  unit_ = std::min(size.width, size.height) / 600.0;
  const Vector2d side = (high - low) + Vector2d::Constant(0.08 * (high - low).maxCoeff());
  pixels_per_m_ = std::min((size.width - label_px) / side.x(), (size.height - label_px) / side.y());
  center_m_ = (low + high) / 2;
  center_px_ = {(size.width + label_px) / 2 - 0.5, (size.height - label_px) / 2 - 0.5};
  ground_ = cv::Mat(size, CV_8UC3, kGround);

  DrawCoverage(scene);
  DrawGrid();
  const auto outline = [&](const Polygon& polygon) {
    std::vector<cv::Point2d> corners;
    for (const Vector2d& corner : polygon.corners_m()) corners.push_back(PixelFromGround(corner));
    return corners;
  };
  for (const Polygon& obstacle : scene.obstacles) {
    drawing::Polygon(ground_, outline(obstacle), kObstacle, 0, 0.6);
    drawing::Polygon(ground_, outline(obstacle), kObstacle, 1);
  }
  for (const Polygon& door : scene.doors) drawing::Polygon(ground_, outline(door), kDoor, 1, 0.9);
  drawing::Polygon(ground_, outline(scene.area), kAreaLine, 2, 0.8);
  DrawScaleBar();
}

cv::Point2d Plan::PixelFromGround(const Vector2d& ground_m) const {
  const Vector2d from_center = (ground_m - center_m_) * pixels_per_m_;
  return {center_px_.x + from_center.x(), center_px_.y - from_center.y()};
}

Vector2d Plan::GroundFromPixel(const cv::Point2d& pixel) const {
  return center_m_ + Vector2d(pixel.x - center_px_.x, center_px_.y - pixel.y) / pixels_per_m_;
}

void Plan::DrawCoverage(const Scene& scene) {
  const auto count = static_cast<float>(std::max<std::size_t>(scene.cameras.size(), 1));
  cv::Mat1f share(ground_.size(), 0.0f);
  for (int y = 0; y < share.rows; ++y) {
    for (int x = 0; x < share.cols; ++x) {
      const Vector2d ground_m = GroundFromPixel(cv::Point2d(x, y));
      for (const SceneCamera& seen_by : scene.cameras) {
        const auto pixel = seen_by.camera.ImageFromWorld({ground_m.x(), ground_m.y(), 0});
        if (pixel && seen_by.camera.InPicture(*pixel)) share(y, x) += 1 / count;
      }
    }
  }
  cv::blur(share, share, {3, 3});  // borders of what is seen, antialiased
  for (int y = 0; y < ground_.rows; ++y) {
    for (int x = 0; x < ground_.cols; ++x) {
      // The first camera makes most of the difference: seen or not seen.
      const double weight = std::sqrt(std::clamp(share(y, x), 0.0f, 1.0f));
      for (int c = 0; c < 3; ++c) {
        ground_.at<cv::Vec3b>(y, x)[c] =
            cv::saturate_cast<uchar>(kGround[c] + weight * (kSeenGround[c] - kGround[c]));
      }
    }
  }
}

void Plan::DrawGrid() {
  const double fine_m = NiceStep(9 / pixels_per_m_);
  const double label_m = NiceStep(48 / pixels_per_m_);
  const Vector2d low = GroundFromPixel({0.0, ground_.rows - 1.0});
  const Vector2d high = GroundFromPixel({ground_.cols - 1.0, 0.0});
  const auto lines = [&](double step_m, double opacity) {
    for (const double x : drawing::Multiples(step_m, low.x(), high.x())) {
      const double px = std::round(PixelFromGround({x, 0}).x);
      drawing::Line(ground_, {px, 0}, {px, ground_.rows - 1.0}, kGridLine, 1, opacity);
    }
    for (const double y : drawing::Multiples(step_m, low.y(), high.y())) {
      const double px = std::round(PixelFromGround({0, y}).y);
      drawing::Line(ground_, {0, px}, {ground_.cols - 1.0, px}, kGridLine, 1, opacity);
    }
  };
  lines(std::max(fine_m, 1.0), 0.16);
  lines(label_m, 0.34);

  drawing::TextStyle style{.height_px = std::max(8.0, 9 * unit_), .color = kLabel, .halo_px = 1.5};
  const double bottom = ground_.rows - 7;
  style.anchor = drawing::Anchor::kCenter;
  for (const double x : drawing::Multiples(label_m, low.x(), high.x())) {
    const double px = PixelFromGround({x, 0}).x;
    if (px < 44 || px > ground_.cols - 14) continue;
    drawing::Text(ground_, Number(x), {px, bottom}, style);
  }
  style.anchor = drawing::Anchor::kLeft;
  for (const double y : drawing::Multiples(label_m, low.y(), high.y())) {
    const double px = PixelFromGround({0, y}).y;
    if (px < 14 || px > ground_.rows - 30) continue;
    drawing::Text(ground_, Number(y), {6, px + style.height_px / 2}, style);
  }
  drawing::Text(ground_, "m", {8, bottom}, style);
}

void Plan::DrawCamera(cv::Mat& plan, const Camera& camera, const std::string& name,
                      const cv::Scalar& color) const {
  const double size = std::max(7.0, 12 * unit_);
  drawing::TextStyle style{.height_px = std::max(8.0, 9 * unit_), .color = color, .halo_px = 2};
  const Vector2d position_m = camera.center_m().head<2>();
  Vector2d looks = camera.pose().rotation.row(2).head<2>();  // optical axis on the ground
  if (looks.norm() < 1e-6) looks = Vector2d(0, 1);
  looks.normalize();
  const cv::Point2d true_px = PixelFromGround(position_m);
  // Inside the labels of the axes.
  const cv::Point2d px(std::clamp(true_px.x, size + 30, plan.cols - size - 4),
                       std::clamp(true_px.y, size + 4, plan.rows - size - 24));
  const bool outside = cv::norm(true_px - px) > 1;
  // A wedge that opens along the view; beyond the edge, an arrow towards where the camera is.
  cv::Point2d along(looks.x(), -looks.y());
  if (outside) along = (true_px - px) / cv::norm(true_px - px);
  const cv::Point2d across(-along.y, along.x);
  std::vector<cv::Point2d> shape;
  if (outside) {
    shape = {px + 0.7 * size * along, px - 0.5 * size * along + 0.55 * size * across,
             px - 0.5 * size * along - 0.55 * size * across};
  } else {
    shape = {px, px + size * along + 0.6 * size * across, px + size * along - 0.6 * size * across};
  }
  drawing::Polygon(plan, shape, kDark, 3, 0.6);
  drawing::Polygon(plan, shape, color, 0, outside ? 1 : 0.5);
  if (!outside) drawing::Disc(plan, px, 0.35 * size, color);
  const bool on_left = px.x < plan.cols / 2.0;
  style.anchor = on_left ? drawing::Anchor::kLeft : drawing::Anchor::kRight;
  drawing::Text(plan, name, {px.x + (on_left ? size + 3 : -size - 3), px.y + style.height_px / 2},
                style);
}

void Plan::DrawScaleBar() {
  const double length_m = NiceStep(44 / pixels_per_m_);
  const double length_px = length_m * pixels_per_m_;
  const cv::Point2d right(ground_.cols - 12.0, ground_.rows - 30.0);
  const cv::Point2d left(right.x - length_px, right.y);
  const cv::Scalar color = {240, 238, 236};
  for (const int rim : {2, 0}) {
    const cv::Scalar& paint = rim > 0 ? kDark : color;
    const double opacity = rim > 0 ? 0.6 : 1;
    drawing::Line(ground_, left, right, paint, 2 + rim, opacity);
    for (const cv::Point2d& end : {left, right}) {
      drawing::Line(ground_, {end.x, end.y - 4}, {end.x, end.y + 4}, paint, 1 + rim, opacity);
    }
  }
  drawing::Text(ground_, Number(length_m) + " m", {(left.x + right.x) / 2, right.y - 7},
                {.height_px = std::max(8.0, 9 * unit_),
                 .color = color,
                 .anchor = drawing::Anchor::kCenter,
                 .halo_px = 2});
}

cv::Mat Plan::Draw(const std::vector<Person>& people) const {
  cv::Mat picture = ground_.clone();
  const double radius = std::max(4.0, 7.5 * unit_);
  for (const Person& person : people) {
    std::vector<cv::Point2d> points;
    std::vector<double> color_opacity, rim_opacity;
    for (const TrailPoint& point : person.trail) {
      points.push_back(PixelFromGround(point.position_m));
      color_opacity.push_back(0.95 * (1 - point.age));
      rim_opacity.push_back(0.5 * (1 - point.age));
    }
    drawing::FadingLine(picture, points, rim_opacity, kDark, 4);
    drawing::FadingLine(picture, points, color_opacity, ColorOf(person.id), 2);
  }
  for (const Person& person : people) {
    const cv::Point2d at = PixelFromGround(person.position_m);
    const cv::Scalar color = ColorOf(person.id);
    drawing::Disc(picture, at, radius + 1.5, kDark, 0, 0.7);
    // A filled-in position shows as a ring.
    if (person.inferred) {
      drawing::Disc(picture, at, radius - 1, color, 2);
    } else {
      drawing::Disc(picture, at, radius, color);
    }
    drawing::Text(
        picture, std::to_string(static_cast<std::int64_t>(person.id)),
        {at.x + radius + 4, at.y - radius * 0.4},
        {.height_px = std::max(8.5, 10.5 * unit_), .color = color, .halo_px = 2, .bold = true});
  }
  return picture;
}

}  // namespace vantage
