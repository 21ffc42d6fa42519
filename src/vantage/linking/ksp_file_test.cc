// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/ksp_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::MessageOf;
using ::testing::StartsWith;
using testing::TemporaryFolder;

Result<KspFile> Read(const std::string& text) {
  const TemporaryFolder folder;
  EXPECT_TRUE(WriteTextFile(folder / "x.ksp", text));
  return ReadKspFile(folder / "x.ksp");
}

/// The message after the folder's name, e.g. "x.ksp:3: ...".
std::string Message(const std::string& text) {
  const std::string message = MessageOf(Read(text));
  EXPECT_EQ(message.find('\n'), std::string::npos);
  return message.substr(std::min(message.find("x.ksp"), message.size()));
}

TEST(KspFile, ReadsEveryKeyword) {
  const auto file = Read(
      "# comment\r\n\n#GRID 1 1\r\n"
      "ACCESS_POINTS 3,5,19\r\n"
      "  GRID\t5 4\r\n"
      "FRAMES 12 90\nDEPTH 3\nMAX_TRAJ 1000\n"
      "ACCESS_POINTS 0, 1\n"
      "INPUT_FORMAT maps/100%%-%05d.dat");
  ASSERT_EQ(MessageOf(file), "");
  EXPECT_EQ(file->columns, 5);
  EXPECT_EQ(file->rows, 4);
  EXPECT_EQ(file->cell_count(), 20);
  EXPECT_EQ(file->first_frame, 12);
  EXPECT_EQ(file->last_frame, 90);
  EXPECT_EQ(file->frame_count(), 79);
  EXPECT_THAT(file->access_points, ElementsAre(3, 5, 19, 0, 1));
  EXPECT_EQ(file->depth, 3);
  EXPECT_EQ(file->max_paths, 1000);
  EXPECT_EQ(file->InputPath(7), file->path.parent_path() / "maps/100%-00007.dat");
  EXPECT_EQ(file->InputPath(1234567), file->path.parent_path() / "maps/100%-1234567.dat");
}

TEST(KspFile, LeavesOutWhatHasADefault) {
  const auto file = Read("GRID 1 1\nFRAMES 0 0\nINPUT_FORMAT /a/%d.dat\n");
  ASSERT_EQ(MessageOf(file), "");
  EXPECT_THAT(file->access_points, IsEmpty());
  EXPECT_EQ(file->depth, 1);
  EXPECT_EQ(file->max_paths, 255);
  EXPECT_EQ(file->InputPath(42), "/a/42.dat");
}

TEST(KspFile, NamesTheLineOfAnError) {
  const std::string good = "GRID 5 4\nFRAMES 0 9\nINPUT_FORMAT %d\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "x.ksp: no GRID line"},
      {"# GRID 5 4\n", "x.ksp: no GRID line"},
      {"GRID 5 4\nINPUT_FORMAT %d\n", "x.ksp: no FRAMES line"},
      {"GRID 5 4\nFRAMES 0 9\n", "x.ksp: no INPUT_FORMAT line"},
      {good + "GRID 5 4\n", "x.ksp:4: GRID is given a second time"},
      {good + "grid 5 4\n", "x.ksp:4: unknown keyword 'grid'"},
      {good + "DEPTH\n", "x.ksp:4: DEPTH has 0 values; it needs 1"},
      {good + "DEPTH -1\n",
       "x.ksp:4: the depth of DEPTH is '-1'; it must be a whole number from 0"},
      {good + "DEPTH 11\n", "x.ksp:4: the depth of DEPTH is '11'"},
      {good + "DEPTH 1.5\n", "x.ksp:4: the depth of DEPTH is '1.5'"},
      {good + "DEPTH nan\n", "x.ksp:4: the depth of DEPTH is 'nan'"},
      {good + "MAX_TRAJ 0\n", "x.ksp:4: the number of paths of MAX_TRAJ is '0'"},
      {good + "MAX_TRAJ 99999999999999999999\n", "x.ksp:4: the number of paths of MAX_TRAJ is"},
      {good + "ACCESS_POINTS\n", "x.ksp:4: ACCESS_POINTS names no cell"},
      {good + "ACCESS_POINTS ,\n", "x.ksp:4: ACCESS_POINTS names no cell"},
      {good + "ACCESS_POINTS 1,x\n", "x.ksp:4: a cell of ACCESS_POINTS is 'x'"},
      {good + "ACCESS_POINTS 19\nACCESS_POINTS 20,3\n", "x.ksp:5: cell 20 of ACCESS_POINTS"},
      {good + "ACCESS_POINTS -1\n", "x.ksp:4: a cell of ACCESS_POINTS is '-1'"},
      {"GRID 5\n", "x.ksp:1: GRID has 1 values; it needs 2"},
      {"GRID 0 4\n", "x.ksp:1: the width of GRID is '0'"},
      {"GRID 5 99999999999\n", "x.ksp:1: the height of GRID is '99999999999'"},
      {"FRAMES 9 8\n",
       "x.ksp:1: the last frame of FRAMES is '8'; it must be a whole number from 9"},
      {"FRAMES -3 8\n", "x.ksp:1: the first frame of FRAMES is '-3'"},
      {"GRID 32768 32768\nFRAMES 0 0\nINPUT_FORMAT %d\n", "x.ksp: 1 frames of 32768 x 32768 cells"},
      {"GRID 5 4\nFRAMES 0 1000000000\nINPUT_FORMAT %d\n", "x.ksp: 1000000001 frames of"},
      {"INPUT_FORMAT a b%d\n", "x.ksp:1: INPUT_FORMAT has 2 values; it needs 1"},
      {"INPUT_FORMAT maps.dat\n", "x.ksp:1: INPUT_FORMAT has 0 fields %d; it needs one"},
      {"INPUT_FORMAT %d/%d.dat\n", "x.ksp:1: INPUT_FORMAT has 2 fields"},
      {"INPUT_FORMAT %s.dat\n", "x.ksp:1: INPUT_FORMAT has a '%'"},
      {"INPUT_FORMAT %d%n\n", "x.ksp:1: INPUT_FORMAT has a '%'"},
      {"INPUT_FORMAT %*d\n", "x.ksp:1: INPUT_FORMAT has a '%'"},
      {"INPUT_FORMAT %99999999999d\n", "x.ksp:1: INPUT_FORMAT has a '%'"},
      {"INPUT_FORMAT %d%\n", "x.ksp:1: INPUT_FORMAT has a '%'"},
  };
  for (const auto& [text, message] : cases) EXPECT_THAT(Message(text), StartsWith(message)) << text;
}

TEST(KspFile, NamesAFileThatIsNone) {
  EXPECT_THAT(MessageOf(ReadKspFile("/none/x.ksp")), StartsWith("/none/x.ksp"));
  EXPECT_THAT(MessageOf(ReadKspFile("/")), StartsWith("/"));
}

}  // namespace
}  // namespace vantage
