// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/ghost_report.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/base/text.h"
#include "vantage/experiments/ghost_findings.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryFolder;

/// Every standard variant on one sequence with a ghost and one without, with figures made up so
/// that "fep" is right everywhere, "nb" is as good as none and the others are worse.
GhostResults MadeUp() {
  GhostResults results{.data = "data", .variants = StandardGhostVariants()};
  results.skipped = {"other: data/<other> is not there"};
  for (const bool ghost : {true, false}) {
    GhostCaseResult& in = results.cases.emplace_back();
    in.used = {.name = ghost ? "ghost" : "plain & simple",
               .sequence = "set/one",
               .first = 10,
               .last = 12,
               .ghost = ghost,
               .check = ghost ? std::optional<FrameIndex>(11) : std::nullopt,
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
      run.report.frames = 3;
      run.secs_per_frame = 0.25;
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
  ASSERT_EQ(rows.size(), 1 + 2 * results.variants.size());
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  const auto column = [&](const std::string& name) {
    const auto found = std::find(rows[0].begin(), rows[0].end(), name);
    EXPECT_NE(found, rows[0].end()) << name;
    return static_cast<std::size_t>(found - rows[0].begin());
  };
  const auto& none = rows[1];
  EXPECT_EQ(none[column("variant")], "none");
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
  // 2 sequences, 2 alphas, 3 variants, 3 frames.
  ASSERT_EQ(rows.size(), 1u + 2 * 2 * 3 * 3);
  EXPECT_THAT(rows[1], ::testing::ElementsAre("ghost", "fep", "0.002", "10", "6", "0", "0"));
}

TEST(GhostJson, HoldsDefaultsAndRuns) {
  const GhostResults results = MadeUp();
  const nlohmann::ordered_json json = GhostJson(results);
  EXPECT_EQ(json["defaults"]["background"]["alpha"], MixtureOptions().alpha);
  EXPECT_EQ(json["skipped"].size(), 1u);
  ASSERT_EQ(json["sequences"].size(), 2u);
  EXPECT_EQ(json["sequences"][0]["runs"].size(), results.variants.size());
  EXPECT_EQ(json["sequences"][0]["runs"][0]["f1"], results.cases[0].runs[0].measures.f1);
  EXPECT_TRUE(json["sequences"][1]["runs"][0]["fp_at_check"].is_null());
}

TEST(GhostPage, IsValidAndStandsAlone) {
  const std::string html = GhostPage(MadeUp());
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_string(html.c_str());
  ASSERT_TRUE(parsed) << parsed.description();
  // Three bar charts for each alpha and sequence, two of lines, one of the methods.
  EXPECT_EQ(document.select_nodes("//svg").size(), 2u * 2 * 3 + 2 + 1);
  for (const auto& table : document.select_nodes("//table")) {
    const std::size_t columns = table.node().select_nodes("thead/tr/th").size();
    for (const auto& row : table.node().select_nodes("tbody/tr")) {
      EXPECT_EQ(row.node().select_nodes("td").size(), columns);
    }
  }
  EXPECT_THAT(html, HasSubstr("data/&lt;other&gt; is not there"));
  EXPECT_THAT(html, HasSubstr("plain &amp; simple"));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
  for (const char* outside : {"<script", "<link", "<img", "src=", "href=", "url("}) {
    EXPECT_THAT(html, Not(HasSubstr(outside)));
  }
}

TEST(GhostPage, WithoutSomeVariants) {
  GhostResults results = MadeUp();
  results.variants.resize(1);
  for (GhostCaseResult& in : results.cases) in.runs.resize(1);
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(GhostPage(results).c_str()));
  EXPECT_EQ(Rows(GhostCsv(results)).size(), 3u);
  EXPECT_TRUE(GhostFindings(results).empty());
}

TEST(GhostFindings, SayWhatTheFiguresSay) {
  const auto findings = GhostFindings(MadeUp());
  const auto holds = [&](const std::string& part) {
    const auto found = std::find_if(findings.begin(), findings.end(), [&](const auto& finding) {
      return finding.thesis.find(part) != std::string::npos;
    });
    EXPECT_NE(found, findings.end()) << part;
    return found != findings.end() && found->holds;
  };
  // none: 18 TP, 16 FP, F1 36 / 52; fep: 1; the others, 24 FP: 36 / 60.
  EXPECT_THAT(findings[0].here, HasSubstr("+0.308"));
  EXPECT_TRUE(holds("(FEP) improves"));
  EXPECT_FALSE(holds("plain form"));
  EXPECT_FALSE(holds("narrow border"));
  EXPECT_TRUE(holds("NB in RGB is the same"));
  EXPECT_FALSE(holds("(FER) has almost no effect"));
  EXPECT_TRUE(holds("(EPD) is worse"));
  EXPECT_TRUE(holds("FEP is often the best"));
  EXPECT_TRUE(holds("Where ghosts are rare"));
}

TEST(WriteGhostReport, WritesTheFourFiles) {
  const TemporaryFolder folder;
  GhostResults results = MadeUp();
  results.data = "bytes \xff that are no text";
  ASSERT_TRUE(WriteGhostReport(results, folder.path()));
  EXPECT_EQ(ReadTextFile(folder / "ghosts.csv").value(), GhostCsv(results));
  EXPECT_EQ(ReadTextFile(folder / "ghosts_frames.csv").value(), GhostFramesCsv(results));
  EXPECT_EQ(ReadTextFile(folder / "ghosts.html").value(), GhostPage(results));
  EXPECT_NO_THROW(EXPECT_EQ(
      nlohmann::json::parse(ReadTextFile(folder / "ghosts.json").value())["experiment"], "ghosts"));
}

}  // namespace
}  // namespace vantage
