// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <utility>

#include "vantage/experiments/ghost_experiment.h"

namespace vantage {
namespace {

std::vector<GhostCase> RealCases() {
  return {
      {.name = "office",
       .sequence = "cdnet/office",
       .figures = {9, 11},
       .note = "Begun with an empty room: no ghost. A man comes, stands for over 1,000 frames and "
               "leaves."},
      {.name = "office from 900",
       .sequence = "cdnet/office",
       .span = {.begin = 900, .first = 1950, .last = 2035},
       .figures = {8},
       .ghost = true,
       .under_mover = FrameWindow{1985, 2000},
       .note = "Begun where the man stands, so that he is background and leaves a ghost when he "
               "turns to go at about frame 1950. He is still in the picture at 2035; from there on "
               "the light changes."},
      {.name = "traffic",
       .sequence = "cdnet/traffic",
       .figures = {9, 11},
       .note = "A road before a shaking camera: no ghost to speak of."},
      {.name = "CaVignal",
       .sequence = "sbi/CaVignal",
       .span = {.first = 150, .last = 257},
       .figures = {8, 9, 11},
       .ghost = true,
       .check = 192,
       .under_mover = FrameWindow{150, 181},
       .note = "A man stands from the first frame on and walks off. Before frame 150 he stands "
               "still and no method can see him. The ghost stands alone from about frame 182; "
               "the check is 10 frames later."},
      {.name = "IBMtest2",
       .sequence = "sbi/IBMtest2",
       .figures = {9, 11},
       .note = "People walk through an empty hall: no ghost."},
  };
}

std::vector<GhostCase> SimulatedCases() {
  return {
      {.name = "ghosts",
       .preset = "ghosts",
       .figures = {8},
       .ghost = true,
       .under_mover = FrameWindow{290, 600},
       .over_edges = FrameWindow{575, 740},
       .hidden = FrameWindow{775, 1045},
       .note = "People and things that are there at the start, leave, come back, sit down. A man "
               "leaves at frame 250, and another creeps across his ghost until 600; a car that is "
               "parked on hatched ground drives off from 500 on; somebody is behind a young tree "
               "and a sign from 775 to 1125; the light changes slowly, and suddenly at 1050."},
      {.name = "floorball-a",
       .preset = "floorball",
       .camera = 0,
       .span = {.last = 299},
       .figures = {10, 11},
       .ghost = true,
       .note = "The first camera of the simulated match. Players are there from the first frame on "
               "and leave ghosts."},
      {.name = "floorball-b",
       .preset = "floorball",
       .camera = 2,
       .span = {.last = 299},
       .figures = {10, 11},
       .ghost = true,
       .note = "The third camera of the same match."},
  };
}

}  // namespace

std::vector<GhostCase> StandardGhostCases() {
  std::vector<GhostCase> cases = RealCases();
  for (GhostCase& one : SimulatedCases()) cases.push_back(std::move(one));
  return cases;
}

GhostOptions StandingGhostOptions() {
  GhostOptions options;
  // No share of edges is above 1: whatever is judged is a ghost, and only what stands still is.
  options.rule.criterion = GhostCriterion::kFep;
  options.rule.fep_threshold = 1;
  options.judgement = GhostJudgement::kStill;
  options.free_share = 0;
  options.still_frames = 25;
  return options;
}

std::vector<GhostVariant> StandardGhostVariants(bool quick) {
  const BackgroundOptions defaults;
  std::vector<std::pair<std::string, GhostOptions>> rules;
  for (const GhostCriterion criterion :
       {GhostCriterion::kNone, GhostCriterion::kFep, GhostCriterion::kFer, GhostCriterion::kNb,
        GhostCriterion::kEpd, GhostCriterion::kCb}) {
    GhostOptions options = defaults.ghosts;
    options.rule.criterion = criterion;
    options.judgement = GhostJudgement::kStill;
    const std::string name(NameOf(criterion));
    rules.emplace_back(name, options);
    if (criterion == GhostCriterion::kNone) continue;
    options.judgement = GhostJudgement::kPlain;
    rules.emplace_back(name + "-plain", options);
  }
  rules.emplace_back("standing", StandingGhostOptions());

  std::vector<double> alphas = {defaults.mixture.alpha};
  if (!quick) alphas.push_back(0.005);
  std::vector<GhostVariant> variants;
  for (const auto& [name, ghosts] : rules) {
    for (const double alpha : alphas) {
      for (const ColorSpace color : {ColorSpace::kLuv, ColorSpace::kRgb}) {
        for (const LearningRate rate : {LearningRate::kModified, LearningRate::kOriginal}) {
          GhostVariant& variant = variants.emplace_back(GhostVariant{name, defaults});
          variant.options.mixture.alpha = alpha;
          variant.options.mixture.color = color;
          variant.options.mixture.rate = rate;
          variant.options.ghosts = ghosts;
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

}  // namespace vantage
