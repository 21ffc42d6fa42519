// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vantage/metrics/clear_mot.h"

/// What measures alone do not tell: figures of files that do not belong together, or of a mistake
/// in one, look like those of a bad tracker.

namespace vantage {

struct TrackRemark {
  enum class About { kTruth, kResults };
  About about = About::kResults;
  /// True: probably a mistake. False: a fact that one should know to read the figures.
  bool warning = false;
  /// The position that shows it, if one does.
  std::optional<std::pair<TrackId, FrameIndex>> at = {};
  std::string text = {};  ///< one sentence without a full stop, to stand after the name of the file
};

/// Looks at tracks that were compared with these options and gave these measures. At most one
/// remark of each kind about each file:
/// - frames among those that count without any truth, or with truth but without any result; results
///   before the first or after the last frame of truth; tracks with gaps;
/// - positions far from everything in the truth (on the ground more than 1 km);
/// - coordinates of another scale, such as centimetres;
/// - frames numbered differently: results that fit the truth better when moved in time;
/// - no match at all.
std::vector<TrackRemark> CheckTracks(const Tracks& truth, const Tracks& results,
                                     const EvaluationOptions& options,
                                     const TrackMeasures& measures);
std::vector<TrackRemark> CheckBoxes(const BoxTracks& truth, const BoxTracks& results,
                                    const EvaluationOptions& options,
                                    const TrackMeasures& measures);

/// How much larger the coordinates of the results are than those of the truth (medians of distances
/// from the origin): far from 1 when one is in centimetres or frames of reference differ. NaN when
/// either has no position.
double ScaleOfResults(const Tracks& truth, const Tracks& results);

}  // namespace vantage
