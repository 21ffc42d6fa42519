// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/pom_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::DataFolder;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

std::vector<double> ReadProbabilities(const fs::path& path) {
  std::ifstream stream(path);
  std::vector<double> values;
  std::size_t cell = 0;
  double value = 0;
  while (stream >> cell >> value) {
    EXPECT_EQ(cell, values.size());
    values.push_back(value);
  }
  return values;
}

/// Two cameras, three cells, one person at cell 1 in frames 4 to 6.
void WriteSmallProblem(const fs::path& folder) {
  const cv::Rect person[2] = {{10, 5, 8, 16}, {20, 4, 6, 12}};
  fs::create_directories(folder / "in");
  for (int f = 4; f <= 6; ++f) {
    for (int c = 0; c < 2; ++c) {
      cv::Mat mask = cv::Mat::zeros(30, 40, CV_8UC1);
      mask(person[c]) = 255;
      cv::imwrite(folder / fmt::format("in/f{}-c{}.png", f, c), mask);
    }
  }
  std::ofstream(folder / "x.pom") << "ROOM 40 30 2 3\n"
                                     "RECTANGLE 0 0 0 5 7 20\nRECTANGLE 0 1 10 5 17 20\n"
                                     "RECTANGLE 0 2 25 5 32 20\nRECTANGLE 1 0 2 4 7 15\n"
                                     "RECTANGLE 1 1 20 4 25 15\n"
                                     "INPUT_VIEW_FORMAT in/f%f-c%c.png\n"
                                     "RESULT_FORMAT out/p%f.dat\nPROCESS 4 3\n";
}

TEST(RunPom, WritesOneResultAFrame) {
  const TemporaryFolder folder;
  WriteSmallProblem(folder.path());
  const PomFile file = *ReadPomFile(folder / "x.pom");
  for (const int threads : {1, 3}) {
    std::int64_t done = 0;
    RunControl control;
    control.progress = [&](std::int64_t now, std::int64_t total) {
      EXPECT_GT(now, done);
      EXPECT_EQ(total, 3);
      done = now;
    };
    const auto report = RunPom(file, {}, threads, control);
    ASSERT_EQ(MessageOf(report), "");
    EXPECT_EQ(report->frames, 3);
    EXPECT_EQ(report->not_converged, 0);
    EXPECT_GE(report->iterations, 3 * 5);
    EXPECT_EQ(done, 3);
    for (int f = 4; f <= 6; ++f) {
      const auto q = ReadProbabilities(folder / fmt::format("out/p{}.dat", f));
      ASSERT_EQ(q.size(), 3U);
      EXPECT_LT(q[0], 0.02);
      EXPECT_GT(q[1], 0.99);
      EXPECT_LT(q[2], 0.02);
    }
  }
}

TEST(RunPom, FailuresNameTheFileAndLeaveNothing) {
  const TemporaryFolder folder;
  WriteSmallProblem(folder.path());
  const PomFile file = *ReadPomFile(folder / "x.pom");
  const auto message = [&] { return MessageOf(RunPom(file, folder / "results", 2, {})); };

  fs::remove(folder / "in/f6-c1.png");
  EXPECT_THAT(message(), HasSubstr("f6-c1.png: no such file"));
  cv::imwrite(folder / "in/f6-c1.png", cv::Mat::zeros(40, 30, CV_8UC1));
  EXPECT_THAT(message(),
              AllOf(HasSubstr("f6-c1.png"), HasSubstr("30 x 40 px"), HasSubstr("says 40 x 30")));
  ASSERT_TRUE(WriteTextFile(folder / "in/f6-c1.png", "not a picture"));
  EXPECT_THAT(message(), HasSubstr("f6-c1.png"));
  EXPECT_FALSE(fs::exists(folder / "results"));

  WriteSmallProblem(folder.path());
  ASSERT_TRUE(WriteTextFile(folder / "results", "in the way"));
  EXPECT_THAT(message(), HasSubstr("results"));

  std::atomic<bool> stop = true;
  RunControl control;
  control.stop = &stop;
  EXPECT_THAT(MessageOf(RunPom(file, folder / "other", 1, control)), HasSubstr("interrupted"));
  EXPECT_FALSE(fs::exists(folder / "other"));
}

/// Runs a configuration and compares every cell of its 30 frames with the authors' answers.
void ExpectTheAuthorsAnswers(const fs::path& configuration) {
  const TemporaryFolder folder;
  const Result<PomFile> file = ReadPomFile(configuration);
  ASSERT_EQ(MessageOf(file), "");
  ASSERT_EQ(MessageOf(RunPom(*file, folder.path(), 2, {})), "");
  double largest = 0;
  for (int frame = 160; frame < 190; ++frame) {
    const std::string name = fmt::format("proba-f{}.dat", frame);
    const auto expected = ReadProbabilities(DataFolder() / "pom/expected" / name);
    const auto q = ReadProbabilities(folder / ("out/" + name));
    ASSERT_EQ(expected.size(), 1332U);
    ASSERT_EQ(q.size(), expected.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      ASSERT_NEAR(q[i], expected[i], 1e-3) << "frame " << frame << ", cell " << i;
      largest = std::max(largest, std::abs(q[i] - expected[i]));
    }
  }
  ::testing::Test::RecordProperty("largest_difference", fmt::format("{}", largest));
}

TEST(RunPom, AgreesWithTheAuthorsProgram) {
  if (DataFolder().empty()) GTEST_SKIP() << "research data is absent";
  ExpectTheAuthorsAnswers(DataFolder() / "pom/test.pom");
}

/// In the fast mode float and the cells that are left out show, but the detections are the same.
TEST(RunPom, FastModeFindsTheCellsOfTheAuthorsProgram) {
  if (DataFolder().empty()) GTEST_SKIP() << "research data is absent";
  const TemporaryFolder folder;
  PomFile file = *ReadPomFile(DataFolder() / "pom/test.pom");
  file.options.mode = SolveMode::kFast;
  ASSERT_EQ(MessageOf(RunPom(file, folder.path(), 2, {})), "");
  int found = 0;
  for (int frame = 160; frame < 190; ++frame) {
    const std::string name = fmt::format("proba-f{}.dat", frame);
    const auto expected = ReadProbabilities(DataFolder() / "pom/expected" / name);
    const auto q = ReadProbabilities(folder / ("out/" + name));
    ASSERT_EQ(q.size(), expected.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      EXPECT_EQ(q[i] > 0.5, expected[i] > 0.5) << "frame " << frame << ", cell " << i;
      found += q[i] > 0.5 ? 1 : 0;
    }
  }
  EXPECT_GT(found, 50);
}

/// The later form of the configuration, which gives every camera a number and a size of its own.
TEST(RunPom, AgreesWithTheAuthorsProgramWhenCamerasHaveLines) {
  if (DataFolder().empty()) GTEST_SKIP() << "research data is absent";
  const TemporaryFolder folder;
  const fs::path data = fs::absolute(DataFolder() / "pom");
  // %c of the pictures' names is the camera's number.
  for (int frame = 160; frame < 190; ++frame) {
    for (int camera = 0; camera < 2; ++camera) {
      fs::create_symlink(data / fmt::format("images/view-f{}-c{}.png", frame, camera),
                         folder / fmt::format("view-f{}-c{}.png", frame, camera == 0 ? 4 : 2));
    }
  }
  std::string text = *ReadTextFile(data / "test.pom", 1 << 20);
  const auto replace = [&text](const std::string& from, const std::string& to) {
    std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    for (; at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
  };
  replace("RECTANGLE 1 ", "RECTANGLE 2 ");
  replace("RECTANGLE 0 ", "RECTANGLE 4 ");
  replace("ROOM 160 120 2 1332", "ROOM -1 -1 2 1332\nCAMERA 4 160 120\nCAMERA 2 160 120");
  replace("images/view", (folder / "view").string());
  ASSERT_TRUE(WriteTextFile(folder / "test.pom", text));
  ExpectTheAuthorsAnswers(folder / "test.pom");
}

}  // namespace
}  // namespace vantage
