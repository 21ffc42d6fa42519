// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "bench/simple_linkers.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "vantage/metrics/assignment.h"

namespace vantage::bench {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// The last position stays.
class LastPosition {
 public:
  LastPosition(const Vector2d& position_m, const SimpleOptions&) : position_m_(position_m) {}
  void Predict() {}
  void Update(const Vector2d& detection_m) { position_m_ = detection_m; }
  const Vector2d& position_m() const { return position_m_; }

 private:
  Vector2d position_m_;
};

/// Position and velocity; the axes are independent and have the same covariance. Time in frames.
class ConstantVelocity {
 public:
  ConstantVelocity(const Vector2d& position_m, const SimpleOptions& options)
      : options_(options), position_m_(position_m) {
    const double r = options.measurement_m;
    covariance_ << r * r, 0, 0, 0.1;  // nothing is known of the velocity
  }
  void Predict() {
    Matrix2d transition, noise;
    transition << 1, 1, 0, 1;
    noise << 0.25, 0.5, 0.5, 1;  // of an acceleration that is constant during a frame
    position_m_ += velocity_;
    covariance_ = transition * covariance_ * transition.transpose() +
                  options_.acceleration * options_.acceleration * noise;
  }
  void Update(const Vector2d& detection_m) {
    const double r = options_.measurement_m;
    const Vector2d gain = covariance_.col(0) / (covariance_(0, 0) + r * r);
    const Vector2d surprise_m = detection_m - position_m_;
    position_m_ += gain(0) * surprise_m;
    velocity_ += gain(1) * surprise_m;
    covariance_ -= gain * covariance_.row(0).eval();
  }
  const Vector2d& position_m() const { return position_m_; }

 private:
  SimpleOptions options_;
  Vector2d position_m_;
  Vector2d velocity_ = Vector2d::Zero();
  Matrix2d covariance_;
};

/// For each track the number of its detection, or -1.
using Matching = std::vector<int>;

Matching MatchGreedily(const CostMatrix& distance) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t track = 0; track < distance.rows; ++track) {
    for (std::size_t detection = 0; detection < distance.columns; ++detection) {
      if (distance(track, detection) < CostMatrix::kForbidden) {
        pairs.emplace_back(distance(track, detection), track, detection);
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  Matching matching(distance.rows, -1);
  std::vector<bool> taken(distance.columns, false);
  for (const auto& [unused, track, detection] : pairs) {
    if (matching[track] >= 0 || taken[detection]) continue;
    matching[track] = static_cast<int>(detection);
    taken[detection] = true;
  }
  return matching;
}

template <class Motion>
struct Hypothesis {
  Motion motion;
  std::vector<TrackPoint> points;  // where a detection was
  FrameIndex last_frame() const { return points.back().frame; }
  void See(FrameIndex frame) {
    points.push_back(
        {.frame = frame, .x_m = motion.position_m().x(), .y_m = motion.position_m().y()});
  }
};

/// Frames without a detection are filled in on straight lines, as exact linking has positions
/// there.
Track Filled(const std::vector<TrackPoint>& points, TrackId id) {
  Track track{.id = id, .points = {points.front()}};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const TrackPoint &from = points[i - 1], &to = points[i];
    for (FrameIndex frame = from.frame + 1; frame < to.frame; ++frame) {
      const double t =
          static_cast<double>(frame - from.frame) / static_cast<double>(to.frame - from.frame);
      track.points.push_back({.frame = frame,
                              .x_m = (1 - t) * from.x_m + t * to.x_m,
                              .y_m = (1 - t) * from.y_m + t * to.y_m,
                              .inferred = true});
    }
    track.points.push_back(to);
  }
  return track;
}

template <class Motion, class Match>
Tracks Link(const Detections& detections, const SimpleOptions& options, const Match& match) {
  Tracks tracks;
  std::vector<Hypothesis<Motion>> live;
  const auto end = [&](const Hypothesis<Motion>& track) {
    if (std::ssize(track.points) < options.min_hits) return;
    tracks.push_back(Filled(track.points, TrackId{std::ssize(tracks) + 1}));
  };
  for (std::size_t f = 0; f < detections.size(); ++f) {
    const auto frame = static_cast<FrameIndex>(f);
    const std::vector<Vector2d>& seen = detections[f];
    CostMatrix distance(live.size(), seen.size());
    for (std::size_t i = 0; i < live.size(); ++i) {
      live[i].motion.Predict();
      for (std::size_t j = 0; j < seen.size(); ++j) {
        const double apart_m = (live[i].motion.position_m() - seen[j]).norm();
        if (apart_m <= options.gate_m) distance(i, j) = apart_m;
      }
    }
    std::vector<bool> taken(seen.size(), false);
    const Matching matching = match(distance);
    for (std::size_t i = 0; i < live.size(); ++i) {
      if (matching[i] < 0) continue;
      const auto j = static_cast<std::size_t>(matching[i]);
      live[i].motion.Update(seen[j]);
      live[i].See(frame);
      taken[j] = true;
    }
    std::erase_if(live, [&](const Hypothesis<Motion>& track) {
      if (frame - track.last_frame() <= options.max_age_frames) return false;
      end(track);
      return true;
    });
    for (std::size_t j = 0; j < seen.size(); ++j) {
      if (taken[j]) continue;
      live.push_back({Motion(seen[j], options), {}});
      live.back().See(frame);
    }
  }
  for (const Hypothesis<Motion>& track : live) end(track);
  return tracks;
}

}  // namespace

Tracks LinkGreedily(const Detections& detections, const SimpleOptions& options) {
  return Link<LastPosition>(detections, options, MatchGreedily);
}

Tracks LinkWithKalman(const Detections& detections, const SimpleOptions& options) {
  return Link<ConstantVelocity>(detections, options, Assign);
}

}  // namespace vantage::bench
