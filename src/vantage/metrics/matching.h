// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/metrics/assignment.h"
#include "vantage/metrics/clear_mot.h"

/// Internal to the metrics module.

namespace vantage::metrics {

/// One frame of truth and results. Tracks go by their places in TrackAnalysis::truth and results.
struct FramePairs {
  FrameIndex frame = 0;
  std::vector<std::size_t> truth;
  std::vector<std::size_t> results;
  /// Of every truth to every result; forbidden where they are too far apart to match.
  CostMatrix distance{0, 0};
  /// The same pairs as HotaAtThreshold has it, 0 to 1.
  CostMatrix similarity{0, 0};
};

/// NaN where the whole is 0.
inline double Ratio(double part, double whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN() : part / whole;
}
inline double Ratio(std::int64_t part, std::int64_t whole) {
  return Ratio(static_cast<double>(part), static_cast<double>(whole));
}

// Each takes frames in order of time and the analysis with id and positions of every object, and
// adds its measures. The first must come first.

/// Counts, MOTA, MOTP, what is known per object and per frame. The worst match has distance
/// `largest_distance`; it adds 0 to the similarity.
void MeasureClearMot(const std::vector<FramePairs>& frames, double largest_distance,
                     TrackAnalysis& analysis);
void MeasureIdentity(const std::vector<FramePairs>& frames, TrackAnalysis& analysis);
void MeasureDetection(const std::vector<FramePairs>& frames, double largest_distance,
                      TrackAnalysis& analysis);
void MeasureHota(const std::vector<FramePairs>& frames, TrackAnalysis& analysis);

}  // namespace vantage::metrics
