// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/multi_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MessageOf;

/// Frames whose every pixel is their number; fails at one of them if asked to.
class CountingSource final : public FrameSource {
 public:
  CountingSource(std::string name, ImageSize size, int frames, bool known = true, int fails_at = -1)
      : frames_(frames), fails_at_(fails_at) {
    info_.name = std::move(name);
    info_.size = size;
    if (known) info_.frame_count = frames;
  }
  const SourceInfo& info() const override { return info_; }
  Result<bool> Read(cv::Mat& frame) override {
    if (next_ == fails_at_) return Fail("{}: frame {} is bad", info_.name, next_);
    if (next_ == frames_) return false;
    frame.create(info_.size.height, info_.size.width, CV_8UC1);
    frame.setTo(next_++);
    return true;
  }

 private:
  SourceInfo info_;
  int frames_;
  int fails_at_;
  int next_ = 0;
};

SyncedSource Camera(std::string name, int frames, std::int64_t offset, bool known = true,
                    int fails_at = -1) {
  return {
      std::make_unique<CountingSource>(std::move(name), ImageSize{4, 3}, frames, known, fails_at),
      offset};
}

std::vector<SyncedSource> Cameras(SyncedSource a, SyncedSource b) {
  std::vector<SyncedSource> sources;
  sources.push_back(std::move(a));
  sources.push_back(std::move(b));
  return sources;
}

/// Numbers of the frames read together; -1 for no picture.
std::vector<std::vector<int>> ReadAll(MultiCameraReader& reader, int threads) {
  std::vector<std::vector<int>> numbers;
  std::vector<cv::Mat> frames;
  while (true) {
    const Result<bool> more = reader.Read(frames, threads);
    EXPECT_TRUE(more) << MessageOf(more);
    if (!more || !*more) return numbers;
    numbers.emplace_back();
    for (const cv::Mat& frame : frames) {
      numbers.back().push_back(frame.empty() ? -1 : frame.at<unsigned char>(0, 0));
    }
  }
}

TEST(MultiCameraReader, OffsetsShiftEachCamera) {
  for (const int threads : {1, 2, 8}) {
    auto reader = MultiCameraReader::Create(Cameras(Camera("a", 5, 1), Camera("b", 3, -2)));
    ASSERT_TRUE(reader) << MessageOf(reader);
    EXPECT_EQ(reader->frame_count(), 4);
    EXPECT_THAT(ReadAll(*reader, threads), ElementsAre(ElementsAre(1, -1), ElementsAre(2, -1),
                                                       ElementsAre(3, 0), ElementsAre(4, 1)));
    EXPECT_EQ(reader->next_frame(), 4);
    std::vector<cv::Mat> frames;
    EXPECT_FALSE(reader->Read(frames, threads).value());
  }
}

TEST(MultiCameraReader, StartsAtAFrameOfTheScene) {
  auto reader = MultiCameraReader::Create(Cameras(Camera("a", 9, 2), Camera("b", 9, -4)), 3);
  ASSERT_TRUE(reader) << MessageOf(reader);
  EXPECT_EQ(reader->frame_count(), 4);
  EXPECT_EQ(reader->next_frame(), 3);
  EXPECT_THAT(ReadAll(*reader, 1), ElementsAre(ElementsAre(5, -1), ElementsAre(6, 0),
                                               ElementsAre(7, 1), ElementsAre(8, 2)));
}

TEST(MultiCameraReader, ReportsFramesOfEachCamera) {
  auto reader = MultiCameraReader::Create(Cameras(Camera("a", 5, 1), Camera("b", 3, -2, false)));
  ASSERT_TRUE(reader);
  ReadAll(*reader, 1);
  const std::vector<CameraFrames> report = reader->report();
  ASSERT_EQ(report.size(), 2u);
  EXPECT_EQ(report[0].name, "a");
  EXPECT_EQ(report[0].frame_count, 5);
  EXPECT_EQ(report[0].offset_frames, 1);
  EXPECT_EQ(report[0].frames_read, 4);
  EXPECT_EQ(report[1].frame_count, std::nullopt);
  EXPECT_EQ(report[1].frames_read, 2);
}

TEST(MultiCameraReader, CamerasMayBeReadAtTheirOwnPace) {
  auto reader = MultiCameraReader::Create(Cameras(Camera("a", 9, 2), Camera("b", 9, -4)), 3);
  ASSERT_TRUE(reader) << MessageOf(reader);
  cv::Mat frame;
  for (const int number : {5, 6, 7, 8}) {
    ASSERT_TRUE(reader->ReadCamera(0, frame).value());
    EXPECT_EQ(frame.at<unsigned char>(0, 0), number);
  }
  EXPECT_FALSE(reader->ReadCamera(0, frame).value());
  ASSERT_TRUE(reader->ReadCamera(1, frame).value());
  EXPECT_TRUE(frame.empty()) << "it starts later";
  ASSERT_TRUE(reader->ReadCamera(1, frame).value());
  EXPECT_EQ(frame.at<unsigned char>(0, 0), 0);
  EXPECT_EQ(reader->report()[0].frames_read, 4);
  EXPECT_EQ(reader->report()[1].frames_read, 1);
}

TEST(MultiCameraReader, SizesMayDiffer) {
  std::vector<SyncedSource> sources;
  sources.push_back({std::make_unique<CountingSource>("a", ImageSize{4, 3}, 2), 0});
  sources.push_back({std::make_unique<CountingSource>("b", ImageSize{7, 5}, 2), 0});
  auto reader = MultiCameraReader::Create(std::move(sources));
  std::vector<cv::Mat> frames;
  ASSERT_TRUE(reader->Read(frames, 2).value());
  EXPECT_EQ(frames[0].size(), cv::Size(4, 3));
  EXPECT_EQ(frames[1].size(), cv::Size(7, 5));
  EXPECT_EQ(reader->infos()[1].size, (ImageSize{7, 5}));
}

TEST(MultiCameraReader, ErrorsNameTheCamera) {
  auto reader =
      MultiCameraReader::Create(Cameras(Camera("a", 5, 0, true, 2), Camera("b", 5, 0, true, 2)));
  std::vector<cv::Mat> frames;
  ASSERT_TRUE(reader->Read(frames, 2).value());
  ASSERT_TRUE(reader->Read(frames, 2).value());
  EXPECT_EQ(MessageOf(reader->Read(frames, 2)), "a: frame 2 is bad");
}

TEST(MultiCameraReader, RefusesWhatCannotStart) {
  EXPECT_THAT(MessageOf(MultiCameraReader::Create({})), HasSubstr("no camera"));
  EXPECT_THAT(MessageOf(MultiCameraReader::Create(Cameras(Camera("a", 5, 0), Camera("b", 5, 7)))),
              HasSubstr("b: ends after 5 frames; frame 0 of the scene is its frame 7"));
  EXPECT_THAT(
      MessageOf(MultiCameraReader::Create(Cameras(Camera("a", 5, 0), Camera("b", 5, 0)), -1)),
      HasSubstr("first frame is -1"));
  EXPECT_THAT(MessageOf(MultiCameraReader::Create(Cameras(
                  Camera("a", 5, 0), Camera("b", 5, std::numeric_limits<std::int64_t>::min())))),
              HasSubstr("b: the offset is"));
}

}  // namespace
}  // namespace vantage
