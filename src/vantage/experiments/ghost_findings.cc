// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/ghost_findings.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace vantage {
namespace {

using Filter = std::function<bool(const GhostCaseResult&, const MixtureOptions&)>;

/// Gains in F1 of a rule over no detection at the same settings, one a run that `counts`.
std::vector<double> Gains(const GhostResults& results, const std::string& rule,
                          const Filter& counts) {
  std::vector<double> gains;
  for (const GhostCaseResult& in : results.cases) {
    for (std::size_t i = 0; i < in.runs.size(); ++i) {
      const MixtureOptions& o = results.variants[i].options.mixture;
      if (results.variants[i].name != rule || !counts(in, o)) continue;
      const GhostRun* none = results.Find(in, "none", o.color, o.rate, o.alpha);
      if (none == nullptr) continue;
      const double gain = in.runs[i].measures.f1 - none->measures.f1;
      if (std::isfinite(gain)) gains.push_back(gain);
    }
  }
  return gains;
}

std::optional<double> MeanGain(const GhostResults& results, const std::string& rule,
                               const Filter& counts) {
  const std::vector<double> gains = Gains(results, rule, counts);
  if (gains.empty()) return std::nullopt;
  double sum = 0;
  for (const double gain : gains) sum += gain;
  return sum / static_cast<double>(gains.size());
}

bool WithGhost(const GhostCaseResult& in, const MixtureOptions&) { return in.used.ghost; }
bool WithoutGhost(const GhostCaseResult& in, const MixtureOptions&) { return !in.used.ghost; }
bool WithGhostInRgb(const GhostCaseResult& in, const MixtureOptions& o) {
  return in.used.ghost && o.color == ColorSpace::kRgb;
}

}  // namespace

std::vector<GhostFinding> GhostFindings(const GhostResults& results) {
  std::vector<GhostFinding> findings;
  const auto add = [&](std::string thesis, const std::string& rule, const Filter& counts,
                       const std::function<bool(double)>& holds) {
    const std::optional<double> gain = MeanGain(results, rule, counts);
    if (!gain) return;
    findings.push_back(
        {std::move(thesis), fmt::format("{}: F1 {:+.3f} on average", rule, *gain), holds(*gain)});
  };
  const auto better = [](double gain) { return gain > kSameF1; };
  const auto same = [](double gain) { return std::abs(gain) <= kSameF1; };
  const auto worse = [](double gain) { return gain < 0; };

  add("With ghosts, foreground edge probability (FEP) improves the masks", "fep", WithGhost,
      better);
  add("The same, in the thesis's plain form", "fep-plain", WithGhost, better);
  add("So does the narrow border (NB)", "nb", WithGhost, better);
  add("NB in RGB is the same as no ghost detection", "nb", WithGhostInRgb, same);
  add("So does the colour-based rule (CB)", "cb", WithGhost, better);
  add("The foreground edge ratio (FER) has almost no effect", "fer", WithGhost, same);
  add("The edge probability difference (EPD) is worse than no ghost detection", "epd", WithGhost,
      worse);

  GhostFinding best{.thesis = "FEP is often the best", .here = "", .holds = true};
  for (const char* rule : {"fep", "fer", "nb", "epd", "cb"}) {
    const std::optional<double> gain = MeanGain(results, rule, WithGhost);
    const std::optional<double> fep = MeanGain(results, "fep", WithGhost);
    if (!gain || !fep) continue;
    best.here += fmt::format("{}{} {:+.3f}", best.here.empty() ? "" : ", ", rule, *gain);
    best.holds &= *gain <= *fep;
  }
  if (!best.here.empty()) findings.push_back(std::move(best));

  GhostFinding similar{
      .thesis = "Where ghosts are rare, every rule performs much as no ghost detection",
      .here = "",
      .holds = true};
  for (const char* rule : {"fep", "nb", "cb", "fep-plain"}) {
    const std::vector<double> gains = Gains(results, rule, WithoutGhost);
    if (gains.empty()) continue;
    const auto [least, most] = std::minmax_element(gains.begin(), gains.end());
    similar.here += fmt::format("{}{} {:+.3f} to {:+.3f}", similar.here.empty() ? "" : ", ", rule,
                                *least, *most);
    similar.holds &= same(*least) && same(*most);
  }
  if (!similar.here.empty()) findings.push_back(std::move(similar));
  return findings;
}

void AddFindings(const GhostResults& results, ReportPage& page) {
  const std::vector<GhostFinding> findings = GhostFindings(results);
  if (findings.empty()) return;
  page.Heading("What the thesis found, and what is found here");
  page.Paragraph(fmt::format(
      "Gains in F1 over no ghost detection, over all colours, rates and alphas; up to {} is about "
      "the same. The thesis's thresholds are for a border and edges that it does not give in full, "
      "and all its rules are in the plain form; here the rules' own thresholds are used, in the "
      "default judgement.",
      kSameF1));
  PageTable table{.header = {"the thesis, section 3.5", "here", "holds here"}, .words = true};
  for (const GhostFinding& finding : findings) {
    table.rows.push_back({finding.thesis, finding.here, finding.holds ? "yes" : "no"});
  }
  page.Table(table);
}

}  // namespace vantage
