// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/tracks/track_file.h"

#include <gmock/gmock.h>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using testing::MessageOf;
using testing::TemporaryFolder;
using ::testing::HasSubstr;

class TrackFile : public ::testing::Test {
 protected:
  std::filesystem::path Write(const std::string& text) const {
    const auto path = folder_ / "tracks.csv";
    EXPECT_TRUE(WriteTextFile(path, text));
    return path;
  }
  std::string ErrorOf(const std::string& text) const { return MessageOf(ReadTracks(Write(text))); }
  TemporaryFolder folder_;
};

TEST_F(TrackFile, WrittenTracksComeBack) {
  const Tracks tracks = {
      {TrackId{1}, {{.frame = 3, .x_m = -1.25, .y_m = 2.5}, {.frame = 4, .x_m = -1, .y_m = 2.5}}},
      {TrackId{7}, {{.frame = 4, .x_m = 10.5, .y_m = 0, .inferred = true}}}};
  const auto path = folder_ / "out/tracks.csv";
  ASSERT_TRUE(WriteTracks(path, tracks, 10));
  EXPECT_EQ(ReadTracks(path).value(), tracks);
  EXPECT_EQ(ReadTextFile(path).value(),
            "frame,id,x,y,time,inferred\n3,1,-1.2500,2.5000,0.3000,0\n"
            "4,1,-1.0000,2.5000,0.4000,0\n4,7,10.5000,0.0000,0.4000,1\n");
}

TEST_F(TrackFile, UnknownColumnsAndWindowsLineEndsAreFine) {
  const Tracks tracks = ReadTracks(Write("frame,id,x,y,team\r\n0,2,1.5,2,red\r\n")).value();
  EXPECT_EQ(tracks, (Tracks{{TrackId{2}, {{.frame = 0, .x_m = 1.5, .y_m = 2}}}}));
}

TEST_F(TrackFile, MotChallengeFramesBecomeOurs) {
  const Tracks tracks =
      ReadTracks(Write("1,9,499,158,31.03,75.17,1,-4.1554,-7.3591,0\n")).value();
  EXPECT_EQ(tracks, (Tracks{{TrackId{9}, {{.frame = 0, .x_m = -4.1554, .y_m = -7.3591}}}}));
}

TEST_F(TrackFile, AHeaderAloneIsAnEmptyResult) {
  EXPECT_EQ(ReadTracks(Write("frame,id,x,y\n")).value(), Tracks());
}

TEST_F(TrackFile, ErrorsNameFileLineAndRule) {
  EXPECT_THAT(ErrorOf("frame,id,x,y\n0,1,nan,2\n"), HasSubstr("tracks.csv:2: x is 'nan'"));
  EXPECT_THAT(ErrorOf("frame,id,x,y\n0,1,1\n"), HasSubstr(":2: has 3 fields"));
  EXPECT_THAT(ErrorOf("frame,id,x,y\n-1,1,1,2\n"), HasSubstr(":2: frame is -1"));
  EXPECT_THAT(ErrorOf("frame,id,x,y\n0.5,1,1,2\n"), HasSubstr(":2: frame is 0.5"));
  EXPECT_THAT(ErrorOf("frame,id,x,y\n0,1,1,2\n0,1,1,3\n"),
              HasSubstr(":3: id 1 has a second position in frame 0"));
  EXPECT_THAT(ErrorOf(""), HasSubstr("neither the header"));
  EXPECT_THAT(ErrorOf("hello\n"), HasSubstr("neither the header"));
  EXPECT_THAT(ErrorOf("1,1,0,0,5,5,1,-1,-1,-1\n"), HasSubstr("no positions on the ground"));
  EXPECT_THAT(ErrorOf("0,1,0,0,5,5,1,3,4,0\n"), HasSubstr(":1: frame is 0"));
  EXPECT_THAT(MessageOf(ReadTracks(folder_ / "absent.csv")), HasSubstr("no such file"));
}

TEST_F(TrackFile, BoxesAreReadAndMarkedOnesLeftOut) {
  const auto tracks =
      ReadBoxTracks(Write("1,1,399,182,121,229,1,-1,-1,-1\n2,1,400,182,121,229,0,-1,-1,-1\n"))
          .value();
  ASSERT_EQ(tracks.size(), 1U);
  ASSERT_EQ(tracks[0].points.size(), 1U);
  EXPECT_EQ(tracks[0].points[0].frame, 0);
  EXPECT_EQ(tracks[0].points[0].box.width, 121);
  EXPECT_THAT(MessageOf(ReadBoxTracks(Write("1,1,3,1,0,9\n"))), HasSubstr(":1: the box is 0 x 9"));
}

}  // namespace
}  // namespace vantage
