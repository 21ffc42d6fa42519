// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/matching.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace vantage::metrics {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// What is known of one truth track so far.
struct History {
  std::size_t result = kNone;      // matched last
  std::size_t matched_at = 0;      // number of the frame of that match
  std::size_t present_at = kNone;  // number of the last frame that the truth is in
  bool lost = false;               // missed since the last match
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

/// Lengthens the last stretch of `object`, or begins another.
void AddToSpans(FrameIndex frame, bool follows, std::optional<TrackId> result,
                ObjectMeasures& object) {
  if (follows && object.spans.back().result == result) {
    object.spans.back().last_frame = frame;
  } else {
    object.spans.push_back({frame, frame, result});
  }
}

/// Ratios of the counts.
void Finish(double distance_sum, double largest_distance, TrackAnalysis& analysis) {
  TrackMeasures& measures = analysis.measures;
  for (const ObjectMeasures& object : analysis.truth) {
    // In whole numbers: 0.8 has no exact double.
    if (5 * object.matches >= 4 * object.positions) {
      ++measures.mostly_tracked;
    } else if (5 * object.matches < object.positions) {
      ++measures.mostly_lost;
    } else {
      ++measures.partially_tracked;
    }
    measures.switches += object.switches;
    measures.fragmentations += object.fragmentations;
  }
  measures.misses = measures.truth_positions - measures.matches;
  measures.false_positives = measures.result_positions - measures.matches;
  const std::int64_t errors = measures.misses + measures.false_positives + measures.switches;
  measures.mota = 1 - Ratio(errors, measures.truth_positions);
  measures.motp = Ratio(distance_sum, static_cast<double>(measures.matches));
  measures.motp_similarity = 1 - measures.motp / largest_distance;
  measures.precision = Ratio(measures.matches, measures.result_positions);
  measures.recall = Ratio(measures.matches, measures.truth_positions);
}

}  // namespace

void MeasureClearMot(const std::vector<FramePairs>& frames, double largest_distance,
                     TrackAnalysis& analysis) {
  TrackMeasures& measures = analysis.measures;
  std::vector<History> histories(analysis.truth.size());
  std::set<std::pair<std::size_t, std::size_t>> partners;  // truth, result
  double distance_sum = 0;
  for (std::size_t time = 0; time < frames.size(); ++time) {
    const FramePairs& frame = frames[time];
    const std::vector<int> column_of = MatchFrame(frame, histories);
    FrameMeasures& here = analysis.frames.emplace_back();
    here.frame = frame.frame;
    here.truth = std::ssize(frame.truth);
    here.results = std::ssize(frame.results);
    for (std::size_t row = 0; row < column_of.size(); ++row) {
      const std::size_t truth = frame.truth[row];
      History& history = histories[truth];
      ObjectMeasures& object = analysis.truth[truth];
      const bool follows = history.present_at != kNone && history.present_at + 1 == time;
      history.present_at = time;
      if (column_of[row] < 0) {
        history.lost = history.result != kNone;
        AddToSpans(frame.frame, follows, std::nullopt, object);
        continue;
      }
      const auto column = static_cast<std::size_t>(column_of[row]);
      const std::size_t result = frame.results[column];
      const double distance = frame.distance(row, column);
      ObjectMeasures& found = analysis.results[result];
      if (history.result != kNone && history.result != result) {
        ++object.switches;
        ++here.switches;
      }
      if (history.lost) ++object.fragmentations;
      history.result = result;
      history.matched_at = time;
      history.lost = false;
      partners.emplace(truth, result);
      ++here.matches;
      here.distance_sum += distance;
      for (ObjectMeasures* side : {&object, &found}) {
        ++side->matches;
        side->distance_sum += distance;
      }
      AddToSpans(frame.frame, follows, found.id, object);
    }
    measures.truth_positions += here.truth;
    measures.result_positions += here.results;
    measures.matches += here.matches;
    distance_sum += here.distance_sum;
  }
  for (const auto& [truth, result] : partners) {
    ++analysis.truth[truth].partners;
    ++analysis.results[result].partners;
  }
  Finish(distance_sum, largest_distance, analysis);
}

void MeasureIdentity(const std::vector<FramePairs>& frames, TrackAnalysis& analysis) {
  TrackMeasures& measures = analysis.measures;
  CostMatrix together(analysis.truth.size(), analysis.results.size());  // frames where they match
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
  for (std::size_t i = 0; i < result_of.size(); ++i) {
    if (result_of[i] < 0) continue;
    ObjectMeasures& truth = analysis.truth[i];
    ObjectMeasures& result = analysis.results[static_cast<std::size_t>(result_of[i])];
    const auto matches =
        static_cast<std::int64_t>(together(i, static_cast<std::size_t>(result_of[i])));
    if (matches == 0) continue;
    truth.identity = result.id;
    result.identity = truth.id;
    truth.id_true_positives = result.id_true_positives = matches;
    measures.id_true_positives += matches;
  }
  measures.idf1 =
      Ratio(2 * measures.id_true_positives, measures.truth_positions + measures.result_positions);
  measures.idp = Ratio(measures.id_true_positives, measures.result_positions);
  measures.idr = Ratio(measures.id_true_positives, measures.truth_positions);
}

void MeasureDetection(const std::vector<FramePairs>& frames, double largest_distance,
                      TrackAnalysis& analysis) {
  TrackMeasures& measures = analysis.measures;
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
