// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/ghost_cells.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "vantage/base/test_support.h"
#include "vantage/experiments/ghost_report.h"
#include "vantage/experiments/test_mask_recording.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::GhostSequence;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

/// A drawn simulator, and a drawn sequence in the data folder.
class GhostCells : public ::testing::Test {
 protected:
  GhostCells() : study_(testing::DrawnStudy(folder_ / "out", recorded_)) {
    study_.data = folder_ / "data";
    GhostSequence::Write(study_.data / "sbi/IBMtest2");
  }
  std::vector<Experiment> Named(const std::string& name) const {
    std::vector<Experiment> found;
    for (Experiment& one : GhostExperiments()) {
      if (one.name == name) found.push_back(std::move(one));
    }
    return found;
  }
  TemporaryFolder folder_;
  int recorded_ = 0;
  Study study_;
};

TEST_F(GhostCells, ResultsEqualDirectRuns) {
  study_.frames = 30;
  const auto wanted = [](const GhostCase& one) {
    return one.name == "IBMtest2" || one.name == "floorball-b";
  };
  const GhostPlan plan = PlanGhosts(study_, wanted).value();
  ASSERT_EQ(plan.cases.size(), 2u);
  const CellsReport done = RunCells(study_.output, plan.cells, 2, false).value();
  const GhostResults results = GhostResultsOf(plan, done.results).value();
  ASSERT_EQ(results.variants.size(), StandardGhostVariants(true).size());
  ASSERT_EQ(results.cases.size(), 2u);
  for (const GhostCaseResult& in : results.cases) {
    const fs::path place = in.used.Simulated() ? study_.output / "data/floorball-quick"
                                               : study_.data / in.used.sequence;
    const GhostCaseResult direct = RunGhostCase(in.used, place, results.variants).value();
    ASSERT_EQ(in.runs.size(), direct.runs.size());
    EXPECT_EQ(in.frames_shown, direct.frames_shown);
    for (std::size_t i = 0; i < in.runs.size(); ++i) {
      EXPECT_EQ(in.runs[i].counts.frames, 30);
      EXPECT_EQ(in.runs[i].counts, direct.runs[i].counts) << results.variants[i].name;
    }
  }
}

TEST_F(GhostCells, ResultsOfOtherCells) {
  const auto wanted = [](const GhostCase& one) { return one.name == "IBMtest2"; };
  const GhostPlan plan = PlanGhosts(study_, wanted).value();
  CellsReport done = RunCells(study_.output, plan.cells, 2, false).value();
  CellResults broken = done.results;
  broken.erase("ghosts-ibmtest2-fep");
  EXPECT_THAT(MessageOf(GhostResultsOf(plan, broken)), HasSubstr("ibmtest2-fep: has no result"));
  broken = done.results;
  broken["ghosts-ibmtest2-fep"]["runs"].erase(0);
  EXPECT_THAT(MessageOf(GhostResultsOf(plan, broken)), HasSubstr("has 3 runs, not 4"));
  broken = done.results;
  broken["ghosts-ibmtest2-fep"]["width"] = "wide";
  EXPECT_THAT(MessageOf(GhostResultsOf(plan, broken)), HasSubstr("run with --force"));
}

TEST_F(GhostCells, FiguresShareTheirCells) {
  const Result<StudyReport> of11 = RunStudy(Named("fig11"), study_);
  ASSERT_TRUE(of11) << MessageOf(of11);
  EXPECT_EQ(recorded_, 1);
  EXPECT_EQ(of11->skipped.size(), 3u);  // office, traffic, CaVignal
  EXPECT_FALSE(of11->findings.empty());
  const Result<StudyReport> of10 = RunStudy(Named("fig10"), study_);
  ASSERT_TRUE(of10) << MessageOf(of10);
  EXPECT_EQ(of10->cells_computed, 0);
  for (const Figure& figure : of10->figures) {
    EXPECT_TRUE(figure.simulated);
    EXPECT_THAT(figure.data, HasSubstr("floorball-a (simulated"));
  }
  const Result<StudyReport> of9 = RunStudy(Named("fig9"), study_);
  ASSERT_TRUE(of9) << MessageOf(of9);
  EXPECT_EQ(of9->cells_computed, 0);
  EXPECT_FALSE(of9->figures.at(0).simulated);
  EXPECT_THAT(of9->findings.at(0).thesis, HasSubstr("no criterion matters"));
}

TEST_F(GhostCells, TheDetails) {
  study_.frames = 12;
  const Result<StudyReport> report = RunStudy(Named("ghosts"), study_);
  ASSERT_TRUE(report) << MessageOf(report);
  const std::string html = ReadTextFile(report->page).value();
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(html.c_str()));
  for (const char* words :
       {"The default settings on the simulated presets", "campus", "crowd", "knn-ghosts",
        "IBMtest2 (real)", "floorball-b (simulated)", "standing"}) {
    EXPECT_THAT(html, HasSubstr(words));
  }
  const std::string csv = ReadTextFile(study_.output / "ghosts.csv").value();
  // Four sequences: the real one, ghosts, two of floorball.
  EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 4 * std::ssize(StandardGhostVariants(true)));
  EXPECT_TRUE(fs::exists(study_.output / "ghosts_frames.csv"));
  EXPECT_EQ(std::ranges::count_if(report->figures,
                                  [](const Figure& figure) {
                                    return figure.row == "default settings" &&
                                           figure.measure == "precision";
                                  }),
            4);
}

TEST_F(GhostCells, ABrokenSequenceIsNamed) {
  fs::resize_file(study_.data / "sbi/IBMtest2/input/in000040.png", 60);
  EXPECT_THAT(MessageOf(RunStudy(Named("fig9"), study_)), HasSubstr("in000040.png"));
}

TEST_F(GhostCells, AKeptResultThatWasEdited) {
  const std::vector<Experiment> figure = Named("fig9");
  ASSERT_TRUE(RunStudy(figure, study_));
  const fs::path file = study_.output / "cells/ghosts-ibmtest2-none.json";
  auto json = nlohmann::ordered_json::parse(ReadTextFile(file).value());
  json["result"]["runs"] = 7;
  ASSERT_TRUE(WriteTextFile(file, json.dump()));
  EXPECT_THAT(MessageOf(RunStudy(figure, study_)), HasSubstr("run with --force"));
  study_.force = true;
  EXPECT_TRUE(RunStudy(figure, study_));
}

}  // namespace
}  // namespace vantage
