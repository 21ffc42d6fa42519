// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/ghost_report.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace vantage {
namespace {

/// NaN, a ratio of nothing, is an empty field.
std::string Field(double value) { return std::isnan(value) ? "" : fmt::format("{:.6f}", value); }

template <class T>
std::string Field(const std::optional<T>& value) {
  return value ? fmt::to_string(*value) : "";
}

std::optional<std::int64_t> AtCheck(const GhostCaseResult& in, const GhostRun& run) {
  return in.used.check ? run.FalsePositivesAt(*in.used.check) : std::nullopt;
}

}  // namespace

VariantText TextOf(const GhostVariant& variant) {
  const BackgroundOptions& o = variant.options;
  VariantText text;
  text.method = o.method == MethodKind::kMixture ? "mixture"
                : o.method == MethodKind::kMog2  ? "mog2"
                                                 : "knn";
  text.criterion = NameOf(o.ghosts.rule.criterion);
  if (o.ghosts.rule.criterion != GhostCriterion::kNone) {
    text.judgement = o.ghosts.judgement == GhostJudgement::kStill ? "still" : "plain";
    text.threshold = fmt::to_string(o.ghosts.rule.threshold());
  }
  if (o.method == MethodKind::kMixture) {
    text.color = o.mixture.color == ColorSpace::kLuv ? "luv" : "rgb";
    text.rate = o.mixture.rate == LearningRate::kModified ? "modified" : "original";
    text.alpha = fmt::to_string(o.mixture.alpha);
  }
  return text;
}

std::vector<double> AlphasOf(const GhostResults& results) {
  std::vector<double> alphas;
  for (const GhostVariant& variant : results.variants) {
    const double alpha = variant.options.mixture.alpha;
    if (variant.IsPeer()) continue;
    if (std::find(alphas.begin(), alphas.end(), alpha) == alphas.end()) alphas.push_back(alpha);
  }
  return alphas;
}

std::string GhostCsv(const GhostResults& results) {
  std::string csv =
      "sequence,data,place,begin,first,last,frames,variant,method,criterion,judgement,threshold,"
      "color,"
      "rate,alpha,disturbances,open_px,close_px,min_area_px,tp,fp,fn,tn,recall,precision,f1,"
      "specificity,pwc,fp_peak,fp_peak_frame,check,fp_at_check,ghost_frames,ghosts_px,"
      "seconds_per_frame\n";
  for (const GhostCaseResult& in : results.cases) {
    for (std::size_t i = 0; i < in.runs.size(); ++i) {
      const GhostRun& run = in.runs[i];
      const GhostVariant& variant = results.variants[i];
      const VariantText text = TextOf(variant);
      const CleanupOptions& cleanup = variant.options.cleanup;
      csv += fmt::format("{},{},{},{},{},{},{},", in.used.name, in.used.Origin(),
                         in.used.Simulated() ? in.used.preset : in.used.sequence.generic_string(),
                         in.used.span.begin, run.frames.front().frame, run.frames.back().frame,
                         run.counts.frames);
      csv += fmt::format("{},{},{},{},{},{},{},{},", variant.name, text.method, text.criterion,
                         text.judgement, text.threshold, text.color, text.rate, text.alpha);
      csv += fmt::format("{},{},{},{},", variant.options.disturbances.enabled ? 1 : 0,
                         cleanup.open_px, cleanup.close_px, cleanup.min_area_px);
      csv += fmt::format("{},{},{},{},", run.counts.true_positives, run.counts.false_positives,
                         run.counts.false_negatives, run.counts.true_negatives);
      csv += fmt::format("{},{},{},{},{},", Field(run.measures.recall),
                         Field(run.measures.precision), Field(run.measures.f1),
                         Field(run.measures.specificity), Field(run.measures.pwc));
      csv += fmt::format("{},{},{},{},", run.Peak().counts.false_positives, run.Peak().frame,
                         Field(in.used.check), Field(AtCheck(in, run)));
      csv += fmt::format("{},{},{:.7f}\n", run.ghost_frames, run.ghosts_px, run.secs_per_frame);
    }
  }
  return csv;
}

std::string GhostFramesCsv(const GhostResults& results) {
  const MixtureOptions defaults;
  std::string csv = "sequence,variant,alpha,frame,tp,fp,fn\n";
  for (const GhostCaseResult& in : results.cases) {
    for (const double alpha : AlphasOf(results)) {
      for (const std::string& name :
           std::set<std::string>{"none", "fep-plain", DefaultVariantName()}) {
        const GhostRun* run = results.Find(in, name, defaults.color, defaults.rate, alpha);
        if (run == nullptr) continue;
        for (const auto& [frame, counts] : run->frames) {
          csv += fmt::format("{},{},{},{},{},{},{}\n", in.used.name, name, alpha, frame,
                             counts.true_positives, counts.false_positives, counts.false_negatives);
        }
      }
    }
  }
  return csv;
}

}  // namespace vantage
