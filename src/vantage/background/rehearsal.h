// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "vantage/base/options.h"

namespace vantage {

/// Options of the rehearsal: before a recording's first frame is judged, the background is learnt
/// from frames sampled evenly over its beginning. Whoever stands there at first and walks away is
/// then foreground from the first frame on, and leaves no ghost; who stands at one place for most
/// of that time is background all the same.
struct RehearsalOptions {
  /// How much of the beginning, seconds, >= 0; 0: no rehearsal, the first frame is the background
  /// at first.
  double rehearsal_secs = 60;
  /// Samples at most, >= 1. Each counts the same in the background.
  int rehearsal_frames = 100;
};
void VisitOptions(RehearsalOptions& options, OptionVisitor& visitor);

/// Which frames are sampled: 0, interval, 2 interval and so on, `samples` of them.
struct RehearsalPlan {
  std::int64_t interval = 1;
  std::int64_t samples = 0;
};

/// `frame_count` is that of the recording, none when not known. Enough samples to reach its end or
/// that of rehearsal_secs, not more than rehearsal_frames.
RehearsalPlan PlanRehearsal(const RehearsalOptions& options,
                            std::optional<std::int64_t> frame_count, double frames_per_second);

}  // namespace vantage
