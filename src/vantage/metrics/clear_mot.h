// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/options.h"
#include "vantage/base/result.h"
#include "vantage/geometry/polygon.h"
#include "vantage/tracks/box_track.h"
#include "vantage/tracks/track.h"

namespace vantage {

/// How tracks are compared with the truth.
struct EvaluationOptions {
  /// On the ground: a match is nearer than this, metres, threshold > 0.
  double threshold_m = 1;
  /// In pictures: a match overlaps at least this much, intersection over union, 0 < min_iou <= 1.
  double min_iou = 0.5;
  /// Which frames count. Truth may have been marked in every n-th frame only. false: every n-th
  /// frame from the first to the last that has truth, n being the greatest common divisor of the
  /// gaps between frames with truth; a frame among them without truth is one with nobody in it.
  /// true: only frames that have truth, for truth marked at irregular times.
  bool truth_frames_only = false;
};
void VisitOptions(EvaluationOptions& options, OptionVisitor& visitor);

/// CLEAR MOT (Bernardin and Stiefelhagen, 2008), identity measures (Ristani et al., 2016),
/// detection measures (Kasturi et al., 2009) and HOTA (Luiten et al., 2021). Ratios whose
/// denominator is 0 are NaN.
struct TrackMeasures {
  std::int64_t frames = 0;        ///< that count
  std::int64_t truth_tracks = 0;  ///< with at least one position that counts; also below
  std::int64_t result_tracks = 0;
  std::int64_t truth_positions = 0;  ///< GT
  std::int64_t result_positions = 0;
  std::int64_t matches = 0;            ///< TP
  std::int64_t misses = 0;             ///< FN: truth without a match
  std::int64_t false_positives = 0;    ///< FP: results without a match
  std::int64_t switches = 0;           ///< IDSW: matched to another result than the last time
  std::int64_t fragmentations = 0;     ///< times that a truth track is lost and found again later
  std::int64_t mostly_tracked = 0;     ///< truth tracks matched in at least 80 % of their frames
  std::int64_t mostly_lost = 0;        ///< in less than 20 %
  std::int64_t partially_tracked = 0;  ///< the others

  double mota = 0;  ///< 1 - (FN + FP + IDSW) / GT
  /// Two measures go by the name of MOTP. This is the first authors': mean over matches of the
  /// distance in metres, in pictures of 1 - IoU; smaller is better.
  double motp = 0;
  /// And this MOTChallenge's: mean over matches of 1 - distance / threshold, in pictures of IoU;
  /// larger is better.
  double motp_similarity = 0;
  double precision = 0;  ///< TP / (TP + FP)
  double recall = 0;     ///< TP / GT

  // Every truth track belongs to at most one result track and the other way round, so that IDTP,
  // the positions that match under this rule, is largest.
  std::int64_t id_true_positives = 0;
  double idf1 = 0;  ///< 2 IDTP / (GT + results)
  double idp = 0;   ///< IDTP / results
  double idr = 0;   ///< IDTP / GT

  // Every frame for itself, without identities: an assignment of its own.
  double moda = 0;  ///< 1 - (FN + FP) / GT
  /// Mean over matches of 1 - distance / threshold, in pictures of IoU: larger is better.
  double modp = 0;

  // Means over the thresholds of TrackAnalysis::hota.
  double hota = 0;
  double deta = 0;
  double assa = 0;
  double loca = 0;  ///< over the thresholds with a match
};

/// HOTA at one threshold `alpha` on similarity: IoU in pictures; on the ground 1 - distance / (2
/// threshold), at least 0, so that 0.5 stands for the threshold in both.
struct HotaAtThreshold {
  double alpha = 0;
  double hota = 0;  ///< sqrt(DetA AssA)
  double deta = 0;  ///< TP / (TP + FN + FP)
  /// Mean over the TP of the overlap of their two tracks, TPA / (TPA + FNA + FPA); 0 without TP.
  double assa = 0;
  double loca = 0;  ///< mean similarity of the TP
};

/// A stretch of frames in which a truth track is there and keeps one match, or has none.
struct MatchSpan {
  FrameIndex first_frame = 0;
  FrameIndex last_frame = 0;
  std::optional<TrackId> result;
  friend bool operator==(const MatchSpan&, const MatchSpan&) = default;
};

/// What became of one track of the truth or of the results, in frames and places that count.
struct ObjectMeasures {
  TrackId id{};
  FrameIndex first_frame = 0;
  FrameIndex last_frame = 0;
  std::int64_t positions = 0;
  std::int64_t matches = 0;   ///< the other positions are misses, of a result false positives
  std::int64_t partners = 0;  ///< tracks of the other side that it was ever matched to
  double distance_sum = 0;    ///< of the matches, as in TrackMeasures::motp
  /// The track of the other side that IDF1 gives it, if they meet at all, and where the two match.
  std::optional<TrackId> identity = {};
  std::int64_t id_true_positives = 0;

  // Of truth only.
  std::int64_t switches = 0;
  std::int64_t fragmentations = 0;
  std::vector<MatchSpan> spans = {};
};

/// One frame that counts.
struct FrameMeasures {
  FrameIndex frame = 0;
  std::int64_t truth = 0;
  std::int64_t results = 0;
  std::int64_t matches = 0;  ///< truth - matches are misses, results - matches false positives
  std::int64_t switches = 0;
  double distance_sum = 0;  ///< of the matches, as in TrackMeasures::motp
};

/// All figures, and where they come from.
struct TrackAnalysis {
  TrackMeasures measures;
  std::vector<HotaAtThreshold> hota;           ///< alpha = 0.05, 0.10 ... 0.95
  std::vector<ObjectMeasures> truth, results;  ///< in ascending order of id
  std::vector<FrameMeasures> frames;  ///< ascending; those with neither truth nor results left out
};

/// Compares positions on the ground. With an `area` only truth and results inside it count; a
/// person who is inside in one and just outside in the other is therefore an error. In every frame,
/// pairs matched in an earlier one stay matched as long as they are near enough; the others are
/// assigned anew so that there are as many matches as can be, with the smallest sum of distances.
/// Fails on options out of range, when no truth counts, and beyond 2000 people in a frame or 2e7
/// pairs of a truth and a result track.
Result<TrackAnalysis> AnalyzeTracks(const Tracks& truth, const Tracks& results,
                                    const EvaluationOptions& options,
                                    const Polygon* area = nullptr);

/// The same for boxes in pictures by their overlap.
Result<TrackAnalysis> AnalyzeBoxes(const BoxTracks& truth, const BoxTracks& results,
                                   const EvaluationOptions& options);

/// The figures alone.
Result<TrackMeasures> EvaluateTracks(const Tracks& truth, const Tracks& results,
                                     const EvaluationOptions& options,
                                     const Polygon* area = nullptr);
Result<TrackMeasures> EvaluateBoxes(const BoxTracks& truth, const BoxTracks& results,
                                    const EvaluationOptions& options);

}  // namespace vantage
