// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/ghost_findings.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "vantage/metrics/mask_measures.h"

namespace vantage {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Which runs count: of these cases at these settings of the mixture.
using CaseFilter = std::function<bool(const GhostCase&)>;
using SettingFilter = std::function<bool(const MixtureOptions&)>;
/// A measure of two runs at the same settings.
using Difference = std::function<double(const GhostCase&, const GhostRun&, const GhostRun&)>;

bool Any(const MixtureOptions&) { return true; }
bool InRgb(const MixtureOptions& o) { return o.color == ColorSpace::kRgb; }
bool InLuv(const MixtureOptions& o) { return o.color == ColorSpace::kLuv; }
bool AtOriginal(const MixtureOptions& o) { return o.rate == LearningRate::kOriginal; }
bool AtModified(const MixtureOptions& o) { return o.rate == LearningRate::kModified; }

double F1Gain(const GhostCase&, const GhostRun& run, const GhostRun& than) {
  return run.measures.f1 - than.measures.f1;
}
double RecallGain(const GhostCase&, const GhostRun& run, const GhostRun& than) {
  return run.measures.recall - than.measures.recall;
}

using WindowOf = std::optional<FrameWindow> GhostCase::*;

/// NaN for cases without such a window.
Difference RecallGainIn(WindowOf window) {
  return [window](const GhostCase& on, const GhostRun& run, const GhostRun& than) {
    if (!(on.*window)) return kNan;
    return MeasureMasks(run.In(*(on.*window))).recall - MeasureMasks(than.In(*(on.*window))).recall;
  };
}
Difference FalseShareIn(WindowOf window) {
  return [window](const GhostCase& on, const GhostRun& run, const GhostRun& than) {
    if (!(on.*window)) return kNan;
    return static_cast<double>(run.In(*(on.*window)).false_positives) /
           static_cast<double>(than.In(*(on.*window)).false_positives);
  };
}

/// Data and judgement that an answer is about.
struct Scope {
  const char* data;
  const char* judgement;
  CaseFilter cases;
  std::string suffix;  ///< of the rules' names
};

/// The results as one scope sees them.
class View {
 public:
  View(const GhostResults& results, const Scope& scope) : results_(results), scope_(scope) {}

  std::string Name(const std::string& rule) const {
    return rule == "standing" || rule == "none" ? rule : rule + scope_.suffix;
  }

  /// Differences between the runs of two rules, one a run that counts.
  std::vector<double> Differences(const std::string& rule, const std::string& than,
                                  const CaseFilter& cases, const SettingFilter& settings,
                                  const Difference& difference = F1Gain) const {
    std::vector<double> found;
    for (const GhostCaseResult& in : results_.cases) {
      if (!scope_.cases(in.used) || !cases(in.used)) continue;
      for (std::size_t i = 0; i < in.runs.size(); ++i) {
        const MixtureOptions& o = results_.variants[i].options.mixture;
        if (results_.variants[i].name != Name(rule) || !settings(o)) continue;
        const GhostRun* other = results_.Find(in, Name(than), o.color, o.rate, o.alpha);
        if (other == nullptr) continue;
        const double value = difference(in.used, in.runs[i], *other);
        if (std::isfinite(value)) found.push_back(value);
      }
    }
    return found;
  }

  /// Their mean; NaN: there is none.
  double Mean(const std::string& rule, const std::string& than, const CaseFilter& cases,
              const SettingFilter& settings = Any, const Difference& difference = F1Gain) const {
    const std::vector<double> values = Differences(rule, than, cases, settings, difference);
    if (values.empty()) return kNan;
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  }

  /// Mean gain in F1 of LUV over RGB.
  double LuvOverRgb(const std::string& rule, const SettingFilter& settings) const {
    double sum = 0;
    int count = 0;
    for (const GhostCaseResult& in : results_.cases) {
      if (!scope_.cases(in.used)) continue;
      for (std::size_t i = 0; i < in.runs.size(); ++i) {
        const MixtureOptions& o = results_.variants[i].options.mixture;
        if (results_.variants[i].name != Name(rule) || !InLuv(o) || !settings(o)) continue;
        const GhostRun* rgb = results_.Find(in, Name(rule), ColorSpace::kRgb, o.rate, o.alpha);
        if (rgb == nullptr || !std::isfinite(F1Gain(in.used, in.runs[i], *rgb))) continue;
        sum += F1Gain(in.used, in.runs[i], *rgb);
        ++count;
      }
    }
    return count == 0 ? kNan : sum / count;
  }

 private:
  const GhostResults& results_;
  const Scope& scope_;
};

/// What is found in a view; nullopt: it has no runs for it.
struct Answer {
  std::string here;
  bool holds;
};
using Question = std::function<std::optional<Answer>(const View&)>;

CaseFilter InFigure(int figure) {
  return [figure](const GhostCase& one) { return one.figures.contains(figure); };
}
bool All(const GhostCase&) { return true; }

bool Better(double gain) { return gain > kSameF1; }
bool Same(double gain) { return std::abs(gain) <= kSameF1; }
bool Worse(double gain) { return gain < 0; }
bool Positive(double gain) { return gain > 0; }

/// Mean gains of rules over none, each of which must be so.
Question Gains(const std::vector<std::pair<std::string, SettingFilter>>& rules,
               const CaseFilter& cases, bool (*holds)(double)) {
  return [=](const View& view) -> std::optional<Answer> {
    Answer answer{.here = "F1 ", .holds = true};
    for (std::size_t i = 0; i < rules.size(); ++i) {
      const auto& [rule, settings] = rules[i];
      const double gain = view.Mean(rule, "none", cases, settings);
      if (std::isnan(gain)) return std::nullopt;
      answer.here += fmt::format("{}{} {:+.3f}", i == 0 ? "" : ", ", rule, gain);
      answer.holds &= holds(gain);
    }
    return answer;
  };
}

std::optional<Answer> BestOfAll(const View& view) {
  const double fep = view.Mean("fep", "none", All);
  if (std::isnan(fep)) return std::nullopt;
  Answer answer{.here = fmt::format("F1 fep {:+.3f}", fep), .holds = true};
  for (const char* rule : {"fer", "nb", "epd", "cb"}) {
    const double gain = view.Mean(rule, "none", All);
    if (std::isnan(gain)) continue;
    answer.here += fmt::format(", {} {:+.3f}", rule, gain);
    answer.holds &= gain <= fep;
  }
  return answer;
}

std::optional<Answer> MostAtOriginal(const View& view) {
  const double original = view.Mean("fep", "none", All, AtOriginal);
  const double modified = view.Mean("fep", "none", All, AtModified);
  if (std::isnan(original) || std::isnan(modified)) return std::nullopt;
  return Answer{fmt::format("F1 fep {:+.3f} at the original rate, {:+.3f} at the modified one",
                            original, modified),
                Better(original) && modified < original};
}

std::optional<Answer> LuvBest(const View& view) {
  const double fep = view.LuvOverRgb("fep", AtOriginal);
  const double none = view.LuvOverRgb("none", AtOriginal);
  if (std::isnan(fep) || std::isnan(none)) return std::nullopt;
  return Answer{fmt::format("F1 of LUV over that of RGB: fep {:+.3f}, none {:+.3f}", fep, none),
                Positive(fep)};
}

std::optional<Answer> BeatsTheRival(const View& view) {
  const double f1 = view.Mean("fep", "standing", All);
  const double recall = view.Mean("fep", "standing", All, Any, RecallGain);
  if (std::isnan(f1) || std::isnan(recall)) return std::nullopt;
  return Answer{fmt::format("fep over \"standing\": F1 {:+.3f}, recall {:+.3f}", f1, recall),
                Positive(f1)};
}

/// What FEP costs in recall where people are hidden in part.
std::optional<Answer> HiddenLost(const View& view) {
  const double gain = view.Mean("fep", "none", All, Any, RecallGainIn(&GhostCase::hidden));
  if (std::isnan(gain)) return std::nullopt;
  return Answer{fmt::format("recall of fep to that of none meanwhile: {:+.3f}", gain),
                gain < -kSameF1};
}

/// Whether FEP leaves most of a ghost.
Question LeavesGhost(WindowOf window) {
  return [window](const View& view) -> std::optional<Answer> {
    const double share = view.Mean("fep", "none", All, Any, FalseShareIn(window));
    if (std::isnan(share)) return std::nullopt;
    return Answer{fmt::format("fep leaves {:.0f} % of none's false pixels meanwhile", 100 * share),
                  share > 0.5};
  };
}

}  // namespace

std::vector<Finding> GhostFindings(const GhostResults& results, int figure) {
  const auto real = [](const GhostCase& one) { return !one.Simulated(); };
  const auto simulated = [](const GhostCase& one) { return one.Simulated(); };
  const std::vector<Scope> apart = {{"real", "plain", real, "-plain"},
                                    {"real", "ours", real, ""},
                                    {"simulated", "plain", simulated, "-plain"},
                                    {"simulated", "ours", simulated, ""}};
  const std::vector<Scope> together = {{"real and simulated", "plain", All, "-plain"},
                                       {"real and simulated", "ours", All, ""}};

  std::vector<Finding> findings;
  const auto ask = [&](int of, const std::string& thesis, const Question& question) {
    if (of != figure) return;
    for (const Scope& scope : figure == 11 ? together : apart) {
      const std::optional<Answer> answer = question(View(results, scope));
      if (!answer) continue;
      findings.push_back(
          {.thesis = thesis,
           .here = fmt::format("{}, judged {}: {}", scope.data, scope.judgement, answer->here),
           .verdict = answer->holds ? Verdict::kHolds : Verdict::kDoesNotHold});
    }
  };
  const CaseFilter cases = InFigure(figure);
  ask(8, "FEP, NB and CB remove the ghost of the parked car (figure 5)",
      Gains({{"fep", Any}, {"nb", Any}, {"cb", Any}}, cases, Better));
  ask(8, "FER has almost no effect on the parked car (figure 5)",
      Gains({{"fer", Any}}, cases, Same));
  ask(8, "EPD is worse than no ghost detection on the parked car (figure 5)",
      Gains({{"epd", Any}}, cases, Worse));
  ask(8, "On intermittent motion NB in RGB performs as no ghost detection (figure 8)",
      Gains({{"nb", InRgb}}, cases, Same));
  ask(8, "FEP, CB, and NB in LUV, offer significant improvement on intermittent motion (figure 8)",
      Gains({{"fep", Any}, {"cb", Any}, {"nb", InLuv}}, cases, Better));
  ask(9, "On the whole change-detection set no criterion matters (figure 9)",
      Gains({{"fep", Any}, {"nb", Any}, {"cb", Any}}, cases, Same));
  ask(10, "On floorball every criterion improves the masks significantly (figure 10)",
      Gains({{"fep", Any}, {"nb", Any}, {"cb", Any}}, cases, Better));
  ask(11, "On both together every criterion has a positive effect (figure 11)",
      Gains({{"fep", Any}, {"nb", Any}, {"cb", Any}}, cases, Positive));
  ask(0, "FEP is the best all-round criterion", BestOfAll);
  ask(0, "Ghost detection helps much at the original rate, less at the modified one",
      MostAtOriginal);
  ask(0, "LUV beats RGB at the original rate", LuvBest);
  ask(0, "The rival of 3.2, whatever stands still is a ghost, is worse than FEP", BeatsTheRival);
  ask(0, "Weak spot: people hidden behind branches and signs are taken for ghosts", HiddenLost);
  ask(0, "Weak spot: a ghost under somebody who moves is missed until he is away",
      LeavesGhost(&GhostCase::under_mover));
  ask(0, "Weak spot: a ghost over strong edges of the background is missed",
      LeavesGhost(&GhostCase::over_edges));
  return findings;
}

}  // namespace vantage
