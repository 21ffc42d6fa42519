// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/tracks/track_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;

class TrackFile : public ::testing::Test {
 protected:
  Result<Tracks> Read(const std::string& text) {
    EXPECT_TRUE(WriteTextFile(path_, text));
    return ReadTracks(path_);
  }
  Result<BoxTracks> ReadBoxes(const std::string& text) {
    EXPECT_TRUE(WriteTextFile(path_, text));
    return ReadBoxTracks(path_);
  }
  std::string ErrorOf(const std::string& text) { return testing::MessageOf(Read(text)); }

  testing::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "tracks.csv";
};

TEST_F(TrackFile, WhatIsWrittenIsRead) {
  const Tracks tracks = {
      {.id = TrackId{1}, .points = {{0, 1.25, -2.5, false}, {1, 1.5, -2.0, true}}},
      {.id = TrackId{7}, .points = {{1, 100.0001, 0, false}}},
  };
  ASSERT_TRUE(WriteTracks(path_, tracks, 10));
  const Result<std::string> text = ReadTextFile(path_);
  EXPECT_EQ(*text,
            "frame,id,x,y,time,inferred\n"
            "0,1,1.2500,-2.5000,0.000,0\n"
            "1,1,1.5000,-2.0000,0.100,1\n"
            "1,7,100.0001,0.0000,0.100,0\n");
  const Result<Tracks> again = ReadTracks(path_);
  ASSERT_TRUE(again) << testing::MessageOf(again);
  EXPECT_EQ(*again, tracks);
}

TEST_F(TrackFile, NoTracksAreAFileToo) {
  ASSERT_TRUE(WriteTracks(path_, {}, 7));
  const Result<Tracks> again = ReadTracks(path_);
  ASSERT_TRUE(again) << testing::MessageOf(again);
  EXPECT_THAT(*again, IsEmpty());
}

TEST_F(TrackFile, CsvColumnsGoByName) {
  const Result<Tracks> tracks =
      Read("id, team, y ,x,frame\r\n3.0,red,2,1,9\r\n\r\n3,red,2,4,8\r\n");
  ASSERT_TRUE(tracks) << testing::MessageOf(tracks);
  EXPECT_THAT(*tracks, ElementsAre(Track{TrackId{3}, {{8, 4, 2, false}, {9, 1, 2, false}}}));
}

TEST_F(TrackFile, MotChallengeFramesAreLoweredByOne) {
  const Result<Tracks> tracks = Read(
      "1,9,499,158,31.03,75.17,1,-4.1554,-7.3591,0\n"
      "3,9,495,159,31.03,75.17,1,-4.2787,-7.314,0\n");
  ASSERT_TRUE(tracks) << testing::MessageOf(tracks);
  EXPECT_THAT(
      *tracks,
      ElementsAre(Track{TrackId{9}, {{0, -4.1554, -7.3591, false}, {2, -4.2787, -7.314, false}}}));
}

TEST_F(TrackFile, BoxesOfMotChallenge) {
  const Result<BoxTracks> boxes = ReadBoxes(
      "1,3,113.84,274.5,57.307,130.05,-1,-1,-1,-1\n"
      "2,3,113.84,274.5,57.307,130.05,0,-1,-1,-1\n");
  ASSERT_TRUE(boxes) << testing::MessageOf(boxes);
  EXPECT_THAT(*boxes, ElementsAre(BoxTrack{TrackId{3}, {{0, 113.84, 274.5, 57.307, 130.05}}}));
  EXPECT_THAT(testing::MessageOf(ReadBoxes("1,3,1,2,0,4,1,-1,-1,-1\n")),
              HasSubstr(":1: the box is 0 x 4 pixels"));
  EXPECT_THAT(testing::MessageOf(ReadBoxes("frame,id,x,y\n")), HasSubstr("header"));
}

TEST_F(TrackFile, ErrorsNameTheLine) {
  const std::string header = "frame,id,x,y\n";
  EXPECT_THAT(ErrorOf(header + "0,1,2,3\n0,1,2,3\n"),
              HasSubstr("tracks.csv:3: id 1 comes twice in this frame, first in line 2;"));
  EXPECT_THAT(ErrorOf(header + "\n-1,1,2,3\n"), HasSubstr(":3: frame is -1"));
  EXPECT_THAT(ErrorOf(header + "0,1,nan,3\n"), HasSubstr(":2: x is 'nan'"));
  EXPECT_THAT(ErrorOf(header + "0,1,2,inf\n"), HasSubstr(":2: y is 'inf'"));
  EXPECT_THAT(ErrorOf(header + "0,1,2\n"), HasSubstr(":2: has 3 columns; 'y' is column 4"));
  EXPECT_THAT(ErrorOf(header + "0,1,2,3m\n"), HasSubstr("y is '3m'; it must be a finite number"));
  EXPECT_THAT(ErrorOf(header + "0.5,1,2,3\n"), HasSubstr("it must be a whole number from 0"));
  EXPECT_THAT(ErrorOf(header + "99999999999,1,2,3\n"), HasSubstr("from 0 to 1000000000"));
  EXPECT_THAT(ErrorOf("frame,id,x,y,inferred\n0,1,2,3,2\n"),
              HasSubstr("inferred is 2; it must be a whole number from 0 to 1"));
  EXPECT_THAT(ErrorOf("frame,id,x\n0,1,2\n"), HasSubstr(":1: the header has no column 'y'"));
  EXPECT_THAT(ErrorOf("0,1,2,3,4,5,1,6,7,0\n"),
              HasSubstr(":1: frame is 0; it must be a whole number from 1"));
  EXPECT_THAT(ErrorOf("1,1,2,3,4,5,1,-1,-1,-1\n"), HasSubstr("columns 8 and 9"));
  EXPECT_THAT(ErrorOf("1,1,2,3,4,5,1\n"), HasSubstr("has 7 columns"));
  EXPECT_THAT(ErrorOf(""), HasSubstr("is empty"));
  EXPECT_THAT(ErrorOf(" \n\n"), HasSubstr("is empty"));
  EXPECT_THAT(testing::MessageOf(ReadTracks(folder_ / "none.csv")), HasSubstr("no such file"));
}

TEST_F(TrackFile, SaysInWhichLineAPositionStands) {
  ASSERT_TRUE(WriteTextFile(path_, "frame,id,x,y\n\n8,3,4,2\n7,3,4,2\n8,1,0,0\n"));
  TrackLines lines;
  ASSERT_TRUE(ReadTracks(path_, &lines));
  EXPECT_THAT(lines, ElementsAre(Pair(Pair(TrackId{1}, 8), 5), Pair(Pair(TrackId{3}, 7), 4),
                                 Pair(Pair(TrackId{3}, 8), 3)));
}

TEST_F(TrackFile, NothingIsWrittenOfTracksThatCannotBe) {
  const Tracks tracks = {
      {.id = TrackId{1}, .points = {{0, std::numeric_limits<double>::quiet_NaN(), 0, false}}}};
  EXPECT_THAT(testing::MessageOf(WriteTracks(path_, tracks, 10)), HasSubstr("must be finite"));
  EXPECT_THAT(testing::MessageOf(WriteTracks(path_, {}, 0)), HasSubstr("above 0"));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(TrackFile, WritesPositionsOneByOne) {
  const std::filesystem::path whole = folder_ / "whole.csv";
  const Tracks tracks = {
      {.id = TrackId{1}, .points = {{0, 1.25, -2.5, false}, {1, 1.5, -2.0, true}}},
      {.id = TrackId{7}, .points = {{1, 100.0001, 0, false}, {5, 1, 1, false}}},
  };
  ASSERT_TRUE(WriteTracks(whole, tracks, 10));
  {
    auto writer = TrackWriter::Create(path_, 10);
    ASSERT_TRUE(writer) << testing::MessageOf(writer);
    EXPECT_TRUE(writer->Write(TrackId{1}, tracks[0].points[0]));
    EXPECT_TRUE(writer->Write(TrackId{1}, tracks[0].points[1]));
    EXPECT_TRUE(writer->Write(TrackId{7}, tracks[1].points[0]));
    EXPECT_FALSE(std::filesystem::exists(path_)) << "not before it is whole";
    EXPECT_TRUE(writer->Write(TrackId{7}, tracks[1].points[1]));
    ASSERT_TRUE(writer->Commit());
  }
  EXPECT_EQ(*ReadTextFile(path_), *ReadTextFile(whole));
}

TEST_F(TrackFile, PositionsOutOfOrderAreRefusedAndLeaveNothing) {
  {
    auto writer = TrackWriter::Create(path_, 10);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->Write(TrackId{2}, {.frame = 3}));
    for (const auto& [id, frame] : {std::pair{2, 3}, {1, 3}, {9, 2}}) {
      EXPECT_THAT(testing::MessageOf(writer->Write(TrackId{id}, {.frame = frame})),
                  HasSubstr("by frame, then by id"));
    }
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(TrackFile, ReadsTheTruthOfPets) {
  const std::filesystem::path data = testing::DataFolder();
  if (data.empty()) GTEST_SKIP() << "no research data";
  const Result<Tracks> truth = ReadTracks(data / "pets2009" / "gt-mot15-3d.txt");
  ASSERT_TRUE(truth) << testing::MessageOf(truth);
  EXPECT_THAT(*truth, SizeIs(19));
  std::set<FrameIndex> frames;
  std::size_t points = 0;
  for (const Track& track : *truth) {
    points += track.points.size();
    for (const TrackPoint& point : track.points) frames.insert(point.frame);
  }
  EXPECT_EQ(points, 4650U);
  EXPECT_EQ(*frames.begin(), 0);
  EXPECT_EQ(*frames.rbegin(), 794);
}

}  // namespace
}  // namespace vantage
