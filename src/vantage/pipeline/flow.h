// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "vantage/base/result.h"
#include "vantage/base/run_control.h"

namespace vantage {

/// One stage of a chain that the frames of a recording go through. Frames count from 0.
struct FlowStage {
  /// Lanes work independently of each other, e.g. one for each camera. A lane takes what the same
  /// lane of the stage before gave where that one has as many lanes, otherwise what all of its
  /// lanes gave.
  int lanes = 1;
  /// A lane does its frames one after another; false: any number of them at once.
  bool in_order = true;
  /// Length of the queue behind each lane, frames, >= 1: the lane begins a frame only when the
  /// stage that follows has finished the one `queue` frames before it.
  std::int64_t queue = 1;
  /// How many frames must have left the chain before a lane begins frame t: for what comes back
  /// from the chain's end. At most t; empty: none.
  std::function<std::int64_t(std::int64_t frame)> returned = {};
  /// Does one frame of one lane. False: the recording ends before this frame.
  std::function<Result<bool>(std::int64_t frame, int lane)> work;
};

/// What went through a chain.
struct FlowReport {
  std::int64_t frames = 0;
  /// Time spent in each stage, all threads together.
  std::vector<double> stage_secs;
  double wall_secs = 0;
  /// Time that threads were without work: wall_secs times threads less the sum of stage_secs.
  double idle_secs = 0;
};

/// Sends frames 0, 1, ... through the stages on at most `threads` threads of oneTBB, until a stage
/// says that the recording has ended. Stages overlap; what each lane gets, and when it may begin,
/// is said by its stage alone, so that results do not depend on the number of threads. threads <= 1
/// does everything on the caller's thread: the reference path.
///
/// The first error or end counts: of the earliest frame, there of the earliest stage, there errors
/// before ends, and of these the one of the first lane. Everything before it is still done, nothing
/// after it is begun. Fails with that error, or with Cancelled() soon after `control` was stopped.
/// No work goes on once it has returned. `control.progress` is left to the stages.
Result<FlowReport> RunFlow(std::span<const FlowStage> stages, int threads,
                           const RunControl& control = {});

}  // namespace vantage
