// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/metrics/mask_measures.h"
#include "vantage/video/sequence.h"

namespace vantage {

/// Which frames of a sequence are compared with which masks.
struct MaskEvaluationOptions {
  /// First and last frame that count, both included, of those that have truth and lie in the
  /// sequence's own temporal range: 0 <= first_frame <= last_frame.
  FrameIndex first_frame = 0;
  FrameIndex last_frame = std::numeric_limits<FrameIndex>::max();
  /// Frame of the sequence to which the mask with the number 0 (in its name; of a video the first)
  /// belongs: 900 for a video of masks begun at frame 900, -1 for names that count from 1.
  std::int64_t offset_frames = 0;
};

/// What one frame adds.
struct MaskFrameCounts {
  FrameIndex frame = 0;
  MaskCounts counts;
};

/// Compares the masks at `masks` (whatever OpenMasks reads) with the truth, frame by frame. Fails
/// on options out of range, when no frame with truth is left, and, naming the frame, when a mask is
/// missing or has another size than the truth, and on labels that are none.
Result<std::vector<MaskFrameCounts>> EvaluateMasks(const TruthSequence& truth,
                                                   const std::filesystem::path& masks,
                                                   const MaskEvaluationOptions& options = {},
                                                   const RunControl& control = {});

/// The counts of all frames.
MaskCounts SumOf(const std::vector<MaskFrameCounts>& frames);

}  // namespace vantage
