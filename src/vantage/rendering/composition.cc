// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/composition.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vantage/rendering/drawing.h"
#include "vantage/rendering/overlay.h"

namespace vantage {
namespace {

const cv::Scalar kBackground = {22, 18, 15};
const cv::Scalar kEmptyView = {44, 38, 33};
const cv::Scalar kMaskView = {118, 106, 96};
const cv::Scalar kBright = {240, 238, 236};
const cv::Scalar kDim = {170, 160, 152};

constexpr double kPlanShare = 0.3;  // of the width, at least

std::vector<ImageSize> PictureSizes(const Scene& scene) {
  std::vector<ImageSize> sizes;
  for (const SceneCamera& camera : scene.cameras) sizes.push_back(camera.camera.size());
  return sizes;
}

int RoundUpToEven(int value) { return value + value % 2; }

}  // namespace

void VisitOptions(RenderOptions& o, OptionVisitor& v) {
  v.Flag({"picture", "", "the video under the drawings; without it, plain dark ground"}, o.picture);
  v.Number({"trail", "s", "length of the trails"}, o.trail_secs, Range::Between(0, 600));
  v.Number({"height", "px", "largest height of the video; its width is 16/9 of that"}, o.height_px,
           Range::Between(240, 2160));
}

Layout LayOut(const std::vector<ImageSize>& views, int height_px) {
  const int gap = std::max(4, height_px / 72);
  const int width_px = RoundUpToEven(height_px * 16 / 9);
  const int count = static_cast<int>(views.size());
  Layout layout;
  layout.caption = {gap, 0, width_px - 2 * gap, std::max(20, height_px / 16)};
  const int top = layout.caption.height;
  const int max_height = height_px - top - gap;
  const int max_width = static_cast<int>((1 - kPlanShare) * width_px) - 2 * gap;

  const auto aspect = [&](int view) {
    const ImageSize& size = views[static_cast<std::size_t>(view)];
    return static_cast<double>(size.width) / size.height;
  };
  // The height of each view when they stand in so many columns: rows or the widest row limit it.
  const auto view_height = [&](int columns) {
    const int rows = (count + columns - 1) / columns;
    double height = (max_height - (rows - 1.0) * gap) / rows;
    for (int first = 0; first < count; first += columns) {
      double aspects = 0;
      for (int i = first; i < std::min(first + columns, count); ++i) aspects += aspect(i);
      height = std::min(height, (max_width - (columns - 1.0) * gap) / aspects);
    }
    return height;
  };
  int columns = 1;
  for (int candidate = 2; candidate <= count; ++candidate) {
    if (view_height(candidate) > view_height(columns)) columns = candidate;
  }
  const int height = std::max(1, static_cast<int>(view_height(columns)));
  int plan_left = gap;
  for (int i = 0; i < count; ++i) {
    const bool starts_row = i % columns == 0;
    const int left = starts_row ? gap : layout.views.back().br().x + gap;
    const int width = std::max(1, static_cast<int>(std::lround(height * aspect(i))));
    layout.views.emplace_back(left, top + i / columns * (height + gap), width, height);
    plan_left = std::max(plan_left, left + width + gap);
  }
  const int block_height = layout.views.back().br().y - top;
  layout.plan = {plan_left, top, width_px - gap - plan_left,
                 std::max(block_height, max_height / 2)};
  layout.frame = {width_px, RoundUpToEven(top + layout.plan.height + gap)};
  return layout;
}

Composition::Composition(const Scene& scene, const RenderOptions& options)
    : options_(options),
      layout_(LayOut(PictureSizes(scene), options.height_px)),
      name_(scene.name),
      frames_per_second_(scene.frames_per_second),
      area_(scene.area),
      figure_(scene.person.OrDefault()),
      plan_(scene, layout_.plan.size()) {
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const cv::Size size = layout_.views[i].size();
    camera_names_.push_back(scene.cameras[i].name);
    cameras_.push_back(scene.cameras[i].camera.Scaled({size.width, size.height}).value());
  }
}

cv::Mat Composition::Draw(const Tracks& tracks, FrameIndex frame,
                          const std::vector<cv::Mat>& pictures) const {
  const auto trail_frames =
      static_cast<FrameIndex>(std::lround(options_.trail_secs * frames_per_second_));
  const std::vector<Person> people = PeopleAt(tracks, frame, trail_frames);
  cv::Mat image(layout_.frame, CV_8UC3, kBackground);
  DrawCaption(image, frame, people.size());
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    DrawView(image, i, options_.picture ? pictures[i] : cv::Mat(), people);
  }
  plan_.Draw(people).copyTo(image(layout_.plan));
  return image;
}

void Composition::DrawCaption(cv::Mat& image, FrameIndex frame, std::size_t people) const {
  const cv::Rect& bar = layout_.caption;
  drawing::TextStyle style{.height_px = 0.3 * bar.height, .color = kBright, .bold = true};
  const double base = bar.y + 0.66 * bar.height;
  drawing::Text(image, name_, {bar.x + 2.0, base}, style);
  // Right-aligned in columns, so that the figures stand still while they change.
  style.anchor = drawing::Anchor::kRight;
  double right = bar.x + bar.width - 2.0;
  drawing::Text(image, fmt::format("{} {}", people, people == 1 ? "person" : "people"),
                {right, base}, style);
  style.bold = false;
  style.color = kDim;
  right -= 10 * style.height_px;
  drawing::Text(image, fmt::format("{:.1f} s", static_cast<double>(frame) / frames_per_second_),
                {right, base}, style);
  right -= 8 * style.height_px;
  drawing::Text(image, fmt::format("frame {}", frame), {right, base}, style);
}

void Composition::DrawView(cv::Mat& image, std::size_t index, const cv::Mat& picture,
                           const std::vector<Person>& people) const {
  cv::Mat view = image(layout_.views[index]);
  view.setTo(kEmptyView);
  const bool has_picture = !picture.empty();
  if (has_picture) {
    const bool smaller = picture.cols > view.cols;
    cv::Mat scaled;
    cv::resize(picture, scaled, view.size(), 0, 0, smaller ? cv::INTER_AREA : cv::INTER_LINEAR);
    if (scaled.type() == CV_8UC3) {
      scaled.copyTo(view);
    } else {
      view.setTo(kMaskView, scaled >= 128);
    }
  }
  const bool video = has_picture && picture.type() == CV_8UC3;
  DrawGround(view, cameras_[index], area_, !video);
  DrawPeople(view, cameras_[index], people, figure_);
  const double height = std::max(8.0, 0.22 * layout_.caption.height);
  std::string label = cameras_.size() > 1 ? camera_names_[index] : "";
  if (options_.picture && !has_picture) label += label.empty() ? "no picture" : ": no picture";
  drawing::Text(view, label, {0.8 * height, 1.9 * height},
                {.height_px = height, .color = kBright, .halo_px = 2});
}

}  // namespace vantage
