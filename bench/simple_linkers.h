// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "vantage/tracks/track.h"

/// Two linkers from frame to frame, to compare the exact one with.

namespace vantage::bench {

/// Positions in metres, by frame.
using Detections = std::vector<std::vector<Eigen::Vector2d>>;

struct SimpleOptions {
  /// A detection further than this from where a track is expected is not its own, metres.
  double gate_m = 1;
  /// A track ends after so many frames in a row without a detection.
  int max_age_frames = 10;
  /// Tracks with fewer detections are dropped. They are known from their first detection on (SORT
  /// itself, being online, would begin with the min_hits-th).
  int min_hits = 5;
  /// Of the Kalman filter: standard deviations of a person's acceleration in m per frame squared
  /// and of a detection along one axis in metres.
  double acceleration = 0.02;
  double measurement_m = 0.3;
};

/// The nearest pair of a detection and a track's last position first, then the next nearest.
Tracks LinkGreedily(const Detections& detections, const SimpleOptions& options);

/// SORT (Bewley et al., 2016) for points: Kalman filters of constant velocity, detections and
/// predictions joined by the Hungarian method.
Tracks LinkWithKalman(const Detections& detections, const SimpleOptions& options);

}  // namespace vantage::bench
