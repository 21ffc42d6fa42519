// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "vantage/metrics/assignment.h"
#include "vantage/metrics/clear_mot.h"

/// Internal to the metrics module.

namespace vantage::metrics {

/// One frame of truth and results. Tracks are numbered from 0 here.
struct FramePairs {
  std::vector<std::size_t> truth;
  std::vector<std::size_t> results;
  /// Of every truth to every result; forbidden where they are too far apart to match.
  CostMatrix distance{0, 0};
};

/// Counts and MOTA, MOTP of frames in order of time.
void MeasureClearMot(const std::vector<FramePairs>& frames, std::size_t truth_tracks,
                     TrackMeasures& measures);
void MeasureIdentity(const std::vector<FramePairs>& frames, std::size_t truth_tracks,
                     std::size_t result_tracks, TrackMeasures& measures);
/// The worst match has distance `largest_distance`; it adds 0 to MODP.
void MeasureDetection(const std::vector<FramePairs>& frames, double largest_distance,
                      TrackMeasures& measures);

}  // namespace vantage::metrics
