// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// `vantage reproduce`, as a user runs it.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "test_program.h"
#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/experiments/test_ghost_sequence.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
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
    return RunProgram(fmt::format("reproduce ghosts --data '{}' -o '{}' --quiet {}",
                                  data().string(), out().string(), more));
  }
};

const std::vector<std::string> kFiles = {"ghosts.csv", "ghosts.html", "ghosts.json",
                                         "ghosts_frames.csv"};

TEST(ReproduceGhosts, WritesThePageFromWhatIsThere) {
  const DrawnData drawn;
  const Outcome outcome = drawn.Run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("CaVignal: "));
  EXPECT_THAT(outcome.out, HasSubstr("is not there"));
  EXPECT_THAT(outcome.out, HasSubstr("ghosts.html"));
  EXPECT_EQ(Entries(drawn.out()), kFiles);
  const std::string csv = ReadTextFile(drawn.out() / "ghosts.csv").value();
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 61);
  EXPECT_THAT(ReadTextFile(drawn.out() / "ghosts.html").value(), HasSubstr("IBMtest2"));
}

TEST(ReproduceGhosts, PrintsJson) {
  const DrawnData drawn;
  const Outcome outcome = drawn.Run("--json --threads 1");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["sequences"].size(), 1u);
  EXPECT_EQ(json["skipped"].size(), 4u);
}

TEST(ReproduceGhosts, WrongUsage) {
  const DrawnData drawn;
  ExpectOneLine(RunProgram("reproduce"), 2, "subcommand");
  ExpectOneLine(RunProgram("reproduce table9 -o out"), 2, "");
  ExpectOneLine(RunProgram("reproduce ghosts -o out"), 2, "--data is required");
  ExpectOneLine(RunProgram(fmt::format("reproduce ghosts --data '{}'", drawn.data().string())), 2,
                "--output is required");
  EXPECT_EQ(RunProgram("reproduce ghosts --help").status, 0);
}

TEST(ReproduceGhosts, MissingData) {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& data) {
    return RunProgram(fmt::format("reproduce ghosts --data '{0}/{1}' -o '{0}/out' --quiet",
                                  folder.path().string(), data));
  };
  ExpectOneLine(run("none"), 1, "none: no such folder");
  ExpectOneLine(run(""), 1, "holds none of the sequences cdnet/office");
  std::ofstream(folder / "file").flush();
  ExpectOneLine(run("file"), 1, "file: no such folder");
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(ReproduceGhosts, AnOutputThatHoldsSomething) {
  const DrawnData drawn;
  fs::create_directories(drawn.out());
  std::ofstream(drawn.out() / "mine.txt") << "mine";
  ExpectOneLine(drawn.Run(), 1, "already holds files");
  EXPECT_EQ(Entries(drawn.out()), std::vector<std::string>{"mine.txt"});
  EXPECT_EQ(drawn.Run("--force").status, 0);
  EXPECT_EQ(Entries(drawn.out()), kFiles);
  ExpectOneLine(RunProgram(fmt::format("reproduce ghosts --data '{}' -o /dev/null/out --quiet",
                                       drawn.data().string())),
                1, "/dev/null");
}

TEST(ReproduceGhosts, TheOutputMayNotReplaceTheData) {
  const DrawnData drawn;
  const std::size_t files = Entries(drawn.data()).size();
  for (const char* inside : {"", "/", "/sbi", "/sbi/IBMtest2"}) {
    const std::string out = drawn.data().string() + inside;
    ExpectOneLine(RunProgram(fmt::format("reproduce ghosts --data '{}' -o '{}' --quiet --force",
                                         drawn.data().string(), out)),
                  1, "would replace the data");
  }
  EXPECT_EQ(Entries(drawn.data()).size(), files);
}

TEST(ReproduceGhosts, ABrokenSequenceLeavesNothing) {
  const DrawnData drawn;
  fs::resize_file(drawn.sequence() / "input/in000060.png", 60);
  ExpectOneLine(drawn.Run(), 1, "in000060.png");
  EXPECT_FALSE(fs::exists(drawn.out()));
  EXPECT_EQ(Entries(drawn.folder.path()).size(), Entries(drawn.data()).size());
}

}  // namespace
}  // namespace vantage
