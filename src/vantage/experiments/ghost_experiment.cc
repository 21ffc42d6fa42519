// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/ghost_experiment.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <utility>

#include "vantage/base/stopwatch.h"
#include "vantage/metrics/mask_measures.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A variant under way on a case.
struct ActiveRun {
  BackgroundSubtractor subtractor;
  double seconds = 0;
  cv::Mat mask = {};
  GhostRun result = {};
};

Result<std::vector<ActiveRun>> StartRuns(const std::vector<GhostVariant>& variants,
                                         ImageSize size) {
  std::vector<ActiveRun> runs;
  runs.reserve(variants.size());
  for (const GhostVariant& variant : variants) {
    VANTAGE_ASSIGN_OR_RETURN(BackgroundSubtractor subtractor,
                             BackgroundSubtractor::Create(size, variant.options));
    runs.push_back({.subtractor = std::move(subtractor)});
  }
  return runs;
}

Status Advance(const LabelledFrame& frame, ActiveRun& run) {
  Stopwatch watch;
  VANTAGE_RETURN_IF_ERROR(run.subtractor.Apply(frame.bgr, run.mask, 1));
  watch.LapInto(run.seconds);
  if (frame.labels.empty()) return {};
  VANTAGE_ASSIGN_OR_RETURN(const MaskCounts counts, CountMask(frame.labels, run.mask));
  run.result.frames.push_back({frame.frame, counts});
  return {};
}

/// What follows from the counts of the frames.
void Sum(GhostRun& run) {
  run.counts = SumOf(run.frames);
  run.measures = MeasureMasks(run.counts);
}

GhostRun Finished(ActiveRun run) {
  GhostRun result = std::move(run.result);
  const BackgroundReport& report = run.subtractor.report();
  result.ghost_frames = report.ghost_frames;
  result.ghosts_px = report.ghosts_px;
  result.secs_per_frame = run.seconds / static_cast<double>(report.frames);
  Sum(result);
  return result;
}

Json JsonOf(const GhostRun& run) {
  Json frames = Json::array();
  for (const auto& [frame, c] : run.frames) {
    frames.push_back({frame, c.true_positives, c.false_positives, c.false_negatives,
                      c.true_negatives, c.shadow_px, c.shadow_false_positives});
  }
  return {{"ghost_frames", run.ghost_frames},
          {"ghosts_px", run.ghosts_px},
          {"seconds_per_frame", run.secs_per_frame},
          {"frames", std::move(frames)}};
}

GhostRun RunOf(const Json& json) {
  GhostRun run{.ghost_frames = json.at("ghost_frames"),
               .ghosts_px = json.at("ghosts_px"),
               .secs_per_frame = json.at("seconds_per_frame")};
  for (const Json& frame : json.at("frames")) {
    run.frames.push_back({frame.at(0),
                          {.frames = 1,
                           .true_positives = frame.at(1),
                           .false_positives = frame.at(2),
                           .false_negatives = frame.at(3),
                           .true_negatives = frame.at(4),
                           .shadow_px = frame.at(5),
                           .shadow_false_positives = frame.at(6)}});
  }
  Sum(run);
  return run;
}

}  // namespace

Result<LabelledSequence> GhostCase::Open(const fs::path& folder) const {
  return Simulated() ? LabelledSequence::OpenRecording(folder, camera, span)
                     : LabelledSequence::OpenSequence(folder, span);
}

const MaskFrameCounts& GhostRun::Peak() const {
  return *std::max_element(frames.begin(), frames.end(), [](const auto& a, const auto& b) {
    return a.counts.false_positives < b.counts.false_positives;
  });
}

MaskCounts GhostRun::In(const FrameWindow& window) const {
  MaskCounts sum;
  for (const auto& [frame, one] : frames) {
    if (frame >= window.first && frame <= window.last) sum += one;
  }
  return sum;
}

std::optional<std::int64_t> GhostRun::FalsePositivesAt(FrameIndex frame) const {
  const auto found = std::find_if(frames.begin(), frames.end(),
                                  [&](const MaskFrameCounts& one) { return one.frame == frame; });
  if (found == frames.end()) return std::nullopt;
  return found->counts.false_positives;
}

const GhostRun* GhostResults::Find(const GhostCaseResult& in, std::string_view variant,
                                   ColorSpace color, LearningRate rate, double alpha) const {
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const MixtureOptions& mixture = variants[i].options.mixture;
    const bool same = mixture.color == color && mixture.rate == rate && mixture.alpha == alpha;
    if (variants[i].name == variant && (same || variants[i].IsPeer())) return &in.runs[i];
  }
  return nullptr;
}

Result<GhostCaseResult> RunGhostCase(const GhostCase& on, const fs::path& folder,
                                     const std::vector<GhostVariant>& variants,
                                     const RunControl& control) {
  VANTAGE_ASSIGN_OR_RETURN(LabelledSequence sequence, on.Open(folder));
  GhostCaseResult result{.used = on,
                         .size = sequence.size(),
                         .frames_without_truth = sequence.frames_without_truth(),
                         .roi = sequence.has_roi(),
                         .notes = sequence.notes(),
                         .runs = {}};
  VANTAGE_ASSIGN_OR_RETURN(std::vector<ActiveRun> runs, StartRuns(variants, result.size));
  LabelledFrame frame;
  while (true) {
    if (control.Stopped()) return Cancelled();
    VANTAGE_ASSIGN_OR_RETURN(const bool more, sequence.Next(frame));
    if (!more) break;
    for (ActiveRun& run : runs) {
      const Status status = Advance(frame, run);
      if (!status) {
        return Fail("{}: frame {}: {}", folder.string(), frame.frame, status.error().message);
      }
    }
    control.Report(++result.frames_shown, 0);
  }
  for (ActiveRun& run : runs) {
    if (run.result.frames.empty()) {
      return Fail("{}: has no frame that counts in {} to {}", folder.string(), on.span.first,
                  on.span.last);
    }
    result.runs.push_back(Finished(std::move(run)));
  }
  return result;
}

Json JsonOf(const GhostCaseResult& result) {
  Json runs = Json::array();
  for (const GhostRun& run : result.runs) runs.push_back(JsonOf(run));
  return {{"width", result.size.width},
          {"height", result.size.height},
          {"frames_shown", result.frames_shown},
          {"frames_without_truth", result.frames_without_truth},
          {"roi", result.roi},
          {"notes", result.notes},
          {"runs", std::move(runs)}};
}

Result<GhostCaseResult> GhostCaseResultOf(const Json& json, const GhostCase& used) {
  try {
    GhostCaseResult result{.used = used,
                           .size = {json.at("width"), json.at("height")},
                           .frames_shown = json.at("frames_shown"),
                           .frames_without_truth = json.at("frames_without_truth"),
                           .roi = json.at("roi"),
                           .notes = json.at("notes"),
                           .runs = {}};
    for (const Json& run : json.at("runs")) {
      result.runs.push_back(RunOf(run));
      if (result.runs.back().frames.empty()) return Fail("a run without frames");
    }
    return result;
  } catch (const nlohmann::json::exception& error) {
    return Fail("{}", error.what());
  }
}

}  // namespace vantage
