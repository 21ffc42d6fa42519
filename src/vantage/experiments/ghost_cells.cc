// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/ghost_cells.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "vantage/experiments/mask_recordings.h"
#include "vantage/experiments/recordings.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Frames of a real sequence that count in a small version, and as many before them.
constexpr std::int64_t kQuickFrames = 60;

/// The variants of one rule: those with its name, which stand together.
using RuleVariants = std::vector<GhostVariant>;
std::vector<RuleVariants> ByRule(const std::vector<GhostVariant>& variants) {
  std::vector<RuleVariants> rules;
  for (const GhostVariant& variant : variants) {
    if (rules.empty() || rules.back().front().name != variant.name) rules.emplace_back();
    rules.back().push_back(variant);
  }
  return rules;
}

std::string CellNameOf(const GhostCase& on, const std::string& rule) {
  return CellName("ghosts-" + on.name + "-" + rule);
}

Json InputsOf(const GhostCase& on, const Json& data, const RuleVariants& variants) {
  Json inputs = {{"data", data},           {"camera", on.camera},      {"begin", on.span.begin},
                 {"first", on.span.first}, {"last", on.span.last},     {"lead", on.span.lead},
                 {"most", on.span.most},   {"variants", Json::array()}};
  for (const GhostVariant& variant : variants) {
    RecordOptions(variant.options, inputs["variants"].emplace_back());
  }
  return inputs;
}

CellPtr CellOf(const GhostCase& on, const fs::path& sequence, const CellPtr& recording,
               const Json& data, const RuleVariants& variants) {
  Cell cell{.name = CellNameOf(on, variants.front().name),
            .inputs = InputsOf(on, data, variants),
            .run = {}};
  if (recording) cell.needs = {recording};
  cell.run = [on, sequence, recording, variants](const CellRun& run) -> Result<Json> {
    const fs::path folder = recording ? run.folder / recording->product : sequence;
    VANTAGE_ASSIGN_OR_RETURN(const GhostCaseResult result,
                             RunGhostCase(on, folder, variants, run.control));
    return JsonOf(result);
  };
  return std::make_shared<const Cell>(std::move(cell));
}

}  // namespace

Result<GhostPlan> PlanGhosts(const Study& study,
                             const std::function<bool(const GhostCase&)>& wanted) {
  GhostPlan plan{.variants = StandardGhostVariants(study.quick)};
  const std::vector<RuleVariants> rules = ByRule(plan.variants);
  for (GhostCase& one : StandardGhostCases()) {
    if (!wanted(one)) continue;
    // Simulated recordings are short of themselves then.
    if (study.quick && !one.Simulated()) one.span.lead = one.span.most = kQuickFrames;
    if (study.frames) one.span.most = std::min<std::int64_t>(one.span.most, *study.frames);
    const fs::path sequence = study.data / one.sequence;
    CellPtr recording;
    Json data;
    if (one.Simulated()) {
      VANTAGE_ASSIGN_OR_RETURN(recording, MaskRecording(study, one.preset));
    } else {
      std::error_code code;
      if (study.data.empty() || !fs::is_directory(sequence, code)) {
        plan.skipped.push_back(fmt::format("{}: {} is not in the data folder (--data)", one.name,
                                           one.sequence.generic_string()));
        continue;
      }
      VANTAGE_ASSIGN_OR_RETURN(data, DescribeData(sequence));
    }
    for (const RuleVariants& rule : rules) {
      plan.cells.push_back(CellOf(one, sequence, recording, data, rule));
    }
    plan.cases.push_back(one);
  }
  return plan;
}

Result<GhostResults> GhostResultsOf(const GhostPlan& plan, const CellResults& results) {
  GhostResults all{.variants = plan.variants};
  for (const GhostCase& one : plan.cases) {
    GhostCaseResult* joined = nullptr;
    for (const RuleVariants& rule : ByRule(plan.variants)) {
      const std::string name = CellNameOf(one, rule.front().name);
      const auto found = results.find(name);
      if (found == results.end()) return Fail("cell {}: has no result", name);
      Result<GhostCaseResult> part = GhostCaseResultOf(found->second, one);
      if (!part) return Fail("cell {}: {}; run with --force", name, part.error().message);
      if (part->runs.size() != rule.size()) {
        return Fail("cell {}: has {} runs, not {}; run with --force", name, part->runs.size(),
                    rule.size());
      }
      if (joined == nullptr) {
        joined = &all.cases.emplace_back(*std::move(part));
      } else {
        joined->runs.insert(joined->runs.end(), part->runs.begin(), part->runs.end());
      }
    }
  }
  return all;
}

}  // namespace vantage
