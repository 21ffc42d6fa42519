// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/matching.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vantage::metrics {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

double Ratio(double part, double whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN() : part / whole;
}

double Ratio(std::int64_t part, std::int64_t whole) {
  return Ratio(static_cast<double>(part), static_cast<double>(whole));
}

/// What is known of one truth track so far.
struct History {
  std::size_t result = kNone;  // matched last
  std::size_t matched_at = 0;  // number of the frame of that match
  std::int64_t frames = 0;
  std::int64_t matches = 0;
  bool lost = false;  // missed since the last match
};

/// Row by row the column of the result that the truth was matched to last, where that still holds.
/// Where two truths claim one result the later match has it.
std::vector<int> KeptMatches(const FramePairs& frame, const std::vector<History>& histories) {
  std::vector<std::size_t> rows(frame.truth.size());
  for (std::size_t row = 0; row < rows.size(); ++row) rows[row] = row;
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
    return histories[frame.truth[a]].matched_at > histories[frame.truth[b]].matched_at;
  });
  std::vector<int> column_of(frame.truth.size(), -1);
  std::vector<bool> taken(frame.results.size(), false);
  for (const std::size_t row : rows) {
    const History& history = histories[frame.truth[row]];
    const auto found = std::find(frame.results.begin(), frame.results.end(), history.result);
    if (found == frame.results.end()) continue;
    const auto column = static_cast<std::size_t>(found - frame.results.begin());
    if (taken[column] || !std::isfinite(frame.distance(row, column))) continue;
    taken[column] = true;
    column_of[row] = static_cast<int>(column);
  }
  return column_of;
}

/// Kept matches, then an assignment of what is left.
std::vector<int> MatchFrame(const FramePairs& frame, const std::vector<History>& histories) {
  std::vector<int> column_of = KeptMatches(frame, histories);
  std::vector<bool> taken(frame.results.size(), false);
  for (const int column : column_of) {
    if (column >= 0) taken[static_cast<std::size_t>(column)] = true;
  }
  CostMatrix left = frame.distance;
  for (std::size_t row = 0; row < left.rows; ++row) {
    for (std::size_t column = 0; column < left.columns; ++column) {
      if (taken[column] || column_of[row] >= 0) left(row, column) = CostMatrix::kForbidden;
    }
  }
  const std::vector<int> assigned = Assign(left);
  for (std::size_t row = 0; row < left.rows; ++row) {
    if (assigned[row] >= 0) column_of[row] = assigned[row];
  }
  return column_of;
}

}  // namespace

void MeasureClearMot(const std::vector<FramePairs>& frames, std::size_t truth_tracks,
                     TrackMeasures& measures) {
  std::vector<History> histories(truth_tracks);
  double distance_sum = 0;
  for (std::size_t time = 0; time < frames.size(); ++time) {
    const FramePairs& frame = frames[time];
    const std::vector<int> column_of = MatchFrame(frame, histories);
    std::int64_t matches = 0;
    for (std::size_t row = 0; row < column_of.size(); ++row) {
      History& history = histories[frame.truth[row]];
      ++history.frames;
      if (column_of[row] < 0) {
        history.lost = history.result != kNone;
        continue;
      }
      const auto column = static_cast<std::size_t>(column_of[row]);
      const std::size_t result = frame.results[column];
      if (history.result != kNone && history.result != result) ++measures.switches;
      if (history.lost) ++measures.fragmentations;
      history.result = result;
      history.matched_at = time;
      history.lost = false;
      ++history.matches;
      ++matches;
      distance_sum += frame.distance(row, column);
    }
    measures.truth_positions += std::ssize(frame.truth);
    measures.result_positions += std::ssize(frame.results);
    measures.matches += matches;
  }
  measures.misses = measures.truth_positions - measures.matches;
  measures.false_positives = measures.result_positions - measures.matches;
  for (const History& history : histories) {
    // In whole numbers: 0.8 has no exact double.
    if (5 * history.matches >= 4 * history.frames) {
      ++measures.mostly_tracked;
    } else if (5 * history.matches < history.frames) {
      ++measures.mostly_lost;
    } else {
      ++measures.partially_tracked;
    }
  }
  const std::int64_t errors = measures.misses + measures.false_positives + measures.switches;
  measures.mota = 1 - Ratio(errors, measures.truth_positions);
  measures.motp = Ratio(distance_sum, static_cast<double>(measures.matches));
  measures.precision = Ratio(measures.matches, measures.result_positions);
  measures.recall = Ratio(measures.matches, measures.truth_positions);
}

void MeasureIdentity(const std::vector<FramePairs>& frames, std::size_t truth_tracks,
                     std::size_t result_tracks, TrackMeasures& measures) {
  CostMatrix together(truth_tracks, result_tracks);  // frames in which the two match
  std::fill(together.values.begin(), together.values.end(), 0);
  for (const FramePairs& frame : frames) {
    for (std::size_t row = 0; row < frame.truth.size(); ++row) {
      for (std::size_t column = 0; column < frame.results.size(); ++column) {
        if (!std::isfinite(frame.distance(row, column))) continue;
        together(frame.truth[row], frame.results[column]) += 1;
      }
    }
  }
  double most = 0;
  for (const double value : together.values) most = std::max(most, value);
  CostMatrix cost = together;
  for (double& value : cost.values) value = most - value;
  const std::vector<int> result_of = Assign(cost);
  for (std::size_t truth = 0; truth < truth_tracks; ++truth) {
    if (result_of[truth] < 0) continue;
    measures.id_true_positives +=
        static_cast<std::int64_t>(together(truth, static_cast<std::size_t>(result_of[truth])));
  }
  measures.idf1 =
      Ratio(2 * measures.id_true_positives, measures.truth_positions + measures.result_positions);
  measures.idp = Ratio(measures.id_true_positives, measures.result_positions);
  measures.idr = Ratio(measures.id_true_positives, measures.truth_positions);
}

void MeasureDetection(const std::vector<FramePairs>& frames, double largest_distance,
                      TrackMeasures& measures) {
  std::int64_t matches = 0;
  double quality_sum = 0;
  for (const FramePairs& frame : frames) {
    const std::vector<int> column_of = Assign(frame.distance);
    for (std::size_t row = 0; row < column_of.size(); ++row) {
      if (column_of[row] < 0) continue;
      ++matches;
      quality_sum +=
          1 - frame.distance(row, static_cast<std::size_t>(column_of[row])) / largest_distance;
    }
  }
  const std::int64_t errors = measures.truth_positions + measures.result_positions - 2 * matches;
  measures.moda = 1 - Ratio(errors, measures.truth_positions);
  measures.modp = Ratio(quality_sum, static_cast<double>(matches));
}

}  // namespace vantage::metrics
