// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/ksp_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <map>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

constexpr int kColumns = 6;
constexpr int kRows = 5;
constexpr const char* kConfiguration =
    "# a sample\n"
    "GRID 6 5\nFRAMES 10 15\nACCESS_POINTS 0,29\nDEPTH 1\nMAX_TRAJ 255\nINPUT_FORMAT p/%03d.dat\n";

/// (frame, cell) -> probability as it stands in the file; all others are 0.01, 4.59512 each.
using Sample = std::map<std::pair<int, int>, const char*>;

Sample SmallSample() {
  return {
      // One is there from the first frame to the last: 6 times -log(9999) = -9.21024, -55.26144.
      {{10, 7}, "0.9999"},
      {{11, 8}, "0.9999"},
      {{12, 9}, "0.9999"},
      {{13, 15}, "0.9999"},
      {{14, 15}, "0.9999"},
      {{15, 22}, "0.9999"},
      // One enters at cell 29 and is all but missed in cell 27: 4 times -13.81551, the clip, and
      // 3.89182, together -51.37022.
      {{11, 29}, "1"},
      {{12, 28}, "1.0"},
      {{13, 27}, "2e-2"},
      {{14, 26}, "1"},
      {{15, 26}, "1"},
      // One shows for three frames at the access point 0 and earns 41.44653: less than 45.
      {{12, 0}, "1"},
      {{13, 0}, "1"},
      {{14, 0}, "1"},
  };
}

void WriteSample(const TemporaryFolder& folder, const Sample& sample,
                 const std::string& configuration = kConfiguration) {
  ASSERT_TRUE(WriteTextFile(folder / "x.ksp", configuration));
  for (int frame = 10; frame <= 15; ++frame) {
    std::string text;
    for (int cell = 0; cell < kColumns * kRows; ++cell) {
      const auto found = sample.find({frame, cell});
      text += fmt::format("{} {}\n", cell, found == sample.end() ? "0.01" : found->second);
    }
    ASSERT_TRUE(WriteTextFile(folder.path() / "p" / fmt::format("{:03}.dat", frame), text));
  }
}

Result<KspReport> Link(const TemporaryFolder& folder, const RunControl& control = {}) {
  VANTAGE_ASSIGN_OR_RETURN(const KspFile file, ReadKspFile(folder / "x.ksp"));
  return RunKsp(file, folder / "out.dat", control);
}

TEST(RunKsp, FindsThePathsOfTheSample) {
  const TemporaryFolder folder;
  WriteSample(folder, SmallSample());
  const auto report = Link(folder);
  ASSERT_EQ(MessageOf(report), "");
  EXPECT_EQ(report->frames, 6);
  EXPECT_EQ(report->cells, 30);
  EXPECT_EQ(report->paths, 2);
  EXPECT_NEAR(report->cost, -55.26144 - 51.37022, 1e-3);  // float32 has 0.9999 a little off
  EXPECT_EQ(ReadTextFile(folder / "out.dat").value(),
            "2\n"
            "10\t7\t-1\t\n"
            "11\t8\t29\t\n"
            "12\t9\t28\t\n"
            "13\t15\t27\t\n"
            "14\t15\t26\t\n"
            "15\t22\t26\t\n");
}

TEST(RunKsp, APathMustEarnMoreThan45) {
  const TemporaryFolder folder;
  Sample sample = SmallSample();
  sample[{15, 0}] = "0.97";  // 3.47610 more: 44.92263
  WriteSample(folder, sample);
  EXPECT_EQ(Link(folder)->paths, 2);
  sample[{15, 0}] = "0.98";  // 3.89182 more: 45.33835
  WriteSample(folder, sample);
  const auto report = Link(folder);
  EXPECT_EQ(report->paths, 3);
  EXPECT_NEAR(report->cost, -55.26144 - 51.37022 - 45.33835, 1e-3);
}

TEST(RunKsp, KeepsTheBestOfTooManyPaths) {
  const TemporaryFolder folder;
  WriteSample(folder, SmallSample(),
              "GRID 6 5\nFRAMES 10 15\nACCESS_POINTS 0,29\nMAX_TRAJ 1\nINPUT_FORMAT p/%03d.dat\n");
  const auto report = Link(folder);
  EXPECT_EQ(report->paths, 1);
  EXPECT_NEAR(report->cost, -55.26144, 1e-3);
  EXPECT_THAT(ReadTextFile(folder / "out.dat").value(), HasSubstr("1\n10\t7\t\n11\t8\t\n"));
}

TEST(RunKsp, WithoutAccessPointsPathsLastFromTheFirstFrameToTheLast) {
  const TemporaryFolder folder;
  WriteSample(folder, SmallSample(), "GRID 6 5\nFRAMES 10 15\nINPUT_FORMAT p/%03d.dat\n");
  const auto report = Link(folder);
  EXPECT_EQ(report->paths, 2);
  EXPECT_NEAR(report->cost, -55.26144 - 51.37022 + 4.59512, 1e-3);
}

TEST(RunKsp, OrderOfLinesCountsAndTheColumnOfCellsDoesNot) {
  const TemporaryFolder folder;
  WriteSample(folder, SmallSample());
  std::string text;
  for (int cell = 0; cell < kColumns * kRows; ++cell) {
    text += fmt::format("  {}\t{} \r\n\n", -7 * cell, cell == 7 ? "0.9999" : "1e-2");
  }
  ASSERT_TRUE(WriteTextFile(folder.path() / "p" / "010.dat", text));
  const auto report = Link(folder);
  ASSERT_EQ(MessageOf(report), "");
  EXPECT_NEAR(report->cost, -55.26144 - 51.37022, 1e-3);
}

TEST(RunKsp, LeavesNothingWhenAFrameIsWrong) {
  const TemporaryFolder folder;
  WriteSample(folder, SmallSample());
  const auto frame = folder.path() / "p" / "012.dat";
  const std::string good = ReadTextFile(frame).value();
  const auto expect = [&](const std::string& text, const std::string& part) {
    ASSERT_TRUE(WriteTextFile(frame, text));
    const std::string message = MessageOf(Link(folder));
    EXPECT_THAT(message, HasSubstr("012.dat" + part));
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.dat"));
  };
  const auto line = [&](const std::string& second) {
    return "0 0.5\n" + second + good.substr(std::string("0 1\n1 0.01\n").size());
  };
  expect("", ": has 0 lines; it needs one for each of the 30 cells");
  expect("0 0.5\n1 0.5\n", ": has 2 lines");
  expect(good + "30 0.01\n", ":31: more lines than the 30 cells");
  expect(line("1 nan\n"), ":2: the probability is 'nan'");
  expect(line("1 -0.1\n"), ":2: the probability is '-0.1'");
  expect(line("1 1.01\n"), ":2: the probability is '1.01'");
  expect(line("1 1e999\n"), ":2: the probability is '1e999'");
  expect(line("1 inf\n"), ":2: the probability is 'inf'");
  expect(line("1 0,5\n"), ":2: the probability is '0,5'");
  expect(line("1\n"), ":2: must have the number of a cell and its probability");
  expect(line("1 0.5 0.5\n"), ":2: must have");
  expect(line("one 0.5\n"), ":2: must have");
  expect(line("99999999999999999999 0.5\n"), ":2: must have");
  std::filesystem::remove(frame);
  EXPECT_THAT(MessageOf(Link(folder)), HasSubstr("012.dat"));
  std::filesystem::create_directory(frame);
  EXPECT_THAT(MessageOf(Link(folder)), HasSubstr("012.dat"));
}

TEST(RunKsp, EndsWhenStopped) {
  const TemporaryFolder folder;
  WriteSample(folder, SmallSample());
  const std::atomic<bool> stop = true;
  RunControl control;
  control.stop = &stop;
  EXPECT_THAT(MessageOf(Link(folder, control)), HasSubstr("interrupted"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out.dat"));
}

}  // namespace
}  // namespace vantage
