// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// `vantage reproduce`, as a user runs it.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "test_program.h"
#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/experiments/test_ghost_sequence.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using testing::Entries;
using testing::ExpectOneLine;
using testing::GhostSequence;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::RunProgram;
using testing::TemporaryFolder;

/// A data folder with one of the standard sequences, drawn.
struct DrawnData {
  TemporaryFolder folder;
  DrawnData() { GhostSequence::Write(sequence()); }
  fs::path data() const { return folder / "data"; }
  fs::path sequence() const { return data() / "sbi/IBMtest2"; }
  fs::path out() const { return folder / "out"; }
  Outcome Run(const std::string& more = "") const {
    return RunProgram(fmt::format("reproduce fig9 --quick --data '{}' -o '{}' --quiet {}",
                                  data().string(), out().string(), more));
  }
};

TEST(Reproduce, WritesThePageFromWhatIsThere) {
  const DrawnData drawn;
  const Outcome outcome = drawn.Run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("sbi/CaVignal is not in the data folder"));
  EXPECT_THAT(outcome.out, HasSubstr("report.html"));
  EXPECT_THAT(ReadTextFile(drawn.out() / "report.html").value(), HasSubstr("IBMtest2"));
  EXPECT_THAT(ReadTextFile(drawn.out() / "figures.csv").value(),
              HasSubstr("\nfig9,none LUV M real,f1,0."));
}

TEST(Reproduce, ASecondRunKeepsWhatIsThere) {
  const DrawnData drawn;
  ASSERT_EQ(drawn.Run().status, 0);
  const std::string page = ReadTextFile(drawn.out() / "report.html").value();
  const Outcome again = drawn.Run();
  EXPECT_THAT(again.out, HasSubstr("0 computed, 16 kept"));
  EXPECT_EQ(ReadTextFile(drawn.out() / "report.html").value(), page);
  fs::resize_file(drawn.out() / "cells/ghosts-ibmtest2-fep.json", 60);
  const Outcome damaged = drawn.Run("--json --threads 1");
  ASSERT_EQ(damaged.status, 0) << damaged.err;
  const auto json = nlohmann::json::parse(damaged.out);
  EXPECT_EQ(json["cells_computed"], 1);
  EXPECT_EQ(json["skipped"].size(), 3u);
  EXPECT_THAT(json["notes"][0].get<std::string>(),
              HasSubstr("ghosts-ibmtest2-fep.json: is damaged"));
  EXPECT_EQ(ReadTextFile(drawn.out() / "report.html").value(), page);
}

TEST(Reproduce, ASimulatedTableInItsSmallestForm) {
  const TemporaryFolder folder;
  const std::string command =
      fmt::format("reproduce table3 --quick --frames 10 -o '{}/out' --quiet --json --threads 2",
                  folder.path().string());
  const Outcome outcome = RunProgram(command);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["cells_computed"], 10);  // recording, masks, 8 rows
  EXPECT_EQ(json["figures"].size(), 8u * 8 * 2);
  EXPECT_EQ(json["figures"][0]["simulated"], true);
  EXPECT_EQ(json["figures"][0]["thesis"], 0.5938);
  EXPECT_TRUE(fs::exists(folder.path() / "out/data/floorball-quick/scene.toml"));
  pugi::xml_document page;
  EXPECT_TRUE(page.load_string(ReadTextFile(folder.path() / "out/report.html").value().c_str()));
  const auto again = nlohmann::json::parse(RunProgram(command).out);
  EXPECT_EQ(again["cells_computed"], 0);
  EXPECT_EQ(again["figures"], json["figures"]);
}

TEST(Reproduce, SimulatedMasksInTheirSmallestForm) {
  const TemporaryFolder folder;
  const std::string command =
      fmt::format("reproduce fig1 fig5 --quick --frames 8 -o '{}/out' --quiet --json --threads 2",
                  folder.path().string());
  const Outcome outcome = RunProgram(command);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["cells_computed"], 4);  // two recordings, two grids
  EXPECT_EQ(json["findings"].size(), 1u);
  const std::string html = ReadTextFile(folder.path() / "out/report.html").value();
  pugi::xml_document page;
  EXPECT_TRUE(page.load_string(html.c_str()));
  EXPECT_GT(page.select_nodes("//img").size(), 15u);
  EXPECT_EQ(nlohmann::json::parse(RunProgram(command).out)["cells_computed"], 0);
}

TEST(Reproduce, WrongUsage) {
  const DrawnData drawn;
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  ExpectOneLine(RunProgram("reproduce"), 2, "experiment is required");
  ExpectOneLine(RunProgram("reproduce fig9"), 2, "--output is required");
  ExpectOneLine(RunProgram("reproduce fig9 --frames -1 -o " + out), 2, "--frames");
  ExpectOneLine(RunProgram("reproduce table9 --quiet -o " + out), 1,
                "table9: no such experiment; there are all, ");
  ExpectOneLine(RunProgram("reproduce fig9 --quiet -o " + out), 1, "nothing can be run: fig9");
  EXPECT_FALSE(fs::exists(folder / "out"));
  const Outcome help = RunProgram("reproduce --help");
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.out, HasSubstr("  ghosts "));
  EXPECT_THAT(help.out, HasSubstr("  all "));
}

TEST(Reproduce, MissingData) {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& data) {
    return RunProgram(fmt::format("reproduce fig9 --quick --data '{0}/{1}' -o '{0}/out' --quiet",
                                  folder.path().string(), data));
  };
  ExpectOneLine(run("none"), 1, "none: no such folder");
  std::ofstream(folder / "file").flush();
  ExpectOneLine(run("file"), 1, "file: no such folder");
  fs::create_directory(folder / "empty");
  ExpectOneLine(run("empty"), 1, "cdnet/office is not in the data folder");
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(Reproduce, AnOutputThatHoldsSomethingElse) {
  const DrawnData drawn;
  fs::create_directories(drawn.out());
  std::ofstream(drawn.out() / "mine.txt") << "mine";
  for (const char* more : {"", "--force"}) {
    ExpectOneLine(drawn.Run(more), 1, "already holds files");
    EXPECT_EQ(Entries(drawn.out()), std::vector<std::string>{"mine.txt"});
  }
  ExpectOneLine(
      RunProgram(fmt::format("reproduce fig9 --quick --data '{}' -o /dev/null/out --quiet",
                             drawn.data().string())),
      1, "/dev/null");
}

TEST(Reproduce, TheOutputMayNotReplaceTheData) {
  const DrawnData drawn;
  const std::size_t files = Entries(drawn.data()).size();
  for (const char* inside : {"", "/", "/sbi", "/sbi/IBMtest2", "/new", "/.."}) {
    const std::string out = drawn.data().string() + inside;
    ExpectOneLine(
        RunProgram(fmt::format("reproduce fig9 --quick --data '{}' -o '{}' --quiet --force",
                               drawn.data().string(), out)),
        1, "must not lie in each other");
  }
  EXPECT_EQ(Entries(drawn.data()).size(), files);
}

TEST(Reproduce, ABrokenSequenceLeavesNoReport) {
  const DrawnData drawn;
  fs::resize_file(drawn.sequence() / "input/in000060.png", 60);
  ExpectOneLine(drawn.Run(), 1, "in000060.png");
  EXPECT_EQ(Entries(drawn.out()), std::vector<std::string>{"reproduce.json"});
}

}  // namespace
}  // namespace vantage
