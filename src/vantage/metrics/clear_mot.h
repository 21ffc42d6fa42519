// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

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

/// CLEAR MOT (Bernardin and Stiefelhagen, 2008), identity measures (Ristani et al., 2016) and
/// detection measures (Kasturi et al., 2009). Ratios whose denominator is 0 are NaN.
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
  /// Mean over matches of the distance in metres, in pictures of 1 - IoU: smaller is better.
  double motp = 0;
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
};

/// Compares positions on the ground. With an `area` only truth and results inside it count; a
/// person who is inside in one and just outside in the other is therefore an error. In every frame,
/// pairs matched in an earlier one stay matched as long as they are near enough; the others are
/// assigned anew so that there are as many matches as can be, with the smallest sum of distances.
/// Fails on options out of range and when no truth counts.
Result<TrackMeasures> EvaluateTracks(const Tracks& truth, const Tracks& results,
                                     const EvaluationOptions& options,
                                     const Polygon* area = nullptr);

/// The same for boxes in pictures by their overlap.
Result<TrackMeasures> EvaluateBoxes(const BoxTracks& truth, const BoxTracks& results,
                                    const EvaluationOptions& options);

/// How much larger the coordinates of the results are than those of the truth (medians of distances
/// from the origin): far from 1 when one is in centimetres or frames of reference differ. NaN when
/// either has no position.
double ScaleOfResults(const Tracks& truth, const Tracks& results);

}  // namespace vantage
