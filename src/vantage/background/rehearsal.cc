// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/rehearsal.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr double kLeastInterval_s = 0.5;
constexpr double kMostSecs = 86400;
constexpr int kMostFrames = 100000;

}  // namespace

void VisitOptions(RehearsalOptions& options, OptionVisitor& visitor) {
  visitor.Number({"rehearsal_secs", "s",
                  "the background is learnt from frames sampled over so much of the beginning "
                  "before the first frame is judged, unless there is less than half of it; 0: not"},
                 options.rehearsal_secs, Range::Between(0, kMostSecs));
  visitor.Number({"rehearsal_frames", "frames", "how many are sampled there, at most"},
                 options.rehearsal_frames, Range::Between(1, kMostFrames));
}

RehearsalPlan SampleBeginning(const RehearsalOptions& options,
                              std::optional<std::int64_t> frame_count, double frames_per_second) {
  std::int64_t frames = std::llround(options.rehearsal_secs * frames_per_second);
  if (frame_count) frames = std::min(frames, *frame_count);
  if (frames <= 0) return {};
  RehearsalPlan plan;
  plan.interval =
      std::max<std::int64_t>({1, (frames + options.rehearsal_frames - 1) / options.rehearsal_frames,
                              std::llround(kLeastInterval_s * frames_per_second)});
  plan.samples = (frames + plan.interval - 1) / plan.interval;
  return plan;
}

RehearsalPlan PlanRehearsal(const RehearsalOptions& options,
                            std::optional<std::int64_t> frame_count, double frames_per_second) {
  const double least_frames = options.rehearsal_secs * frames_per_second / 2;
  if (!frame_count || static_cast<double>(*frame_count) < least_frames) return {};
  return SampleBeginning(options, frame_count, frames_per_second);
}

}  // namespace vantage
