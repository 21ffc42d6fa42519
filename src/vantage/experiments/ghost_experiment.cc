// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/ghost_experiment.h"

#include <algorithm>
#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <set>
#include <utility>

#include "vantage/base/parallel.h"
#include "vantage/base/stopwatch.h"
#include "vantage/metrics/mask_measures.h"
#include "vantage/video/open.h"
#include "vantage/video/sequence.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// Frames decoded before the variants run over them: enough that starting the threads costs
/// nothing, few enough for the memory and to be interrupted soon.
constexpr int kBatchFrames = 32;

bool IsPeer(const GhostVariant& variant) { return variant.options.method != MethodKind::kMixture; }

/// A case whose truth was read.
struct OpenCase {
  GhostCase used;
  TruthSequence truth = {};
  std::map<FrameIndex, fs::path> masks = {};  ///< of the frames that count; not empty
  std::int64_t FramesShown() const { return masks.rbegin()->first - used.begin + 1; }
};

/// A frame with its truth, which is empty where the frame does not count.
struct LabelledFrame {
  FrameIndex frame = 0;
  cv::Mat bgr, labels;
};

/// A variant under way on a case.
struct ActiveRun {
  BackgroundSubtractor subtractor;
  double seconds = 0;
  cv::Mat mask = {};
  GhostRun result = {};
};

/// The cases that can be run; the others go to `skipped`.
Result<std::vector<OpenCase>> OpenCases(const fs::path& data, const std::vector<GhostCase>& cases,
                                        std::vector<std::string>& skipped) {
  std::error_code code;
  if (!fs::is_directory(data, code)) {
    return Fail("{}: no such folder; give the one that holds the sequences, e.g. {}", data.string(),
                cases.front().sequence.string());
  }
  std::vector<OpenCase> open;
  std::set<std::string> missing;
  for (const GhostCase& used : cases) {
    const fs::path folder = data / used.sequence;
    if (!fs::is_directory(folder, code)) {
      missing.insert(used.sequence.string());
      skipped.push_back(fmt::format("{}: {} is not there", used.name, folder.string()));
      continue;
    }
    if (!IsSequenceFolder(folder)) {
      return Fail("{}: is no sequence; it must hold the folders input and groundtruth",
                  folder.string());
    }
    OpenCase one{.used = used};
    VANTAGE_ASSIGN_OR_RETURN(one.truth, OpenTruth(folder));
    const FrameIndex first = std::max(used.first, used.begin);
    const FrameIndex last = std::max(used.last, first);
    one.masks = {one.truth.masks.lower_bound(first), one.truth.masks.upper_bound(last)};
    if (one.masks.empty()) {
      skipped.push_back(fmt::format("{}: {} has no truth that counts in frames {} to {}", used.name,
                                    folder.string(), used.first, used.last));
      continue;
    }
    open.push_back(std::move(one));
  }
  if (open.empty() && missing.empty()) return Fail("{}", skipped.front());
  if (open.empty()) {
    return Fail("{}: holds none of the sequences {}", data.string(), fmt::join(missing, ", "));
  }
  return open;
}

/// The next frames of the case, at most a batch.
Result<std::vector<LabelledFrame>> ReadBatch(FrameSource& source, const OpenCase& from,
                                             FrameIndex next) {
  const FrameIndex last = from.masks.rbegin()->first;
  std::vector<LabelledFrame> batch;
  for (; next <= last && batch.size() < kBatchFrames; ++next) {
    LabelledFrame& one = batch.emplace_back();
    one.frame = next;
    VANTAGE_ASSIGN_OR_RETURN(const bool more, source.Read(one.bgr));
    if (!more) {
      return Fail("{}: ends before frame {}, which has truth", source.info().name, last);
    }
    const auto mask = from.masks.find(next);
    if (mask == from.masks.end()) continue;
    VANTAGE_ASSIGN_OR_RETURN(one.labels, ReadTruthMask(mask->second, from.truth.size));
  }
  return batch;
}

Status Advance(const std::vector<LabelledFrame>& batch, const OpenCase& on, ActiveRun& run,
               const RunControl& control) {
  for (const LabelledFrame& frame : batch) {
    if (control.Stopped()) return Cancelled();
    Stopwatch watch;
    VANTAGE_RETURN_IF_ERROR(run.subtractor.Apply(frame.bgr, run.mask, 1));
    watch.LapInto(run.seconds);
    if (frame.labels.empty()) continue;
    const Result<MaskCounts> counts = CountMask(frame.labels, run.mask, on.truth.roi);
    if (!counts) return Fail("{}: {}", on.masks.at(frame.frame).string(), counts.error().message);
    run.result.frames.push_back({frame.frame, *counts});
  }
  return {};
}

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

GhostRun Finished(ActiveRun run) {
  GhostRun result = std::move(run.result);
  result.counts = SumOf(result.frames);
  result.measures = MeasureMasks(result.counts);
  result.report = run.subtractor.report();
  result.secs_per_frame = run.seconds / static_cast<double>(result.report.frames);
  return result;
}

/// `done` of `total` frames, all variants together, are reported.
Result<GhostCaseResult> RunCase(const OpenCase& on, const std::vector<GhostVariant>& variants,
                                int threads, const RunControl& control, std::int64_t& done,
                                std::int64_t total) {
  VANTAGE_ASSIGN_OR_RETURN(const std::unique_ptr<FrameSource> source, OpenInput(on.truth.folder));
  const ImageSize size = source->info().size;
  if (size != on.truth.size) {
    return Fail("{}: the pictures have {} x {} px, the truth {} x {}", on.truth.folder.string(),
                size.width, size.height, on.truth.size.width, on.truth.size.height);
  }
  VANTAGE_ASSIGN_OR_RETURN(std::vector<ActiveRun> runs, StartRuns(variants, size));
  VANTAGE_RETURN_IF_ERROR(source->Skip(on.used.begin));
  std::vector<Status> statuses(runs.size());
  FrameIndex next = on.used.begin;
  while (next <= on.masks.rbegin()->first) {
    VANTAGE_ASSIGN_OR_RETURN(const std::vector<LabelledFrame> batch, ReadBatch(*source, on, next));
    ParallelFor(threads, std::ssize(runs), [&](std::int64_t i) {
      const auto index = static_cast<std::size_t>(i);
      statuses[index] = Advance(batch, on, runs[index], control);
    });
    for (const Status& status : statuses) VANTAGE_RETURN_IF_ERROR(status);
    next += std::ssize(batch);
    done += std::ssize(batch) * std::ssize(runs);
    control.Report(done, total);
  }
  GhostCaseResult result{.used = on.used,
                         .size = size,
                         .frames_shown = on.FramesShown(),
                         .frames_without_truth = on.truth.frames_without_truth,
                         .roi = !on.truth.roi.empty(),
                         .notes = on.truth.notes,
                         .runs = {}};
  for (ActiveRun& run : runs) result.runs.push_back(Finished(std::move(run)));
  return result;
}

}  // namespace

std::vector<GhostCase> StandardGhostCases() {
  return {
      {.name = "office",
       .sequence = "cdnet/office",
       .note = "Begun with an empty room: no ghost. A man comes, stands for over 1,000 frames and "
               "leaves."},
      {.name = "office from 900",
       .sequence = "cdnet/office",
       .begin = 900,
       .first = 1950,
       .last = 2035,
       .ghost = true,
       .note = "Begun where the man stands, so that he is background and leaves a ghost when he "
               "turns to go at about frame 1950. He is still in the picture at 2035; from there on "
               "the light changes."},
      {.name = "traffic",
       .sequence = "cdnet/traffic",
       .note = "A road before a shaking camera: no ghost to speak of."},
      {.name = "CaVignal",
       .sequence = "sbi/CaVignal",
       .first = 150,
       .last = 257,
       .ghost = true,
       .check = 192,
       .note = "A man stands from the first frame on and walks off. Before frame 150 he stands "
               "still and no method can see him. The ghost stands alone from about frame 182; "
               "the check is 10 frames later."},
      {.name = "IBMtest2",
       .sequence = "sbi/IBMtest2",
       .note = "People walk through an empty hall: no ghost."},
  };
}

std::vector<GhostVariant> StandardGhostVariants() {
  const BackgroundOptions defaults;
  struct Rule {
    std::string name;
    GhostCriterion criterion;
    GhostJudgement judgement;
  };
  std::vector<Rule> rules;
  for (const GhostCriterion criterion :
       {GhostCriterion::kNone, GhostCriterion::kFep, GhostCriterion::kFer, GhostCriterion::kNb,
        GhostCriterion::kEpd, GhostCriterion::kCb}) {
    rules.push_back({std::string(NameOf(criterion)), criterion, defaults.ghosts.judgement});
  }
  rules.push_back({"fep-plain", GhostCriterion::kFep, GhostJudgement::kPlain});

  std::vector<GhostVariant> variants;
  for (const double alpha : {defaults.mixture.alpha, 0.005}) {
    for (const Rule& rule : rules) {
      for (const ColorSpace color : {ColorSpace::kLuv, ColorSpace::kRgb}) {
        for (const LearningRate rate : {LearningRate::kModified, LearningRate::kOriginal}) {
          GhostVariant& variant = variants.emplace_back(GhostVariant{rule.name, defaults});
          variant.options.mixture.alpha = alpha;
          variant.options.mixture.color = color;
          variant.options.mixture.rate = rate;
          variant.options.ghosts.rule.criterion = rule.criterion;
          variant.options.ghosts.judgement = rule.judgement;
        }
      }
    }
  }
  for (const auto& [name, method] :
       {std::pair("mog2", MethodKind::kMog2), std::pair("knn", MethodKind::kKnn)}) {
    GhostVariant bare{name, defaults};
    bare.options.method = method;
    bare.options.ghosts.rule.criterion = GhostCriterion::kNone;
    bare.options.disturbances.enabled = false;
    bare.options.cleanup = {.open_px = 0, .close_px = 0, .min_area_px = 0};
    GhostVariant around{std::string(name) + "-ghosts", defaults};
    around.options.method = method;
    variants.push_back(std::move(bare));
    variants.push_back(std::move(around));
  }
  return variants;
}

std::string DefaultVariantName() {
  const GhostOptions defaults;
  const std::string name(NameOf(defaults.rule.criterion));
  return defaults.judgement == GhostJudgement::kPlain ? name + "-plain" : name;
}

const MaskFrameCounts& GhostRun::Peak() const {
  return *std::max_element(frames.begin(), frames.end(), [](const auto& a, const auto& b) {
    return a.counts.false_positives < b.counts.false_positives;
  });
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
    if (variants[i].name == variant && (same || IsPeer(variants[i]))) return &in.runs[i];
  }
  return nullptr;
}

Result<GhostResults> RunGhostExperiment(const fs::path& data, const std::vector<GhostCase>& cases,
                                        const std::vector<GhostVariant>& variants, int threads,
                                        const RunControl& control) {
  if (cases.empty() || variants.empty()) return Fail("no sequence or no variant to run");
  const Stopwatch watch;
  GhostResults results{.data = data, .variants = variants, .threads = threads};
  VANTAGE_ASSIGN_OR_RETURN(const std::vector<OpenCase> open,
                           OpenCases(data, cases, results.skipped));
  std::int64_t total = 0;
  for (const OpenCase& one : open) total += one.FramesShown() * std::ssize(variants);
  std::int64_t done = 0;
  for (const OpenCase& one : open) {
    VANTAGE_ASSIGN_OR_RETURN(GhostCaseResult result,
                             RunCase(one, variants, threads, control, done, total));
    results.cases.push_back(std::move(result));
  }
  results.seconds = watch.Seconds();
  return results;
}

}  // namespace vantage
