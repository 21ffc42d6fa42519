// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/ghost_report.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <pugixml.hpp>

#include "vantage/base/text.h"
#include "vantage/experiments/ghost_findings.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Every standard variant on real and simulated sequences with a ghost and without, with figures
/// made up so that "fep" is right everywhere, "nb" is as good as none and the others are worse;
/// judged plainly all are worse.
GhostResults MadeUp() {
  GhostResults results{.variants = StandardGhostVariants()};
  for (const bool simulated : {false, true}) {
    for (const bool ghost : {true, false}) {
      GhostCaseResult& in = results.cases.emplace_back();
      in.used = {.name = std::string(simulated ? "simulated" : "real") +
                         (ghost ? " ghost" : " plain & simple"),
                 .sequence = simulated ? "" : "set/one",
                 .preset = simulated ? "floorball" : "",
                 .span = {.first = 10, .last = 12},
                 .figures = ghost       ? std::set<int>{8, 11}
                            : simulated ? std::set<int>{10, 11}
                                        : std::set<int>{9, 11},
                 .ghost = ghost,
                 .check = ghost ? std::optional<FrameIndex>(11) : std::nullopt,
                 .under_mover = ghost ? std::optional<FrameWindow>({11, 11}) : std::nullopt,
                 .hidden = ghost ? std::optional<FrameWindow>({10, 11}) : std::nullopt,
                 .note = "a <note>"};
      in.size = {4, 5};
      for (const GhostVariant& variant : results.variants) {
        GhostRun& run = in.runs.emplace_back();
        const bool good = variant.name == "fep" || !ghost;
        const bool middling = variant.name == "none" || variant.name == "nb";
        for (FrameIndex frame = 10; frame <= 12; ++frame) {
          MaskCounts counts{.frames = 1, .true_positives = 6, .true_negatives = 4};
          counts.false_positives = good ? 0 : middling ? 5 + frame % 2 : 8;
          run.frames.push_back({frame, counts});
        }
        run.counts = SumOf(run.frames);
        run.measures = MeasureMasks(run.counts);
        run.secs_per_frame = 0.25;
      }
    }
  }
  return results;
}

std::vector<std::vector<std::string>> Rows(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  EXPECT_TRUE(ForEachLine(csv, [&](std::string_view line, std::size_t) -> Status {
    std::vector<std::string>& row = rows.emplace_back();
    for (const std::string_view field : Fields(line)) row.emplace_back(field);
    return {};
  }));
  return rows;
}

TEST(GhostCsv, OneLineARun) {
  const GhostResults results = MadeUp();
  const auto rows = Rows(GhostCsv(results));
  ASSERT_EQ(rows.size(), 1 + 4 * results.variants.size());
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  const auto column = [&](const std::string& name) {
    const auto found = std::find(rows[0].begin(), rows[0].end(), name);
    EXPECT_NE(found, rows[0].end()) << name;
    return static_cast<std::size_t>(found - rows[0].begin());
  };
  const auto& none = rows[1];
  EXPECT_EQ(none[column("variant")], "none");
  EXPECT_EQ(none[column("data")], "real");
  EXPECT_EQ(none[column("place")], "set/one");
  EXPECT_EQ(rows.back()[column("data")], "simulated");
  EXPECT_EQ(rows.back()[column("place")], "floorball");
  EXPECT_EQ(none[column("threshold")], "");
  EXPECT_EQ(none[column("first")], "10");
  EXPECT_EQ(none[column("last")], "12");
  EXPECT_EQ(none[column("tp")], "18");
  EXPECT_EQ(none[column("fp")], "16");
  EXPECT_EQ(none[column("fp_peak")], "6");
  EXPECT_EQ(none[column("fp_peak_frame")], "11");
  EXPECT_EQ(none[column("fp_at_check")], "6");
  EXPECT_EQ(none[column("color")], "luv");
  const auto& knn = rows[results.variants.size()];
  EXPECT_EQ(knn[column("method")], "knn");
  EXPECT_EQ(knn[column("color")], "");
  EXPECT_EQ(knn[column("alpha")], "");
  EXPECT_EQ(rows.back()[column("check")], "");
  EXPECT_EQ(rows.back()[column("fp_at_check")], "");
}

TEST(GhostFramesCsv, TheRunsOfTheLines) {
  const auto rows = Rows(GhostFramesCsv(MadeUp()));
  // 4 sequences, 2 alphas, 3 variants, 3 frames.
  ASSERT_EQ(rows.size(), 1u + 4 * 2 * 3 * 3);
  EXPECT_THAT(rows[1], ::testing::ElementsAre("real ghost", "fep", "0.002", "10", "6", "0", "0"));
}

/// Whatever the pages show, it must be XML with full tables and nothing from outside.
void ExpectWellFormed(const std::string& html, std::size_t charts) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_string(html.c_str());
  ASSERT_TRUE(parsed) << parsed.description();
  EXPECT_EQ(document.select_nodes("//svg").size(), charts);
  for (const auto& table : document.select_nodes("//table")) {
    const std::size_t columns = table.node().select_nodes("thead/tr/th").size();
    for (const auto& row : table.node().select_nodes("tbody/tr")) {
      EXPECT_EQ(row.node().select_nodes("td").size(), columns);
    }
  }
  EXPECT_THAT(html, Not(HasSubstr("nan")));
  for (const char* outside : {"<script", "<link", "<img", "src=", "href=", "url("}) {
    EXPECT_THAT(html, Not(HasSubstr(outside)));
  }
}

TEST(GhostFigure, BarsOfEachKindOfData) {
  const GhostResults results = MadeUp();
  for (const auto& [figure, groups] : {std::pair(8, 2u), {9, 1u}, {10, 1u}, {11, 1u}}) {
    ReportPage page("bars");
    std::vector<Figure> figures;
    AddGhostFigure(results, figure, page, figures);
    // Three charts for each kind of data and judgement.
    ExpectWellFormed(page.Html(), 3 * 2 * groups);
    // Seven rules at four settings.
    ASSERT_EQ(figures.size(), 3 * 2 * groups * 7 * 4);
  }
}

TEST(GhostFigure, MeansOverTheCases) {
  const GhostResults results = MadeUp();
  ReportPage page("bars");
  std::vector<Figure> figures;
  AddGhostFigure(results, 11, page, figures);
  const auto f1 = [&](const std::string& row) {
    const auto found = std::find_if(figures.begin(), figures.end(), [&](const Figure& one) {
      return one.row == row && one.measure == "f1";
    });
    EXPECT_NE(found, figures.end()) << row;
    return found == figures.end() ? 0 : found->value;
  };
  // 18 true, 16 false positives where there is a ghost; in the other two cases all is right.
  EXPECT_NEAR(f1("none LUV M real and simulated"), (36.0 / 52 + 1) / 2, 1e-12);
  EXPECT_NEAR(f1("epd RGB O real and simulated"), (36.0 / 60 + 1) / 2, 1e-12);
  EXPECT_NEAR(f1("fep RGB O real and simulated"), 1, 1e-12);
  EXPECT_TRUE(figures[0].simulated);
  EXPECT_THAT(figures[0].data, HasSubstr("real ghost (real, 3 frames)"));
}

TEST(GhostDetails, IsValidAndStandsAlone) {
  ReportPage page("details");
  AddGhostDetails(MadeUp(), page);
  const std::string html = page.Html();
  // Two charts of lines in each case with a ghost, one of the methods.
  ExpectWellFormed(html, 2u * 2 + 1);
  EXPECT_THAT(html, HasSubstr("plain &amp; simple (simulated)"));
  EXPECT_THAT(html, HasSubstr("preset floorball, camera 1"));
}

TEST(GhostDetails, WithoutSomeVariants) {
  GhostResults results = MadeUp();
  results.variants.resize(1);
  for (GhostCaseResult& in : results.cases) in.runs.resize(1);
  ReportPage page("details");
  std::vector<Figure> figures;
  AddGhostDetails(results, page);
  AddGhostFigure(results, 8, page, figures);
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(page.Html().c_str()));
  EXPECT_EQ(Rows(GhostCsv(results)).size(), 5u);
  for (const int figure : {0, 8, 9, 10, 11}) {
    EXPECT_TRUE(GhostFindings(results, figure).empty()) << figure;
  }
  results.cases.clear();
  AddGhostDetails(results, page);
  AddGhostFigure(results, 8, page, figures);
}

/// The verdict on the finding with these words, of this kind of data and judgement.
Verdict VerdictOf(const GhostResults& results, int figure, const std::string& words,
                  const std::string& scope) {
  for (const Finding& finding : GhostFindings(results, figure)) {
    if (finding.thesis.find(words) != std::string::npos && finding.here.starts_with(scope)) {
      return finding.verdict;
    }
  }
  ADD_FAILURE() << words << ", " << scope;
  return Verdict::kNotDecided;
}

TEST(GhostFindings, SayWhatTheFiguresSay) {
  const GhostResults results = MadeUp();
  const auto holds = [&](int figure, const std::string& words, const std::string& scope) {
    return VerdictOf(results, figure, words, scope) == Verdict::kHolds;
  };
  for (const std::string data : {"real", "simulated"}) {
    const std::string ours = data + ", judged ours", plain = data + ", judged plain";
    EXPECT_FALSE(holds(8, "FEP, NB and CB remove", ours));
    EXPECT_FALSE(holds(8, "FER has almost no effect", ours));
    EXPECT_TRUE(holds(8, "EPD is worse", ours));
    EXPECT_TRUE(holds(8, "NB in RGB performs as no", ours));
    EXPECT_FALSE(holds(8, "NB in RGB performs as no", plain));
    EXPECT_FALSE(holds(8, "significant improvement on intermittent", ours));
    EXPECT_TRUE(holds(0, "FEP is the best", ours));
    EXPECT_TRUE(holds(0, "FEP is the best", plain));  // as good as the others
    EXPECT_FALSE(holds(0, "Ghost detection helps much at the original", ours));  // as much at both
    EXPECT_FALSE(holds(0, "LUV beats RGB", ours));                               // the same
    EXPECT_TRUE(holds(0, "The rival", ours));
    EXPECT_FALSE(holds(0, "The rival", plain));
    EXPECT_FALSE(holds(0, "Weak spot: people hidden", ours));
    EXPECT_FALSE(holds(0, "Weak spot: a ghost under", ours));
    EXPECT_TRUE(holds(0, "Weak spot: a ghost under", plain));
  }
  for (const Finding& finding : GhostFindings(results, 0)) {
    EXPECT_THAT(finding.thesis, Not(HasSubstr("strong edges")));  // no case has such a window
    if (finding.thesis.find("somebody who moves") != std::string::npos &&
        finding.here.starts_with("real, judged plain")) {
      EXPECT_THAT(finding.here, HasSubstr("leaves 133 %"));  // 8 of 6 in frame 11
    }
  }
  EXPECT_TRUE(holds(9, "no criterion matters", "real, judged ours"));
  EXPECT_FALSE(holds(10, "every criterion improves", "simulated, judged ours"));
  EXPECT_FALSE(holds(11, "positive effect", "real and simulated, judged ours"));
  // none: 18 TP, 16 FP, F1 36 / 52; fep: 1; the others, 24 FP: 36 / 60.
  const std::vector<Finding> of8 = GhostFindings(results, 8);
  EXPECT_THAT(of8.at(1).here, HasSubstr("F1 fep +0.308, nb +0.000, cb -0.092"));
}

/// A figure of the thesis is confirmed or contradicted by the cells, not by us.
TEST(GhostFindings, ChangeWithTheFigures) {
  GhostResults results = MadeUp();
  for (GhostCaseResult& in : results.cases) {
    for (std::size_t i = 0; i < in.runs.size(); ++i) {
      const GhostVariant& variant = results.variants[i];
      const bool luv = variant.options.mixture.color == ColorSpace::kLuv;
      const bool original = variant.options.mixture.rate == LearningRate::kOriginal;
      double& f1 = in.runs[i].measures.f1;
      f1 = variant.name == "none" ? 0.5 : luv ? 0.7 : 0.6;
      if (original && variant.name != "none") f1 += 0.1;
      if (variant.name == "nb") f1 += 0.05;
      if (variant.name == "standing") f1 = 0.9;
    }
  }
  const std::string real = "real, judged ours";
  EXPECT_EQ(VerdictOf(results, 0, "FEP is the best", real), Verdict::kDoesNotHold);
  EXPECT_EQ(VerdictOf(results, 0, "LUV beats RGB", real), Verdict::kHolds);
  EXPECT_EQ(VerdictOf(results, 0, "at the original rate, less", real), Verdict::kHolds);
  EXPECT_EQ(VerdictOf(results, 0, "The rival", real), Verdict::kDoesNotHold);
  EXPECT_EQ(VerdictOf(results, 8, "EPD is worse", real), Verdict::kDoesNotHold);
  EXPECT_EQ(VerdictOf(results, 8, "significant improvement on", real), Verdict::kHolds);
  EXPECT_EQ(VerdictOf(results, 9, "no criterion matters", real), Verdict::kDoesNotHold);
}

}  // namespace
}  // namespace vantage
