// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/pom_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

constexpr std::string_view kFormats =
    "INPUT_VIEW_FORMAT in/f%f-c%c.png\nRESULT_FORMAT out/p%f.dat\n";

Result<PomFile> Read(const std::string& text) {
  const TemporaryFolder folder;
  EXPECT_TRUE(WriteTextFile(folder / "x.pom", text));
  return ReadPomFile(folder / "x.pom");
}

/// The message after the folder's name, e.g. "x.pom:3: ...".
std::string Message(const std::string& text) {
  const std::string message = MessageOf(Read(text));
  return message.substr(std::min(message.find("x.pom"), message.size()));
}

TEST(PomFile, ReadsEveryKeyword) {
  const Result<PomFile> file = Read(
      "# comment\r\n"
      "ROOM 160 120 2 3\r\n"
      "\n"
      "RECTANGLE 0 0 1 2 3 4\n"
      "RECTANGLE 0 1 notvisible\n"
      "RECTANGLE\t1, 2, 0, 0, 159, 119\n"
      "INPUT_VIEW_FORMAT \"a folder/f%f-c%c.png\"\n"
      "RESULT_VIEW_FORMAT out/r%f-%c.png\n"
      "RESULT_FORMAT /abs/p%f.dat\n"
      "CONVERGENCE_VIEW_FORMAT out/%f-%c-%i.png\n"
      "PRIOR 0.02\nSIGMA_IMAGE_DENSITY 0.003\nSMOOTHING_COEFFICIENT 0.7\n"
      "MAX_NB_SOLVER_ITERATIONS 50\nERROR_MAX 1e-5\nNB_STABLE_ERROR_FOR_CONVERGENCE 3\n"
      "PROBA_IGNORED 0.99\n"
      "PROCESS 160 30\nPROCESS 7 1");
  ASSERT_EQ(MessageOf(file), "");
  EXPECT_THAT(file->camera_numbers, ElementsAre(0, 1));
  ASSERT_EQ(file->views.size(), 2U);
  EXPECT_EQ(file->views[0].mask_size, (ImageSize{160, 120}));
  // Corners are inclusive; cells without a line are not visible.
  EXPECT_THAT(file->views[0].rectangles, ElementsAre(cv::Rect(1, 2, 3, 3), cv::Rect(), cv::Rect()));
  EXPECT_EQ(file->views[1].rectangles[2], cv::Rect(0, 0, 160, 120));
  EXPECT_EQ(file->options.prior, 0.02);
  EXPECT_EQ(file->options.variance, 0.003);
  EXPECT_EQ(file->options.smoothing, 0.7);
  EXPECT_EQ(file->options.max_iterations, 50);
  EXPECT_EQ(file->options.tolerance, 1e-5);
  EXPECT_EQ(file->options.stable_iterations, 3);
  EXPECT_EQ(file->options.ignored, 0.99);
  ASSERT_EQ(file->frames.size(), 2U);
  EXPECT_EQ(file->frames[0].first, 160);
  EXPECT_EQ(file->frames[0].count, 30);
  EXPECT_EQ(file->frames[1].first, 7);
  EXPECT_EQ(file->InputPath(1, 163), file->path.parent_path() / "a folder/f163-c1.png");
  EXPECT_EQ(file->ResultPath(163, {}), "/abs/p163.dat");
  EXPECT_EQ(file->ResultPath(163, "here"), "here/abs/p163.dat");
}

TEST(PomFile, ReadsTheLaterFormWithASizeForEachCamera) {
  const Result<PomFile> file =
      Read("ROOM -1 -1 2 1\nCAMERA 7 100 50\nCAMERA 3 20 10\n" + std::string(kFormats) +
           "RECTANGLE 3 0 0 0 19 9\nPROCESS 0 1\n");
  ASSERT_EQ(MessageOf(file), "");
  EXPECT_THAT(file->camera_numbers, ElementsAre(7, 3));
  EXPECT_EQ(file->views[0].size, (ImageSize{100, 50}));
  EXPECT_EQ(file->views[1].rectangles[0], cv::Rect(0, 0, 20, 10));
  EXPECT_THAT(file->InputPath(0, 5).string(), EndsWith("in/f5-c7.png"));
}

TEST(PomFile, ErrorsNameFileAndLine) {
  const std::string room = "ROOM 160 120 2 3\n";
  EXPECT_EQ(Message(room + "COLOUR red\n"), "x.pom:2: unknown keyword 'COLOUR'");
  EXPECT_EQ(Message("ROOM 160 120 2\n"), "x.pom:1: ROOM has 3 values; it needs 4");
  EXPECT_THAT(Message("ROOM 160 1e9 2 3\n"), HasSubstr("x.pom:1: the height of ROOM is '1e9'"));
  EXPECT_THAT(Message("ROOM 0 120 2 3\n"), HasSubstr("must be between 1 and 32768"));
  EXPECT_THAT(Message("ROOM 160 120 2 99999999999999999999\n"), HasSubstr("whole number"));
  EXPECT_THAT(Message("ROOM 160 120 1000 4000000\n"), HasSubstr("more than 20000000 rectangles"));
  EXPECT_EQ(Message(room + room), "x.pom:2: ROOM is given a second time");
  EXPECT_EQ(Message("RECTANGLE 0 0 notvisible\n"), "x.pom:1: RECTANGLE comes before ROOM");
  EXPECT_EQ(Message(room + "RECTANGLE 2 0 notvisible\n"), "x.pom:2: there is no camera 2");
  EXPECT_THAT(Message(room + "RECTANGLE 0 3 notvisible\n"), HasSubstr("between 0 and 2"));
  EXPECT_THAT(Message(room + "RECTANGLE 0 0 0 0 160 119\n"),
              HasSubstr("xmax of RECTANGLE is 160; it must be between 0 and 159"));
  EXPECT_THAT(Message(room + "RECTANGLE 0 0 9 0 8 119\n"), HasSubstr("between 9 and 159"));
  EXPECT_THAT(Message(room + "RECTANGLE 0 0 1 2 3\n"), HasSubstr("5 values; it needs 6"));
  EXPECT_THAT(Message(room + "CAMERA 0 1 1\n"), HasSubstr("needs ROOM -1 -1"));
  EXPECT_THAT(Message("ROOM -1 -1 1 1\nCAMERA 4 9 9\nCAMERA 5 9 9\n"), HasSubstr("1 cameras only"));
  EXPECT_THAT(Message("ROOM -1 -1 2 1\nCAMERA 4 9 9\nCAMERA 4 9 9\n"), HasSubstr("second time"));
  EXPECT_THAT(Message(room + "PRIOR nan\n"), HasSubstr("x.pom:2: PRIOR: occupancy.prior is nan"));
  EXPECT_THAT(Message(room + "PRIOR 1.5\n"), HasSubstr("above 0 and below 1"));
  EXPECT_THAT(Message(room + "MAX_NB_SOLVER_ITERATIONS 2.5\n"), HasSubstr("a whole number"));
  EXPECT_THAT(Message(room + "RESULT_FORMAT p%d.dat\n"), HasSubstr("x.pom:2: RESULT_FORMAT"));
  EXPECT_THAT(Message(room + "RESULT_FORMAT 100%\n"), HasSubstr("'%'"));
  EXPECT_THAT(Message(room + std::string(kFormats) + "PROCESS 0 1\nPRIOR 0.1\n"),
              HasSubstr("x.pom:5: PRIOR comes after PROCESS"));
  EXPECT_THAT(Message(room + "PROCESS 0 99999999\n"), HasSubstr("between 1 and 10000000"));
}

TEST(PomFile, IncompleteFilesAreRefused) {
  const std::string room = "ROOM 160 120 2 3\n";
  EXPECT_THAT(Message(""), HasSubstr("no ROOM line"));
  EXPECT_THAT(Message(room), HasSubstr("no INPUT_VIEW_FORMAT"));
  EXPECT_THAT(Message(room + "INPUT_VIEW_FORMAT a\n"), HasSubstr("no RESULT_FORMAT"));
  EXPECT_THAT(Message(room + std::string(kFormats)), HasSubstr("no PROCESS"));
  EXPECT_THAT(Message("ROOM -1 -1 2 3\nCAMERA 0 9 9\n"), HasSubstr("1 have a CAMERA line"));
  EXPECT_THAT(Message(room + "INPUT_VIEW_FORMAT a\nRESULT_FORMAT b\nPROCESS 0 2\n"),
              HasSubstr("overwrite"));
  EXPECT_THAT(MessageOf(ReadPomFile("/nowhere/x.pom")), HasSubstr("/nowhere/x.pom: no such file"));
}

}  // namespace
}  // namespace vantage
