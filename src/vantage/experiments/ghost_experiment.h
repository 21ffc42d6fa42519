// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/background/subtractor.h"
#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/geometry/camera.h"
#include "vantage/metrics/mask_evaluation.h"

/// The thesis's evaluation of ghost detection against labelled masks (section 3.4, figures 8 to
/// 11): every criterion in both colour spaces at both learning rates.

namespace vantage {

/// A sequence and how it is used.
struct GhostCase {
  std::string name;                ///< unique
  std::filesystem::path sequence;  ///< folder of the sequence, relative to the data folder
  /// The first frame that the method sees, >= 0.
  FrameIndex begin = 0;
  /// First and last frame that count, of those from begin on that have truth in the sequence's
  /// temporal range, first <= last.
  FrameIndex first = 0;
  FrameIndex last = std::numeric_limits<FrameIndex>::max();
  /// Whether a ghost arises in the frames that count.
  bool ghost = false;
  /// By which frame the ghost should have gone.
  std::optional<FrameIndex> check = std::nullopt;
  std::string note;  ///< why so, for readers
};

/// The sequences of CDnet and SBI that stand in for those of the thesis.
std::vector<GhostCase> StandardGhostCases();

/// One way to make masks.
struct GhostVariant {
  /// "none", a criterion, "fep-plain"; "mog2", "knn", "mog2-ghosts", "knn-ghosts". Together with
  /// the mixture's colour space, rate and alpha unique.
  std::string name;
  BackgroundOptions options;
};

/// {no detection, five criteria, FEP in the thesis's plain form} x {LUV, RGB} x {modified,
/// original rate} x alpha {default, 0.005}; then OpenCV's MOG2 and KNN at their defaults, bare and
/// with our ghost detection, disturbances and clean-up around them. All else is at the defaults.
std::vector<GhostVariant> StandardGhostVariants();

/// Name of the variant with the default criterion and judgement.
std::string DefaultVariantName();

/// What one variant did on one case.
struct GhostRun {
  std::vector<MaskFrameCounts> frames;  ///< the frames that count
  MaskCounts counts;
  MaskMeasures measures;
  BackgroundReport report;
  double secs_per_frame = 0;  ///< wall-clock, of the whole stage on one thread

  /// The frame that counts with the most false positives, the first of equals.
  const MaskFrameCounts& Peak() const;
  /// False positives in this frame; nullopt when it does not count.
  std::optional<std::int64_t> FalsePositivesAt(FrameIndex frame) const;
};

/// One case with its runs.
struct GhostCaseResult {
  GhostCase used;
  ImageSize size;
  std::int64_t frames_shown = 0;          ///< from begin to the last frame that counts
  std::int64_t frames_without_truth = 0;  ///< in the sequence's temporal range
  bool roi = false;                       ///< a region of interest restricts what counts
  std::vector<std::string> notes;         ///< TruthSequence::notes
  std::vector<GhostRun> runs;             ///< one a variant, in their order
};

struct GhostResults {
  std::filesystem::path data;
  std::vector<GhostVariant> variants;
  std::vector<GhostCaseResult> cases = {};
  std::vector<std::string> skipped = {};  ///< cases left out and why, one line each
  int threads = 1;
  double seconds = 0;

  /// The run of the variant with this name at these settings; of OpenCV's methods, which have
  /// none, at any. nullptr: there is none.
  const GhostRun* Find(const GhostCaseResult& in, std::string_view variant, ColorSpace color,
                       LearningRate rate, double alpha) const;
};

/// Runs every variant on every case that is in `data`. Frames are decoded once a case and shared;
/// variants run in parallel, each on one thread; all figures but the seconds are the same for every
/// thread count. Cases whose sequence is absent, or has no truth in their frames, are skipped and
/// said so. Fails when none is left, on options out of range, and on sequences that are broken.
Result<GhostResults> RunGhostExperiment(const std::filesystem::path& data,
                                        const std::vector<GhostCase>& cases,
                                        const std::vector<GhostVariant>& variants, int threads,
                                        const RunControl& control = {});

}  // namespace vantage
