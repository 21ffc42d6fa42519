// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/detections.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <opencv2/core.hpp>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;

constexpr ImageSize kSize = {40, 30};

class DetectionsTest : public ::testing::Test {
 protected:
  std::filesystem::path Write(const std::string& text) {
    EXPECT_TRUE(WriteTextFile(folder_ / "d.csv", text));
    return folder_ / "d.csv";
  }
  testing::TemporaryFolder folder_;
};

TEST_F(DetectionsTest, ReadsRowsInAnyOrderOfFrames) {
  const auto detections = ReadDetections(Write("frame,xmin,ymin,xmax,ymax,score\r\n2,1.5,2,3,4.25,"
                                               "0.75\r\n\r\n0, 5,6,7,8,1\r\n2,0,0,1,1,0.1"),
                                         kSize);
  ASSERT_TRUE(detections) << MessageOf(detections);
  ASSERT_EQ(detections->size(), 3u);
  EXPECT_EQ((*detections)[0].size(), 1u);
  EXPECT_EQ((*detections)[1].size(), 0u);
  ASSERT_EQ((*detections)[2].size(), 2u);
  const Detection& first = (*detections)[2][0];
  EXPECT_EQ(first.box.min_x, 1.0);
  EXPECT_EQ(first.box.min_y, 1.5);
  EXPECT_EQ(first.box.max_x, 2.5);
  EXPECT_EQ(first.box.max_y, 3.75);
  EXPECT_EQ(first.score, 0.75);
}

TEST_F(DetectionsTest, ScoreMayBeLeftOut) {
  const auto detections = ReadDetections(Write("frame,xmin,ymin,xmax,ymax\n0,1,1,2,2\n"), kSize);
  ASSERT_TRUE(detections) << MessageOf(detections);
  EXPECT_EQ((*detections)[0][0].score, 1);
}

TEST_F(DetectionsTest, BoxesAreClippedToThePicture) {
  const auto detections = ReadDetections(
      Write("frame,xmin,ymin,xmax,ymax\n0,-10,-5,1e300,100\n0,50,3,60,9\n0,3,3,3,9\n"), kSize);
  ASSERT_TRUE(detections) << MessageOf(detections);
  ASSERT_EQ((*detections)[0].size(), 1u);
  const cv::Mat mask = DrawDetections((*detections)[0], kSize, 0);
  EXPECT_EQ(cv::countNonZero(mask), kSize.width * kSize.height);
}

TEST_F(DetectionsTest, RefusesWithFileAndLine) {
  const std::string header = "frame,xmin,ymin,xmax,ymax,score\n";
  const std::pair<std::string, std::string> cases[] = {
      {"0,1,1,2,2,1\n", "d.csv:1: the header must be frame,xmin,ymin,xmax,ymax,score"},
      {header, "holds no detections"},
      {"", "holds no detections"},
      {header + "0,1,1,2,2,1\n0,1,1,2,2\n", "d.csv:3: has 5 fields; the header names 6"},
      {header + "0,1,1,2,2,1,9\n", "d.csv:2: has 7 fields"},
      {header + "-1,1,1,2,2,1\n", "d.csv:2: frame is '-1'"},
      {header + "1.5,1,1,2,2,1\n", "frame is '1.5'"},
      {header + "99999999999999999999,1,1,2,2,1\n", "frame is '99999999999999999999'"},
      {header + "10000000,1,1,2,2,1\n", "frame is '10000000'"},
      {header + "0,nan,1,2,2,1\n", "d.csv:2: xmin is 'nan'; it must be a finite number"},
      {header + "0,1,inf,2,2,1\n", "ymin is 'inf'"},
      {header + "0,1,1,2x,2,1\n", "xmax is '2x'"},
      {header + "0,1,1,2,,1\n", "ymax is ''"},
      {header + "0,1,1,2,2,1e999\n", "score is '1e999'"},
      {header + "0,3,1,2,2,1\n", "xmax 2 is less than xmin 3"},
      {header + "0,1,3,2,2,1\n", "ymax 2 is less than ymin 3"},
  };
  for (const auto& [text, message] : cases) {
    EXPECT_THAT(MessageOf(ReadDetections(Write(text), kSize)), HasSubstr(message)) << text;
  }
  EXPECT_THAT(MessageOf(ReadDetections(folder_ / "none.csv", kSize)), HasSubstr("no such file"));
  EXPECT_THAT(MessageOf(ReadDetections(Write(header), {0, 5})), HasSubstr("0 x 5"));
}

TEST_F(DetectionsTest, SourceDrawsWhatScoresEnough) {
  const auto source = OpenDetections(
      Write("frame,xmin,ymin,xmax,ymax,score\n0,2,3,5,7,0.9\n0,20,20,22,22,0.4\n2,0,0,1,1,0.5\n"),
      kSize, 0.5);
  ASSERT_TRUE(source) << MessageOf(source);
  EXPECT_EQ((*source)->info().frame_count, 3);
  EXPECT_EQ((*source)->info().size, kSize);
  EXPECT_EQ((*source)->info().content, FrameContent::kMask);
  cv::Mat mask;
  ASSERT_TRUE((*source)->Read(mask).value());
  ASSERT_EQ(mask.type(), CV_8UC1);
  EXPECT_EQ(cv::countNonZero(mask), 3 * 4);
  EXPECT_EQ(cv::countNonZero(mask(cv::Rect(2, 3, 3, 4)) == 255), 3 * 4);
  ASSERT_TRUE((*source)->Read(mask).value());
  EXPECT_EQ(cv::countNonZero(mask), 0);
  EXPECT_EQ((*source)->Skip(5).value(), 1);
  EXPECT_FALSE((*source)->Read(mask).value());
}

// Against the definition: a pixel is covered when its centre lies in a box.
RC_GTEST_PROP(DrawDetections, CoversPixelsWhoseCentresLieInABox, ()) {
  std::vector<Detection> detections;
  const auto edge = [](int limit) { return *rc::gen::inRange(-8, 4 * limit + 8) / 4.0; };
  for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
    const auto x = std::minmax({edge(kSize.width), edge(kSize.width)});
    const auto y = std::minmax({edge(kSize.height), edge(kSize.height)});
    const double score = *rc::gen::inRange(0, 5) / 4.0;
    detections.push_back({{x.first, y.first, x.second, y.second}, score});
  }
  const cv::Mat mask = DrawDetections(detections, kSize, 0.5);
  for (int row = 0; row < kSize.height; ++row) {
    for (int column = 0; column < kSize.width; ++column) {
      bool covered = false;
      for (const auto& [box, score] : detections) {
        covered |= score >= 0.5 && box.min_x <= column && column < box.max_x && box.min_y <= row &&
                   row < box.max_y;
      }
      RC_ASSERT(mask.at<unsigned char>(row, column) == (covered ? 255 : 0));
    }
  }
}

}  // namespace
}  // namespace vantage
