// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/render_video.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"
#include "vantage/rendering/palette.h"
#include "vantage/rendering/test_scene.h"
#include "vantage/video/open.h"

namespace vantage {
namespace {

using testing::CornerScene;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

constexpr ImageSize kSize = {320, 240};

/// Grey frames, each a little brighter than the one before.
class GreySource final : public FrameSource {
 public:
  GreySource(ImageSize size, std::int64_t count) : count_(count) {
    info_.name = "grey";
    info_.size = size;
    info_.frame_count = count;
  }
  const SourceInfo& info() const override { return info_; }
  Result<bool> Read(cv::Mat& frame) override {
    if (next_ >= count_) return false;
    frame.create(info_.size.height, info_.size.width, CV_8UC3);
    frame.setTo(cv::Scalar::all(50 + 10 * static_cast<double>(next_++)));
    return true;
  }

 private:
  SourceInfo info_;
  std::int64_t count_;
  std::int64_t next_ = 0;
};

std::vector<SyncedSource> Sources(ImageSize size, std::int64_t count, std::size_t cameras = 1) {
  std::vector<SyncedSource> sources;
  for (std::size_t i = 0; i < cameras; ++i) {
    sources.push_back({std::make_unique<GreySource>(size, count), 0});
  }
  return sources;
}

Tracks Walk(FrameIndex frames) {
  Track track{TrackId{1}, {}};
  for (FrameIndex frame = 0; frame < frames; ++frame) {
    track.points.push_back({frame, -2 + 0.2 * static_cast<double>(frame), 0, false});
  }
  return {track};
}

std::vector<cv::Mat> ReadAll(const std::filesystem::path& path) {
  auto source = OpenVideo(path).value();
  std::vector<cv::Mat> frames;
  cv::Mat frame;
  while (source->Read(frame).value()) frames.push_back(frame.clone());
  return frames;
}

TEST(RenderVideo, WritesEveryFrameAsItIsComposed) {
  const TemporaryFolder folder;
  const Scene scene = CornerScene({kSize, kSize});
  const RenderOptions options{.height_px = 360};
  std::vector<std::int64_t> progress;
  RunControl control;
  control.progress = [&](std::int64_t done, std::int64_t total) {
    EXPECT_EQ(total, 8);
    progress.push_back(done);
  };
  const auto report =
      RenderVideo(scene, Walk(8), Sources(kSize, 8, 2), folder / "out.mp4", options, 2, control);
  ASSERT_TRUE(report) << MessageOf(report);
  EXPECT_EQ(report->frames, 8);
  EXPECT_THAT(progress, ::testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  const std::vector<cv::Mat> frames = ReadAll(folder / "out.mp4");
  ASSERT_EQ(frames.size(), 8u);
  const Composition composition(scene, options);
  EXPECT_EQ(frames[0].size(), composition.size());
  for (const int index : {0, 5}) {
    const cv::Mat picture(kSize.height, kSize.width, CV_8UC3, cv::Scalar::all(50 + 10 * index));
    const cv::Mat expected = composition.Draw(Walk(8), index, {picture, picture});
    // The codec loses little on the whole.
    EXPECT_LT(cv::norm(frames[static_cast<std::size_t>(index)], expected, cv::NORM_L1) /
                  static_cast<double>(expected.total() * 3),
              4);
  }
}

TEST(RenderVideo, FramesAreThoseThatTheSceneNames) {
  const TemporaryFolder folder;
  Scene scene = CornerScene({kSize});
  scene.first_frame = 3;
  scene.frame_count = 2;
  const RenderOptions options{.height_px = 240};
  const auto two = RenderVideo(scene, Walk(8), Sources(kSize, 8), folder / "two.mp4", options, 1);
  ASSERT_TRUE(two) << MessageOf(two);
  EXPECT_EQ(two->frames, 2);
  const Composition composition(scene, options);
  const cv::Rect view = composition.layout().views[0];
  EXPECT_NEAR(cv::mean(ReadAll(folder / "two.mp4")[0](view))[0], 80, 12);  // 50 + 3 * 10

  scene.frame_count = 100;
  const auto rest = RenderVideo(scene, Walk(8), Sources(kSize, 8), folder / "rest.mp4", options, 1);
  ASSERT_TRUE(rest) << MessageOf(rest);
  EXPECT_EQ(rest->frames, 5);
}

TEST(RenderVideo, NeedsNoSourcesWithoutPicture) {
  const TemporaryFolder folder;
  const Scene scene = CornerScene({kSize, kSize});
  const RenderOptions options{.picture = false, .height_px = 240};
  const auto report = RenderVideo(scene, Walk(6), {}, folder / "out.mp4", options, 1);
  ASSERT_TRUE(report) << MessageOf(report);
  EXPECT_EQ(report->frames, 6);
  EXPECT_EQ(ReadAll(folder / "out.mp4").size(), 6u);
}

TEST(RenderVideo, NobodyIsFine) {
  const TemporaryFolder folder;
  const auto report = RenderVideo(CornerScene({kSize}), {}, Sources(kSize, 3), folder / "out.mp4",
                                  {.height_px = 240}, 1);
  ASSERT_TRUE(report) << MessageOf(report);
  EXPECT_EQ(report->frames, 3);
}

TEST(RenderVideo, LeavesNothingWhenItFails) {
  const TemporaryFolder folder;
  const Scene scene = CornerScene({kSize});
  const auto out = folder / "out.mp4";
  EXPECT_THAT(MessageOf(RenderVideo(scene, {}, {}, out, {}, 1)),
              HasSubstr("0 sources for the 1 cameras of corners"));
  EXPECT_THAT(MessageOf(RenderVideo(scene, {}, Sources({320, 320}, 3), out, {}, 1)),
              HasSubstr("grey: its pictures are 320 x 320 px, camera cam1 is calibrated for 320 x "
                        "240 px"));
  EXPECT_THAT(MessageOf(RenderVideo(scene, {}, {}, out, {.picture = false}, 1)),
              HasSubstr("no frame to render"));
  EXPECT_THAT(MessageOf(RenderVideo(scene, {}, Sources(kSize, 3), out, {.height_px = 1}, 1)),
              HasSubstr("render.height"));
  std::atomic<bool> stop = true;
  RunControl control;
  control.stop = &stop;
  EXPECT_THAT(MessageOf(RenderVideo(scene, {}, Sources(kSize, 3), out, {}, 1, control)),
              HasSubstr("interrupted"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace vantage
