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
  /// at first. Nor is there one where the recording is shorter than half of this: too many people
  /// stand at one place for most of it.
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

/// Samples of the beginning: enough to reach the end of the recording or of rehearsal_secs, not
/// more than rehearsal_frames, nor nearer to each other than half a second, in which people hardly
/// move. `frame_count` is that of the recording, none when not known.
RehearsalPlan SampleBeginning(const RehearsalOptions& options,
                              std::optional<std::int64_t> frame_count, double frames_per_second);

/// The same where there is to be a rehearsal; otherwise no samples. What does not know its length,
/// such as a live stream, would not begin again.
RehearsalPlan PlanRehearsal(const RehearsalOptions& options,
                            std::optional<std::int64_t> frame_count, double frames_per_second);

}  // namespace vantage
