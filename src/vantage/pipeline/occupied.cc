// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/occupied.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>

namespace vantage {
namespace {

using Eigen::Vector2d;

// Two positions nearer than this are the same place.
constexpr double kPlace_m = 1.0;

/// Where somebody is believed to stand; none for tracks seen in fewer frames than `least` and for
/// those that move faster.
std::optional<Vector2d> StandsAt(const Track& track, double least, double speed_per_frame_m) {
  std::vector<const TrackPoint*> seen;
  for (const TrackPoint& point : track.points) {
    if (!point.inferred) seen.push_back(&point);
  }
  if (seen.empty() || static_cast<double>(seen.size()) < least) return {};
  // The means of both halves: positions along a single camera's view are uncertain.
  const auto mean = [&](std::size_t begin, std::size_t end) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      sum += Eigen::Vector3d(seen[i]->x_m, seen[i]->y_m, static_cast<double>(seen[i]->frame));
    }
    return Eigen::Vector3d(sum / static_cast<double>(std::max<std::size_t>(end - begin, 1)));
  };
  const std::size_t middle = seen.size() / 2;
  if (middle > 0) {
    const Eigen::Vector3d moved = mean(middle, seen.size()) - mean(0, middle);
    if (moved.head<2>().norm() > speed_per_frame_m * moved.z()) return {};
  }
  return mean(0, seen.size()).head<2>();
}

/// The pixels of `box` grown on each side by `margin` of its height, inside the picture.
cv::Rect Pixels(const PixelBox& box, double margin, ImageSize size) {
  const double grown_px = margin * box.height();
  const auto clip = [](double value, int end) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(end)));
  };
  const int left = clip(std::floor(box.min_x - grown_px), size.width);
  const int top = clip(std::floor(box.min_y - grown_px), size.height);
  const int right = clip(std::ceil(box.max_x + grown_px) + 1, size.width);
  const int bottom = clip(std::ceil(box.max_y + grown_px) + 1, size.height);
  return {left, top, right - left, bottom - top};
}

}  // namespace

void VisitOptions(HoldOptions& o, OptionVisitor& v) {
  v.Flag({"standing", "", "keep people who stand from fading into the background"}, o.standing);
  v.Number({"window", "s", "last stretch in which tracks are looked for"}, o.window_secs,
           Range::Between(0.1, 10));
  v.Number({"presence", "", "share of its frames in which somebody must be seen"}, o.presence,
           Range::AboveUpTo(0, 1));
  v.Number({"max_speed", "m/s", "who is slower stands"}, o.max_speed, Range::Above(0));
  v.Number({"margin", "", "growth of a person's rectangle, as a share of its height"}, o.margin,
           Range::Between(0, 1));
  v.Number({"limit", "s", "longest time for which a place is held"}, o.limit_secs,
           Range::AboveUpTo(0, 86400));
  v.Number({"ghost_verdicts", "", "verdicts in a row that release what is held as a ghost"},
           o.ghost_verdicts, Range::AtLeast(1));
}

OccupiedRegions::OccupiedRegions(std::vector<Camera> cameras, const PersonOptions& person,
                                 const HoldOptions& options, double frames_per_second)
    : cameras_(std::move(cameras)),
      person_(person),
      options_(options),
      window_frames_(
          std::max<std::int64_t>(1, std::llround(options.window_secs * frames_per_second))),
      speed_per_frame_m_(options.max_speed / frames_per_second),
      limit_frames_(options.limit_secs * frames_per_second),
      held_(cameras_.size()),
      ghosts_(cameras_.size()),
      pictures_(cameras_.size()),
      released_px_(cameras_.size()) {}

HoldReport OccupiedRegions::report() const {
  HoldReport report = report_;
  report.pictures = std::accumulate(pictures_.begin(), pictures_.end(), std::int64_t{0});
  report.released_as_ghosts_px =
      std::accumulate(released_px_.begin(), released_px_.end(), std::int64_t{0});
  return report;
}

Result<OccupiedRegions> OccupiedRegions::Create(std::vector<Camera> cameras,
                                                const PersonOptions& person,
                                                const HoldOptions& options,
                                                double frames_per_second) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "hold"));
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(person, "person"));
  if (!(frames_per_second > 0) || std::isinf(frames_per_second)) {
    return Fail("hold: the frames per second are {}; they must be above 0", frames_per_second);
  }
  return OccupiedRegions(std::move(cameras), person, options, frames_per_second);
}

void OccupiedRegions::Judge(std::size_t camera, const cv::Mat& mask, const GhostVerdict& verdict) {
  cv::Mat& held = held_[camera];
  if (held.empty()) return;
  ++pictures_[camera];
  cv::Mat& ghosts = ghosts_[camera];
  cv::Mat foreground = mask.clone();  // before ghosts were taken out of it, and the clean-up
  for (const JudgedComponent& piece : verdict.judged) {
    const cv::Rect& window = piece.component.window;
    foreground(window).setTo(255, piece.component.pixels);
    cv::Mat here = ghosts(window);
    if (piece.ghost) {
      cv::add(here, 1, here, piece.component.pixels);
    } else if (piece.decided) {
      here.setTo(0, piece.component.pixels);
    }
  }
  ghosts.setTo(0, foreground == 0);
  const cv::Mat released = held & (ghosts >= options_.ghost_verdicts);
  released_px_[camera] += cv::countNonZero(released);
  held.setTo(0, released);
}

/// The nearest place that no other track of this call stands at; a new one where none is near.
OccupiedRegions::Place& OccupiedRegions::PlaceAt(const Vector2d& position_m, FrameIndex next) {
  Place* nearest = nullptr;
  double nearest_m = kPlace_m;
  for (Place& place : places_) {
    const double distance_m = (place.first_m - position_m).norm();
    if (place.last == next || distance_m > nearest_m) continue;
    nearest = &place;
    nearest_m = distance_m;
  }
  if (nearest != nullptr) return *nearest;
  ++report_.places;
  return places_.emplace_back(Place{.first_m = position_m,
                                    .since = next,
                                    .last = next,
                                    .expired = false,
                                    .rectangles = std::vector<cv::Rect>(cameras_.size())});
}

void OccupiedRegions::Name(const Tracks& tracks, FrameIndex next) {
  std::erase_if(places_, [&](const Place& place) { return next - place.last > window_frames_; });
  const double least = options_.presence * static_cast<double>(window_frames_);
  for (const Track& track : tracks) {
    const std::optional<Vector2d> position_m = StandsAt(track, least, speed_per_frame_m_);
    if (!position_m) continue;
    Place& place = PlaceAt(*position_m, next);
    place.last = next;
    if (!place.expired && static_cast<double>(next - place.since) >= limit_frames_) {
      place.expired = true;
      ++report_.released_by_time;
    }
    for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
      const auto box = PersonBox(cameras_[camera], *position_m, person_);
      place.rectangles[camera] =
          box ? Pixels(*box, options_.margin, cameras_[camera].size()) : cv::Rect();
    }
  }
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) Draw(camera, next);
}

void OccupiedRegions::Draw(std::size_t camera, FrameIndex next) {
  const ImageSize size = cameras_[camera].size();
  cv::Mat held;
  for (const Place& place : places_) {
    const cv::Rect& rectangle = place.rectangles[camera];
    if (place.last != next || place.expired || rectangle.empty()) continue;
    if (held.empty()) held = cv::Mat::zeros(size.height, size.width, CV_8UC1);
    held(rectangle).setTo(255);
  }
  held_[camera] = held;
  cv::Mat& ghosts = ghosts_[camera];
  if (held.empty()) {
    ghosts = cv::Mat();
  } else if (ghosts.empty()) {
    ghosts = cv::Mat::zeros(size.height, size.width, CV_8UC1);
  } else {
    held.setTo(0, ghosts >= options_.ghost_verdicts);
  }
}

}  // namespace vantage
