// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/background/subtractor.h"
#include "vantage/base/ids.h"
#include "vantage/base/result.h"
#include "vantage/base/run_control.h"
#include "vantage/experiments/labelled_sequence.h"
#include "vantage/geometry/camera.h"
#include "vantage/metrics/mask_evaluation.h"

/// The thesis's evaluation of ghost detection against true masks (section 3.4, figures 8 to 11):
/// every criterion in both colour spaces at both learning rates.

namespace vantage {

/// Frames of a sequence, both included.
struct FrameWindow {
  FrameIndex first = 0, last = 0;
};

/// A sequence and how it is used.
struct GhostCase {
  std::string name;                     ///< unique
  std::filesystem::path sequence = {};  ///< real: folder of the sequence in the data folder
  std::string preset = {};              ///< simulated: the recording's preset; empty: real
  int camera = 0;                       ///< of the recording, from 0
  FrameSpan span = {};
  /// Figures of the thesis in which it stands.
  std::set<int> figures = {};
  /// Whether a ghost arises in the frames that count.
  bool ghost = false;
  /// By which frame the ghost should have gone.
  std::optional<FrameIndex> check = std::nullopt;
  /// When something moves over a ghost.
  std::optional<FrameWindow> under_mover = std::nullopt;
  /// When a ghost lies alone on ground with strong edges.
  std::optional<FrameWindow> over_edges = std::nullopt;
  /// When somebody is behind branches or a sign.
  std::optional<FrameWindow> hidden = std::nullopt;
  std::string note = {};  ///< why so, for readers

  bool Simulated() const { return !preset.empty(); }
  const char* Origin() const { return Simulated() ? "simulated" : "real"; }
  /// Its pictures; `folder` is that of the sequence or of the recording.
  Result<LabelledSequence> Open(const std::filesystem::path& folder) const;
};

/// The sequences of CDnet and SBI that stand in for those of the thesis, and simulated ones.
std::vector<GhostCase> StandardGhostCases();

/// One way to make masks.
struct GhostVariant {
  /// "none", a criterion judged our way ("fep") or in the thesis's plain form ("fep-plain"),
  /// "standing"; "mog2", "knn", "mog2-ghosts", "knn-ghosts". Together with the mixture's colour
  /// space, rate and alpha unique.
  std::string name;
  BackgroundOptions options;

  bool IsPeer() const { return options.method != MethodKind::kMixture; }
};

/// The rival of the thesis's section 3.2: every detection that does not move for a while is a
/// ghost, whatever its border looks like.
GhostOptions StandingGhostOptions();

/// {no detection, five criteria in our judgement and plainly, the rival} x {LUV, RGB} x {modified,
/// original rate} x alpha {default, 0.005}; then OpenCV's MOG2 and KNN at their defaults, bare and
/// with our ghost detection, disturbances and clean-up around them. All else is at the defaults.
/// `quick`: the default alpha alone.
std::vector<GhostVariant> StandardGhostVariants(bool quick = false);

/// Name of the variant with the default criterion and judgement.
std::string DefaultVariantName();

/// What one variant did on one case.
struct GhostRun {
  std::vector<MaskFrameCounts> frames = {};  ///< the frames that count
  MaskCounts counts = {};
  MaskMeasures measures = {};
  std::int64_t ghost_frames = 0;  ///< frames in which ghosts were absorbed
  std::int64_t ghosts_px = 0;     ///< their pixels
  double secs_per_frame = 0;      ///< wall-clock, of the whole stage on one thread

  /// The frame that counts with the most false positives, the first of equals.
  const MaskFrameCounts& Peak() const;
  /// The counts of the frames in a window.
  MaskCounts In(const FrameWindow& window) const;
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
  std::vector<std::string> notes;         ///< of the sequence
  std::vector<GhostRun> runs;             ///< one a variant, in their order
};

struct GhostResults {
  std::vector<GhostVariant> variants;
  std::vector<GhostCaseResult> cases = {};
  std::vector<std::string> skipped = {};  ///< cases left out and why, one line each

  /// The run of the variant with this name at these settings; of OpenCV's methods, which have
  /// none, at any. nullptr: there is none.
  const GhostRun* Find(const GhostCaseResult& in, std::string_view variant, ColorSpace color,
                       LearningRate rate, double alpha) const;
};

/// Runs the variants on one case, on one thread; frames are decoded once. All figures but the
/// seconds are the same wherever it runs. Fails on options out of range, on sequences that are
/// broken and when no frame counts.
Result<GhostCaseResult> RunGhostCase(const GhostCase& on, const std::filesystem::path& folder,
                                     const std::vector<GhostVariant>& variants,
                                     const RunControl& control = {});

/// A result as it is kept, without `used`, and back. Fails on what was not written so.
nlohmann::ordered_json JsonOf(const GhostCaseResult& result);
Result<GhostCaseResult> GhostCaseResultOf(const nlohmann::ordered_json& json,
                                          const GhostCase& used);

}  // namespace vantage
