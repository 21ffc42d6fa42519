// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/clear_mot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "vantage/metrics/matching.h"

namespace vantage {
namespace {

using metrics::FramePairs;

template <class AnyTrack>
using PointOf = typename decltype(AnyTrack::points)::value_type;

/// Which frames count, from those with truth.
class FrameSelection {
 public:
  FrameSelection(std::set<FrameIndex> with_truth, bool truth_frames_only)
      : with_truth_(std::move(with_truth)), truth_frames_only_(truth_frames_only) {
    for (const FrameIndex frame : with_truth_)
      step_ = std::gcd(step_, frame - *with_truth_.begin());
    if (step_ == 0) step_ = 1;  // a single frame
  }

  bool Contains(FrameIndex frame) const {
    if (truth_frames_only_) return with_truth_.contains(frame);
    const FrameIndex first = *with_truth_.begin();
    return frame >= first && frame <= *with_truth_.rbegin() && (frame - first) % step_ == 0;
  }

  std::int64_t count() const {
    if (truth_frames_only_) return std::ssize(with_truth_);
    return (*with_truth_.rbegin() - *with_truth_.begin()) / step_ + 1;
  }

 private:
  std::set<FrameIndex> with_truth_;
  bool truth_frames_only_;
  FrameIndex step_ = 0;
};

/// The points of one frame with the numbers of their tracks.
template <class Point>
struct Present {
  std::vector<std::size_t> tracks;
  std::vector<const Point*> points;
};

/// Sorts the points that count into frames and numbers the tracks that have any.
template <class AnyTrack, class Keep>
std::size_t Sort(const std::vector<AnyTrack>& tracks, const FrameSelection& selection,
                 const Keep& keep, std::map<FrameIndex, Present<PointOf<AnyTrack>>>& frames) {
  std::size_t used = 0;
  for (const AnyTrack& track : tracks) {
    bool counts = false;
    for (const auto& point : track.points) {
      if (!selection.Contains(point.frame) || !keep(point)) continue;
      counts = true;
      frames[point.frame].tracks.push_back(used);
      frames[point.frame].points.push_back(&point);
    }
    if (counts) ++used;
  }
  return used;
}

template <class AnyTrack, class Keep, class Distance>
Result<TrackMeasures> Evaluate(const std::vector<AnyTrack>& truth,
                               const std::vector<AnyTrack>& results, bool truth_frames_only,
                               double largest_distance, const Keep& keep,
                               const Distance& distance) {
  std::set<FrameIndex> with_truth;
  for (const AnyTrack& track : truth) {
    for (const auto& point : track.points) with_truth.insert(point.frame);
  }
  if (with_truth.empty()) return Fail("the truth is empty; there is nothing to evaluate against");
  const FrameSelection selection(std::move(with_truth), truth_frames_only);

  std::map<FrameIndex, Present<PointOf<AnyTrack>>> truth_frames, result_frames;
  const std::size_t truth_tracks = Sort(truth, selection, keep, truth_frames);
  const std::size_t result_tracks = Sort(results, selection, keep, result_frames);
  if (truth_tracks == 0) {
    return Fail("the truth has no position inside the area; check the area and the units (metres)");
  }
  for (const auto& entry : result_frames) truth_frames[entry.first];  // frames with results only

  std::vector<FramePairs> frames;
  for (const auto& [frame, marked] : truth_frames) {
    const Present<PointOf<AnyTrack>>& found = result_frames[frame];
    FramePairs& pairs = frames.emplace_back();
    pairs.truth = marked.tracks;
    pairs.results = found.tracks;
    pairs.distance = CostMatrix(pairs.truth.size(), pairs.results.size());
    for (std::size_t row = 0; row < pairs.truth.size(); ++row) {
      for (std::size_t column = 0; column < pairs.results.size(); ++column) {
        pairs.distance(row, column) = distance(*marked.points[row], *found.points[column]);
      }
    }
  }

  TrackMeasures measures;
  measures.frames = selection.count();
  measures.truth_tracks = static_cast<std::int64_t>(truth_tracks);
  measures.result_tracks = static_cast<std::int64_t>(result_tracks);
  metrics::MeasureClearMot(frames, truth_tracks, measures);
  metrics::MeasureIdentity(frames, truth_tracks, result_tracks, measures);
  metrics::MeasureDetection(frames, largest_distance, measures);
  return measures;
}

double IntersectionOverUnion(const BoxPoint& a, const BoxPoint& b) {
  const double width =
      std::min(a.left_px + a.width_px, b.left_px + b.width_px) - std::max(a.left_px, b.left_px);
  const double height =
      std::min(a.top_px + a.height_px, b.top_px + b.height_px) - std::max(a.top_px, b.top_px);
  if (width <= 0 || height <= 0) return 0;
  const double shared = width * height;
  return shared / (a.width_px * a.height_px + b.width_px * b.height_px - shared);
}

double MedianDistanceFromOrigin(const Tracks& tracks) {
  std::vector<double> distances;
  for (const Track& track : tracks) {
    for (const TrackPoint& point : track.points) {
      distances.push_back(std::hypot(point.x_m, point.y_m));
    }
  }
  if (distances.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = distances.begin() + std::ssize(distances) / 2;
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace

void VisitOptions(EvaluationOptions& options, OptionVisitor& visitor) {
  visitor.Number({"threshold", "m", "A match on the ground is nearer than this"},
                 options.threshold_m, Range::Above(0));
  visitor.Number({"min_iou", "", "A match in pictures overlaps at least this much (IoU)"},
                 options.min_iou, Range::AboveUpTo(0, 1));
  visitor.Flag({"truth_frames_only", "", "Only frames that have truth count"},
               options.truth_frames_only);
}

Result<TrackMeasures> EvaluateTracks(const Tracks& truth, const Tracks& results,
                                     const EvaluationOptions& options, const Polygon* area) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "evaluation"));
  return Evaluate(
      truth, results, options.truth_frames_only, options.threshold_m,
      [&](const TrackPoint& point) {
        return area == nullptr || area->Contains({point.x_m, point.y_m});
      },
      [&](const TrackPoint& a, const TrackPoint& b) {
        const double distance_m = std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
        return distance_m < options.threshold_m ? distance_m : CostMatrix::kForbidden;
      });
}

Result<TrackMeasures> EvaluateBoxes(const BoxTracks& truth, const BoxTracks& results,
                                    const EvaluationOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "evaluation"));
  return Evaluate(
      truth, results, options.truth_frames_only, 1, [](const BoxPoint&) { return true; },
      [&](const BoxPoint& a, const BoxPoint& b) {
        const double iou = IntersectionOverUnion(a, b);
        return iou >= options.min_iou ? 1 - iou : CostMatrix::kForbidden;
      });
}

double ScaleOfResults(const Tracks& truth, const Tracks& results) {
  return MedianDistanceFromOrigin(results) / MedianDistanceFromOrigin(truth);
}

}  // namespace vantage
