// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/experiment.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <pugixml.hpp>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/experiments/recordings.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MessageOf;
using ::testing::SizeIs;
using testing::TemporaryFolder;
using Json = nlohmann::ordered_json;

/// An experiment on a recording that is only a text file.
Experiment LengthExperiment(int settings) {
  return {
      .name = "lengths",
      .title = "Lengths <of> recordings",
      .summary = "",
      .also = {},
      .plan = [settings](const Study& study) -> Result<ExperimentPlan> {
        simulation::RecordOptions options;
        options.preset = "floorball";
        options.stage.frames = 50;
        VANTAGE_ASSIGN_OR_RETURN(const CellPtr recording,
                                 SimulatedRecording(study, "small", options));
        ExperimentPlan plan{.skipped = {"the real one is not there"}};
        for (int i = 0; i < settings; ++i) {
          plan.cells.push_back(std::make_shared<const Cell>(
              Cell{.name = fmt::format("length-{}", i),
                   .inputs = {{"factor", i}},
                   .needs = {recording},
                   .run = [i](const CellRun& run) -> Result<Json> {
                     VANTAGE_ASSIGN_OR_RETURN(const std::string text,
                                              ReadTextFile(run.folder / "data/small/frames"));
                     return Json{{"length", i * std::stoi(text)}, {"seconds", 0.25 * i}};
                   }}));
        }
        plan.report = [cells = plan.cells](const CellResults& results, ReportPage& page,
                                           ExperimentReport& report) -> Status {
          for (const CellPtr& cell : cells) {
            report.figures.push_back({.row = cell->name + ", long",
                                      .measure = "length",
                                      .value = results.at(cell->name).at("length").get<double>(),
                                      .thesis = 3,
                                      .data = "small",
                                      .simulated = true});
          }
          page.Subheading("Details & more");
          report.findings.push_back(
              {.thesis = "Long is < short", .here = "it is not", .verdict = Verdict::kDoesNotHold});
          return {};
        };
        return plan;
      }};
}

/// A study whose simulator writes the number of frames and counts its runs.
struct SmallStudy {
  TemporaryFolder folder;
  std::shared_ptr<int> recorded = std::make_shared<int>(0);
  Study study;
  SmallStudy() {
    study.output = folder / "out";
    study.record = [recorded = recorded](const simulation::RecordOptions& options,
                                         const fs::path& to, int,
                                         const RunControl&) -> Result<simulation::RecordReport> {
      ++*recorded;
      std::ofstream(to / "frames") << options.stage.frames.value();
      return simulation::RecordReport{.film = {}, .frames = *options.stage.frames};
    };
  }
  Result<StudyReport> Run(int settings = 3) const {
    return RunStudy(std::vector{LengthExperiment(settings)}, study);
  }
};

TEST(RunStudy, WritesPageAndCsv) {
  const SmallStudy small;
  const StudyReport report = small.Run().value();
  EXPECT_EQ(report.cells_computed, 4);
  EXPECT_THAT(report.skipped, ElementsAre("lengths: the real one is not there"));
  EXPECT_EQ(ReadTextFile(small.study.output / "figures.csv").value(),
            "experiment,row,measure,value,thesis,data,simulated\n"
            "lengths,\"length-0, long\",length,0,3,small,1\n"
            "lengths,\"length-1, long\",length,50,3,small,1\n"
            "lengths,\"length-2, long\",length,100,3,small,1\n");
  const std::string html = ReadTextFile(small.study.output / "report.html").value();
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_string(html.c_str());
  EXPECT_TRUE(parsed) << parsed.description();
  EXPECT_THAT(html,
              HasSubstr("<h2>Lengths &lt;of&gt; recordings</h2>\n<h3>Details &amp; more</h3>"));
  EXPECT_THAT(html, HasSubstr("<td>does not hold</td>"));
  EXPECT_THAT(html, HasSubstr("the real one is not there"));
  EXPECT_EQ(JsonOf(report)["findings"][0]["verdict"], "does not hold");
  EXPECT_EQ(JsonOf(report)["figures"].size(), 3u);
}

TEST(RunStudy, ASecondRunKeepsAllAndWritesTheSame) {
  const SmallStudy small;
  ASSERT_TRUE(small.Run());
  const std::string csv = ReadTextFile(small.study.output / "figures.csv").value();
  const std::string page = ReadTextFile(small.study.output / "report.html").value();
  const StudyReport again = small.Run().value();
  EXPECT_EQ(again.cells_computed, 0);
  EXPECT_EQ(*small.recorded, 1);
  EXPECT_EQ(ReadTextFile(again.csv).value(), csv);
  EXPECT_EQ(ReadTextFile(again.page).value(), page);
  EXPECT_EQ(small.Run(5)->cells_computed, 2);
  EXPECT_EQ(*small.recorded, 1);
}

TEST(RunStudy, FewerFramesAreAnotherRecording) {
  SmallStudy small;
  ASSERT_TRUE(small.Run());
  small.study.frames = 7;
  const StudyReport report = small.Run().value();
  EXPECT_EQ(report.cells_computed, 4);
  EXPECT_EQ(report.figures[2].value, 14);
  EXPECT_EQ(*small.recorded, 2);
}

TEST(RunStudy, ThreadsDoNotMatter) {
  const SmallStudy sequential;
  SmallStudy parallel;
  parallel.study.threads = 3;
  const StudyReport a = sequential.Run(12).value();
  const StudyReport b = parallel.Run(12).value();
  EXPECT_EQ(ReadTextFile(a.csv).value(), ReadTextFile(b.csv).value());
  EXPECT_EQ(ReadTextFile(a.page).value(), ReadTextFile(b.page).value());
}

TEST(RunStudy, FoldersThatWillNotDo) {
  SmallStudy small;
  const auto message = [&](const fs::path& output, const fs::path& data = {}) {
    small.study.output = output;
    small.study.data = data;
    return MessageOf(small.Run());
  };
  const fs::path root = small.folder.path();
  fs::create_directories(root / "data/sub");
  fs::create_directories(root / "mine");
  std::ofstream(root / "mine/file") << "mine";
  EXPECT_THAT(message(""), HasSubstr("name of the output folder is empty"));
  EXPECT_THAT(message(root / "mine"), HasSubstr("already holds files"));
  EXPECT_THAT(message(root / "mine/file"), HasSubstr("is a file"));
  EXPECT_THAT(message("/dev/null/out"), HasSubstr("/dev/null"));
  EXPECT_THAT(message(root / "out", root / "none"), HasSubstr("none: no such folder"));
  EXPECT_THAT(message(root / "data/out", root / "data"), HasSubstr("must not lie in each other"));
  EXPECT_THAT(message(root / "data", root / "data/sub"), HasSubstr("must not lie in each other"));
  EXPECT_FALSE(fs::exists(root / "out"));
  EXPECT_FALSE(fs::exists(root / "data/out"));
  EXPECT_EQ(*small.recorded, 0);
}

TEST(RunStudy, NothingToRun) {
  const SmallStudy small;
  EXPECT_THAT(MessageOf(small.Run(0)), HasSubstr("nothing can be run: lengths: the real one"));
  EXPECT_FALSE(fs::exists(small.study.output));
}

TEST(ChooseExperiments, ByNamesInTheOrderOfThePage) {
  EXPECT_THAT(ChooseExperiments({"all"}).value(), SizeIs(Experiments().size()));
  EXPECT_THAT(ChooseExperiments({"fig9", "fig9"}).value(), SizeIs(1));
  for (const Experiment& one : Experiments()) {
    std::vector<std::string> names = one.also;
    names.push_back(one.name);
    for (const std::string& name : names) {
      const std::vector<Experiment> chosen = ChooseExperiments({name}).value();
      EXPECT_EQ(std::ranges::count(chosen, one.name, &Experiment::name), 1) << name;
    }
  }
  EXPECT_THAT(MessageOf(ChooseExperiments({"ghosts", "table9"})),
              HasSubstr("table9: no such experiment; there are all, "));
  EXPECT_THAT(MessageOf(ChooseExperiments({})), HasSubstr("no experiment is named"));
}

TEST(FiguresCsv, QuotesWhatNeedsIt) {
  EXPECT_EQ(FiguresCsv({{.experiment = "e",
                         .row = "a \"b\", c",
                         .measure = "m",
                         .value = std::nan(""),
                         .data = "d"},
                        {.experiment = "e", .row = "r", .measure = "m", .value = 0.125}}),
            "experiment,row,measure,value,thesis,data,simulated\n"
            "e,\"a \"\"b\"\", c\",m,,,d,0\n"
            "e,r,m,0.125,,,0\n");
}

TEST(DescribeData, FilesAndFolders) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a") << "abc";
  std::ofstream(folder / "b") << "de";
  EXPECT_EQ(DescribeData(folder.path()).value().dump(), R"({"files":2,"bytes":5})");
  EXPECT_EQ(DescribeData(folder / "a").value()["bytes"], 3);
  EXPECT_THAT(MessageOf(DescribeData(folder / "c")), HasSubstr("no such file"));
}

}  // namespace
}  // namespace vantage
