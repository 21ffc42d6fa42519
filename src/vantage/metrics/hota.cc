// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <tuple>

#include "vantage/metrics/matching.h"

/// Luiten et al., "HOTA: A Higher Order Metric for Evaluating Multi-object Tracking", IJCV 2021.

namespace vantage::metrics {
namespace {

constexpr int kThresholds = 19;  // 0.05, 0.10 ... 0.95
/// A similarity that equals the threshold but for rounding is a match.
constexpr double kRounding = 1e-12;

/// How well two tracks fit as a whole: the soft count of frames that they share over the frames of
/// either. Pairs of a frame share their similarity with all whom they are similar to.
CostMatrix Alignment(const std::vector<FramePairs>& frames, const TrackAnalysis& analysis) {
  CostMatrix shared(analysis.truth.size(), analysis.results.size());
  std::fill(shared.values.begin(), shared.values.end(), 0);
  for (const FramePairs& frame : frames) {
    std::vector<double> truth_sum(frame.truth.size(), 0), result_sum(frame.results.size(), 0);
    for (std::size_t row = 0; row < truth_sum.size(); ++row) {
      for (std::size_t column = 0; column < result_sum.size(); ++column) {
        truth_sum[row] += frame.similarity(row, column);
        result_sum[column] += frame.similarity(row, column);
      }
    }
    for (std::size_t row = 0; row < truth_sum.size(); ++row) {
      for (std::size_t column = 0; column < result_sum.size(); ++column) {
        const double similarity = frame.similarity(row, column);
        if (similarity == 0) continue;
        shared(frame.truth[row], frame.results[column]) +=
            similarity / (truth_sum[row] + result_sum[column] - similarity);
      }
    }
  }
  for (std::size_t truth = 0; truth < shared.rows; ++truth) {
    for (std::size_t result = 0; result < shared.columns; ++result) {
      const double both = shared(truth, result);
      const std::int64_t positions =
          analysis.truth[truth].positions + analysis.results[result].positions;
      shared(truth, result) = both / (static_cast<double>(positions) - both);
    }
  }
  return shared;
}

struct Pair {
  std::size_t truth, result;
  double similarity;
};

/// Every frame assigned once for all thresholds, by similarity weighted with how well the two
/// tracks fit as a whole. By track of the truth, then of the results.
std::vector<Pair> MatchAllFrames(const std::vector<FramePairs>& frames,
                                 const TrackAnalysis& analysis) {
  const CostMatrix alignment = Alignment(frames, analysis);
  std::vector<Pair> pairs;
  for (const FramePairs& frame : frames) {
    CostMatrix cost(frame.truth.size(), frame.results.size());
    for (std::size_t row = 0; row < cost.rows; ++row) {
      for (std::size_t column = 0; column < cost.columns; ++column) {
        cost(row, column) =
            1 - alignment(frame.truth[row], frame.results[column]) * frame.similarity(row, column);
      }
    }
    const std::vector<int> column_of = Assign(cost);
    for (std::size_t row = 0; row < column_of.size(); ++row) {
      if (column_of[row] < 0) continue;
      const auto column = static_cast<std::size_t>(column_of[row]);
      pairs.push_back({frame.truth[row], frame.results[column], frame.similarity(row, column)});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.truth, a.result) < std::tie(b.truth, b.result);
  });
  return pairs;
}

HotaAtThreshold MeasureAt(double alpha, const std::vector<Pair>& pairs,
                          const TrackAnalysis& analysis) {
  std::int64_t matches = 0;
  double association_sum = 0;
  double similarity_sum = 0;
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    std::int64_t together = 0;  // TPA: matches of this truth track with this result track
    for (; end < pairs.size() && pairs[end].truth == pairs[begin].truth &&
           pairs[end].result == pairs[begin].result;
         ++end) {
      if (pairs[end].similarity < alpha - kRounding) continue;
      ++together;
      similarity_sum += pairs[end].similarity;
    }
    const std::int64_t either = analysis.truth[pairs[begin].truth].positions +
                                analysis.results[pairs[begin].result].positions - together;
    matches += together;
    association_sum += static_cast<double>(together) * Ratio(together, either);
  }
  HotaAtThreshold at{.alpha = alpha};
  at.deta = Ratio(matches,
                  analysis.measures.truth_positions + analysis.measures.result_positions - matches);
  at.assa = matches == 0 ? 0 : association_sum / static_cast<double>(matches);
  at.loca = Ratio(similarity_sum, static_cast<double>(matches));
  at.hota = std::sqrt(at.deta * at.assa);
  return at;
}

}  // namespace

void MeasureHota(const std::vector<FramePairs>& frames, TrackAnalysis& analysis) {
  const std::vector<Pair> pairs = MatchAllFrames(frames, analysis);
  TrackMeasures& means = analysis.measures;
  double loca_sum = 0;
  int with_match = 0;
  for (int i = 1; i <= kThresholds; ++i) {
    const HotaAtThreshold at = MeasureAt(i / 20.0, pairs, analysis);
    analysis.hota.push_back(at);
    means.hota += at.hota / kThresholds;
    means.deta += at.deta / kThresholds;
    means.assa += at.assa / kThresholds;
    if (std::isnan(at.loca)) continue;
    loca_sum += at.loca;
    ++with_match;
  }
  means.loca = Ratio(loca_sum, with_match);
}

}  // namespace vantage::metrics
