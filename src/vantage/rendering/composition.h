// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/base/options.h"
#include "vantage/rendering/plan.h"
#include "vantage/scene/scene.h"
#include "vantage/tracks/track.h"

namespace vantage {

struct RenderOptions {
  /// False draws people on plain dark ground, without the video under them.
  bool picture = true;
  /// Seconds of a person's way that the trail shows, 0 <= trail <= 600.
  double trail_secs = 4;
  /// Largest height of the video in pixels, 240 <= height <= 2160; its width is 16/9 of that.
  int height_px = 720;
};
void VisitOptions(RenderOptions& options, OptionVisitor& visitor);

/// Where the parts of a frame lie; both sides of `frame` are even, as video codecs want them.
struct Layout {
  cv::Size frame;
  cv::Rect caption;
  std::vector<cv::Rect> views;
  cv::Rect plan;
};

/// Views in rows on the left, equally high and as large as they can be, the plan on the right. One
/// view or more, each shown whole in its own proportions.
Layout LayOut(const std::vector<ImageSize>& views, int height_px);

/// Draws frames: every camera's view beside the plan, under a caption with the scene's name, the
/// frame's number, the time and the number of people.
class Composition {
 public:
  Composition(const Scene& scene, const RenderOptions& options);

  cv::Size size() const { return layout_.frame; }
  const Layout& layout() const { return layout_; }

  /// One frame (CV_8UC3). `pictures`: one per camera, CV_8UC3 or masks (CV_8UC1), empty where a
  /// camera has no picture at this frame; not looked at when options.picture is false.
  cv::Mat Draw(const Tracks& tracks, FrameIndex frame, const std::vector<cv::Mat>& pictures) const;

 private:
  void DrawCaption(cv::Mat& image, FrameIndex frame, std::size_t people) const;
  void DrawView(cv::Mat& image, std::size_t index, const cv::Mat& picture,
                const std::vector<Person>& people) const;

  RenderOptions options_;
  Layout layout_;
  std::string name_;
  double frames_per_second_;
  Polygon area_;
  PersonOptions figure_;
  std::vector<std::string> camera_names_;
  std::vector<Camera> cameras_;  // scaled to their views
  Plan plan_;
};

}  // namespace vantage
