// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/clear_mot.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "vantage/metrics/comparison.h"
#include "vantage/metrics/matching.h"

namespace vantage {
namespace {

using metrics::FramePairs;
using metrics::PointOf;

constexpr std::size_t kMostPerFrame = 2000;  // an assignment takes their third power
constexpr double kMostPairsOfTracks = 2e7;   // 160 MB a table

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
std::vector<ObjectMeasures> Sort(const std::vector<AnyTrack>& tracks,
                                 const FrameSelection& selection, const Keep& keep,
                                 std::map<FrameIndex, Present<PointOf<AnyTrack>>>& frames) {
  std::vector<ObjectMeasures> objects;
  for (const AnyTrack& track : tracks) {
    ObjectMeasures object{.id = track.id};
    for (const auto& point : track.points) {
      if (!selection.Contains(point.frame) || !keep(point)) continue;
      if (object.positions++ == 0) object.first_frame = point.frame;
      object.last_frame = point.frame;
      frames[point.frame].tracks.push_back(objects.size());
      frames[point.frame].points.push_back(&point);
    }
    if (object.positions > 0) objects.push_back(std::move(object));
  }
  return objects;
}

template <class AnyTrack, class Comparison, class Keep>
Result<TrackAnalysis> Analyze(const std::vector<AnyTrack>& truth,
                              const std::vector<AnyTrack>& results, bool truth_frames_only,
                              const Comparison& comparison, const Keep& keep) {
  std::set<FrameIndex> with_truth;
  for (const AnyTrack& track : truth) {
    for (const auto& point : track.points) with_truth.insert(point.frame);
  }
  if (with_truth.empty()) return Fail("the truth is empty; there is nothing to evaluate against");
  const FrameSelection selection(std::move(with_truth), truth_frames_only);

  TrackAnalysis analysis;
  std::map<FrameIndex, Present<PointOf<AnyTrack>>> truth_frames, result_frames;
  analysis.truth = Sort(truth, selection, keep, truth_frames);
  analysis.results = Sort(results, selection, keep, result_frames);
  if (analysis.truth.empty()) {
    return Fail("the truth has no position inside the area; check the area and the units (metres)");
  }
  if (static_cast<double>(analysis.truth.size()) * static_cast<double>(analysis.results.size()) >
      kMostPairsOfTracks) {
    return Fail(
        "{} tracks of truth and {} of results make more than {} pairs, too many to compare; cut "
        "the recording into parts",
        analysis.truth.size(), analysis.results.size(), kMostPairsOfTracks);
  }
  for (const auto& entry : result_frames) truth_frames[entry.first];  // frames with results only

  std::vector<FramePairs> frames;
  for (const auto& [frame, marked] : truth_frames) {
    const Present<PointOf<AnyTrack>>& found = result_frames[frame];
    if (std::max(marked.tracks.size(), found.tracks.size()) > kMostPerFrame) {
      return Fail("frame {} has {} of truth and {} of results; at most {} each can be compared",
                  frame, marked.tracks.size(), found.tracks.size(), kMostPerFrame);
    }
    FramePairs& pairs = frames.emplace_back();
    pairs.frame = frame;
    pairs.truth = marked.tracks;
    pairs.results = found.tracks;
    pairs.distance = pairs.similarity = CostMatrix(pairs.truth.size(), pairs.results.size());
    for (std::size_t row = 0; row < pairs.truth.size(); ++row) {
      for (std::size_t column = 0; column < pairs.results.size(); ++column) {
        const auto& a = *marked.points[row];
        const auto& b = *found.points[column];
        pairs.distance(row, column) = comparison.Distance(a, b);
        pairs.similarity(row, column) = comparison.Similarity(a, b);
      }
    }
  }

  analysis.measures.frames = selection.count();
  analysis.measures.truth_tracks = std::ssize(analysis.truth);
  analysis.measures.result_tracks = std::ssize(analysis.results);
  metrics::MeasureClearMot(frames, comparison.LargestDistance(), analysis);
  metrics::MeasureIdentity(frames, analysis);
  metrics::MeasureDetection(frames, comparison.LargestDistance(), analysis);
  metrics::MeasureHota(frames, analysis);
  return analysis;
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

Result<TrackAnalysis> AnalyzeTracks(const Tracks& truth, const Tracks& results,
                                    const EvaluationOptions& options, const Polygon* area) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "evaluation"));
  return Analyze(truth, results, options.truth_frames_only,
                 metrics::GroundComparison{options.threshold_m}, [&](const TrackPoint& point) {
                   return area == nullptr || area->Contains({point.x_m, point.y_m});
                 });
}

Result<TrackAnalysis> AnalyzeBoxes(const BoxTracks& truth, const BoxTracks& results,
                                   const EvaluationOptions& options) {
  VANTAGE_RETURN_IF_ERROR(ValidateOptions(options, "evaluation"));
  return Analyze(truth, results, options.truth_frames_only, metrics::BoxComparison{options.min_iou},
                 [](const BoxPoint&) { return true; });
}

Result<TrackMeasures> EvaluateTracks(const Tracks& truth, const Tracks& results,
                                     const EvaluationOptions& options, const Polygon* area) {
  VANTAGE_ASSIGN_OR_RETURN(const TrackAnalysis analysis,
                           AnalyzeTracks(truth, results, options, area));
  return analysis.measures;
}

Result<TrackMeasures> EvaluateBoxes(const BoxTracks& truth, const BoxTracks& results,
                                    const EvaluationOptions& options) {
  VANTAGE_ASSIGN_OR_RETURN(const TrackAnalysis analysis, AnalyzeBoxes(truth, results, options));
  return analysis.measures;
}

}  // namespace vantage
