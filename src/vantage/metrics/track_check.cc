// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/track_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <string_view>

#include "vantage/metrics/comparison.h"

namespace vantage {
namespace {

using metrics::BoxComparison;
using metrics::GroundComparison;
using metrics::PointOf;
using About = TrackRemark::About;

constexpr double kFar_m = 1000;  // no scene is that large
constexpr FrameIndex kMostFramesApart = 50;
// Of mean similarity. One frame off at a walk and 7 frames per second costs 0.01, and so does a
// tracker that lags behind.
constexpr double kGainWorthANote = 0.01;
constexpr double kGainThatWarns = 0.05;
constexpr std::size_t kPositionsLookedAt = 2000;

double Median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <class AnyTrack, class Visit>
void ForEachPoint(const std::vector<AnyTrack>& tracks, const Visit& visit) {
  for (const AnyTrack& track : tracks) {
    for (const auto& point : track.points) visit(track.id, point);
  }
}

template <class Comparison, class AnyTrack>
double Scale(const std::vector<AnyTrack>& truth, const std::vector<AnyTrack>& results) {
  const auto median_radius = [](const std::vector<AnyTrack>& tracks) {
    std::vector<double> radii;
    ForEachPoint(tracks, [&](TrackId, const auto& point) {
      radii.push_back(Comparison::Position(point).norm());
    });
    return Median(std::move(radii));
  };
  return median_radius(results) / median_radius(truth);
}

/// The points of each frame.
template <class Point>
using ByFrame = std::map<FrameIndex, std::vector<const Point*>>;

template <class AnyTrack>
ByFrame<PointOf<AnyTrack>> SortByFrame(const std::vector<AnyTrack>& tracks) {
  ByFrame<PointOf<AnyTrack>> frames;
  ForEachPoint(tracks, [&](TrackId, const auto& point) { frames[point.frame].push_back(&point); });
  return frames;
}

/// Tracks that are absent from frames of their file and come back.
template <class AnyTrack>
void CheckGaps(const std::vector<AnyTrack>& tracks, const ByFrame<PointOf<AnyTrack>>& frames,
               About about, std::vector<TrackRemark>& remarks) {
  std::vector<FrameIndex> present;
  for (const auto& entry : frames) present.push_back(entry.first);
  const auto place = [&](FrameIndex frame) {
    return std::lower_bound(present.begin(), present.end(), frame) - present.begin();
  };
  std::int64_t with_gap = 0;
  std::int64_t longest = 0;
  TrackRemark remark{.about = about};
  for (const AnyTrack& track : tracks) {
    std::int64_t longest_here = 0;
    for (std::size_t i = 1; i < track.points.size(); ++i) {
      const std::int64_t absent =
          place(track.points[i].frame) - place(track.points[i - 1].frame) - 1;
      longest_here = std::max(longest_here, absent);
      if (absent <= longest) continue;
      longest = absent;
      remark.at = {track.id, track.points[i].frame};
    }
    if (longest_here > 0) ++with_gap;
  }
  if (with_gap == 0) return;
  remark.text = fmt::format(
      "{} of {} tracks have gaps; the longest, {} frames, ends where id {} comes back in frame {}",
      with_gap, tracks.size(), longest, static_cast<std::int64_t>(remark.at->first),
      remark.at->second);
  remarks.push_back(std::move(remark));
}

/// Frames that one side has and the other has not.
template <class Point>
void CheckFrames(const ByFrame<Point>& truth, const ByFrame<Point>& results,
                 const EvaluationOptions& options, const TrackMeasures& measures,
                 std::vector<TrackRemark>& remarks) {
  const std::int64_t empty = measures.frames - std::ssize(truth);
  if (!options.truth_frames_only && empty > 0) {
    // Every other frame without truth: it was hardly looked at and found empty.
    remarks.push_back(
        {.about = About::kTruth,
         .warning = 2 * empty > measures.frames,
         .text = fmt::format("{} of the {} frames that count hold nobody; if they were not marked, "
                             "leave them out (truth_frames_only)",
                             empty, measures.frames)});
  }
  std::int64_t without_result = 0;
  for (const auto& entry : truth) without_result += results.contains(entry.first) ? 0 : 1;
  if (without_result > 0) {
    remarks.push_back(
        {.warning = 2 * without_result > std::ssize(truth),
         .text = fmt::format("nothing in {} of the {} frames with truth; what was there is missed",
                             without_result, truth.size())});
  }
  std::size_t outside = 0;
  for (const auto& [frame, points] : results) {
    if (frame < truth.begin()->first || frame > truth.rbegin()->first) outside += points.size();
  }
  if (outside > 0) {
    remarks.push_back({.text = fmt::format("{} positions do not count: they are before the first "
                                           "({}) or after the last ({}) frame with truth",
                                           outside, truth.begin()->first, truth.rbegin()->first)});
  }
}

void CheckFar(const Tracks& truth, const Tracks& tracks, About about,
              std::vector<TrackRemark>& remarks) {
  std::vector<double> xs, ys;
  ForEachPoint(truth, [&](TrackId, const TrackPoint& point) {
    xs.push_back(point.x_m);
    ys.push_back(point.y_m);
  });
  const Eigen::Vector2d middle(Median(std::move(xs)), Median(std::move(ys)));
  std::int64_t count = 0;
  double farthest_m = kFar_m;
  TrackRemark remark{.about = about, .warning = true};
  ForEachPoint(tracks, [&](TrackId id, const TrackPoint& point) {
    const double distance_m = (GroundComparison::Position(point) - middle).norm();
    if (distance_m > kFar_m) ++count;
    if (distance_m <= farthest_m) return;
    farthest_m = distance_m;
    remark.at = {id, point.frame};
  });
  if (count == 0) return;
  remark.text = fmt::format(
      "{} positions lie more than {} m from the middle of the truth; the farthest, id {} in frame "
      "{}, {:.4g} m",
      count, kFar_m, static_cast<std::int64_t>(remark.at->first), remark.at->second, farthest_m);
  remarks.push_back(std::move(remark));
}

void CheckScale(double scale, std::string_view unit, const TrackMeasures& measures,
                std::vector<TrackRemark>& remarks) {
  if (!std::isfinite(scale) || scale <= 0) return;
  const double size = std::max(scale, 1 / scale);
  // Feet for metres still match here and there.
  if (size < 10 && (size < 2.5 || measures.recall > 0.2)) return;
  std::string text = fmt::format("coordinates are {:.3g} times those of the truth", scale);
  for (const auto& [factor, name] : {std::pair<double, std::string_view>{1000, "millimetres"},
                                     {100, "centimetres"},
                                     {3.281, "feet"}}) {
    if (unit != "metres" || size < factor / 1.2 || size > factor * 1.2) continue;
    text += fmt::format(", as if {} were in {}", scale > 1 ? "they" : "the truth's", name);
  }
  remarks.push_back({.warning = true, .text = fmt::format("{}; both must be in {}", text, unit)});
}

/// Are the frames numbered alike? Each truth looked at takes the most similar result.
template <class Comparison, class Point>
void CheckTime(const ByFrame<Point>& truth, const ByFrame<Point>& results,
               const Comparison& comparison, std::vector<TrackRemark>& remarks) {
  if (results.empty()) return;
  std::size_t positions = 0;
  for (const auto& entry : truth) positions += entry.second.size();
  const std::size_t stride = positions / kPositionsLookedAt + 1;
  const auto mean_similarity = [&](FrameIndex later) {
    double sum = 0;
    std::size_t looked_at = 0;
    std::size_t number = 0;
    for (const auto& [frame, points] : truth) {
      if (number++ % stride != 0) continue;
      const auto found = results.find(frame + later);
      looked_at += points.size();
      if (found == results.end()) continue;
      for (const Point* point : points) {
        double best = 0;
        for (const Point* result : found->second) {
          best = std::max(best, comparison.Similarity(*point, *result));
        }
        sum += best;
      }
    }
    return sum / static_cast<double>(looked_at);
  };
  const double now = mean_similarity(0);
  double best = now;
  FrameIndex best_later = 0;
  const auto consider = [&](FrameIndex later) {
    const double moved = mean_similarity(later);
    if (moved <= best) return;
    best = moved;
    best_later = later;
  };
  for (FrameIndex apart = 1; apart <= kMostFramesApart; ++apart) {
    consider(apart);
    consider(-apart);
  }
  consider(results.begin()->first - truth.begin()->first);
  if (best < now + kGainWorthANote) return;
  remarks.push_back({.warning = best >= now + kGainThatWarns,
                     .text = fmt::format(
                         "frame numbers {} by {} would fit the truth better (mean similarity "
                         "{:.3f} in place of {:.3f}); do both files count frames alike?",
                         best_later > 0 ? "lowered" : "raised", std::abs(best_later), best, now)});
}

template <class AnyTrack, class Comparison>
std::vector<TrackRemark> Check(const std::vector<AnyTrack>& truth,
                               const std::vector<AnyTrack>& results, const Comparison& comparison,
                               std::string_view unit, const EvaluationOptions& options,
                               const TrackMeasures& measures) {
  const ByFrame<PointOf<AnyTrack>> truth_frames = SortByFrame(truth);
  const ByFrame<PointOf<AnyTrack>> result_frames = SortByFrame(results);
  std::vector<TrackRemark> remarks;
  if (truth_frames.empty()) return remarks;
  CheckScale(Scale<Comparison>(truth, results), unit, measures, remarks);
  CheckTime(truth_frames, result_frames, comparison, remarks);
  const bool explained = std::any_of(remarks.begin(), remarks.end(),
                                     [](const TrackRemark& remark) { return remark.warning; });
  if (measures.matches == 0 && !explained) {
    remarks.push_back(
        {.warning = true,
         .text = results.empty() ? "holds no position that can be used"
                 : measures.result_positions == 0
                     ? "no position is in the area in a frame that counts"
                     : "nothing matches the truth; are both in the same coordinates?"});
  }
  CheckFrames(truth_frames, result_frames, options, measures, remarks);
  CheckGaps(truth, truth_frames, About::kTruth, remarks);
  CheckGaps(results, result_frames, About::kResults, remarks);
  return remarks;
}

}  // namespace

std::vector<TrackRemark> CheckTracks(const Tracks& truth, const Tracks& results,
                                     const EvaluationOptions& options,
                                     const TrackMeasures& measures) {
  std::vector<TrackRemark> remarks =
      Check(truth, results, GroundComparison{options.threshold_m}, "metres", options, measures);
  CheckFar(truth, truth, About::kTruth, remarks);
  CheckFar(truth, results, About::kResults, remarks);
  std::stable_partition(remarks.begin(), remarks.end(),
                        [](const TrackRemark& remark) { return remark.warning; });
  return remarks;
}

std::vector<TrackRemark> CheckBoxes(const BoxTracks& truth, const BoxTracks& results,
                                    const EvaluationOptions& options,
                                    const TrackMeasures& measures) {
  std::vector<TrackRemark> remarks =
      Check(truth, results, BoxComparison{options.min_iou}, "pixels", options, measures);
  std::stable_partition(remarks.begin(), remarks.end(),
                        [](const TrackRemark& remark) { return remark.warning; });
  return remarks;
}

double ScaleOfResults(const Tracks& truth, const Tracks& results) {
  return Scale<GroundComparison>(truth, results);
}

}  // namespace vantage
