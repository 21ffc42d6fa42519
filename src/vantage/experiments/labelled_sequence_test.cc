// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/labelled_sequence.h"

#include <gmock/gmock.h>

#include <fstream>
#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"
#include "vantage/experiments/test_mask_recording.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::GhostSequence;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

/// Frames with and without truth, and the truth's moving pixels.
struct Seen {
  std::vector<FrameIndex> shown, counted;
  std::int64_t moving_px = 0, outside_px = 0;
};
Seen ReadAll(LabelledSequence sequence) {
  Seen seen;
  LabelledFrame frame;
  while (sequence.Next(frame).value()) {
    seen.shown.push_back(frame.frame);
    EXPECT_EQ(frame.bgr.type(), CV_8UC3);
    if (frame.labels.empty()) continue;
    EXPECT_EQ(frame.labels.size(), frame.bgr.size());
    seen.counted.push_back(frame.frame);
    seen.moving_px += cv::countNonZero(frame.labels == TruthLabel::kMoving);
    seen.outside_px += cv::countNonZero(frame.labels == TruthLabel::kOutside);
  }
  return seen;
}

TEST(LabelledSequence, ChangeDetection) {
  const TemporaryFolder folder;
  GhostSequence::Write(folder / "one");
  const Seen seen =
      ReadAll(LabelledSequence::OpenSequence(folder / "one", {.begin = 5, .first = 30, .last = 32})
                  .value());
  EXPECT_EQ(seen.shown.front(), 5);
  EXPECT_EQ(seen.shown.back(), 32);
  EXPECT_THAT(seen.counted, ::testing::ElementsAre(30, 31, 32));
  EXPECT_EQ(seen.moving_px, 3 * GhostSequence::Box(30).area());
  EXPECT_EQ(seen.outside_px, 3 * 4 * GhostSequence::kWidth);  // the region of interest
  const Seen late =
      ReadAll(LabelledSequence::OpenSequence(folder / "one", {.lead = 4, .most = 3}).value());
  EXPECT_THAT(late.shown, ::testing::ElementsAre(16, 17, 18, 19, 20, 21, 22));
  EXPECT_THAT(late.counted, ::testing::ElementsAre(20, 21, 22));
  // The temporal range begins at frame 20.
  EXPECT_THAT(ReadAll(LabelledSequence::OpenSequence(folder / "one", {.most = 2}).value()).counted,
              ::testing::ElementsAre(20, 21));
}

TEST(LabelledSequence, Recording) {
  const TemporaryFolder folder;
  testing::WriteMaskRecording(folder.path(), 2, 20);
  for (const int camera : {0, 1}) {
    const Seen seen = ReadAll(
        LabelledSequence::OpenRecording(folder.path(), camera, {.begin = 3, .first = 8, .most = 4})
            .value());
    EXPECT_EQ(seen.shown.size(), 9u);
    EXPECT_THAT(seen.counted, ::testing::ElementsAre(8, 9, 10, 11));
    EXPECT_EQ(seen.moving_px, 4 * GhostSequence::Box(0).area());
  }
  EXPECT_EQ(ReadAll(LabelledSequence::OpenRecording(folder.path(), 0, {}).value()).counted.size(),
            20u);
  EXPECT_THAT(MessageOf(LabelledSequence::OpenRecording(folder.path(), 2, {})),
              HasSubstr("has no camera 3; it has 2"));
}

TEST(LabelledSequence, BrokenRecordings) {
  const TemporaryFolder folder;
  EXPECT_THAT(MessageOf(LabelledSequence::OpenRecording(folder.path(), 0, {})),
              HasSubstr("scene.toml"));
  testing::WriteMaskRecording(folder.path(), 2, 20);
  // Masks of fewer frames.
  testing::WriteMaskRecording(folder / "short", 1, 10);
  const fs::path masks = folder.path() / "truth/masks/cam1/masks.mkv";
  fs::copy_file(folder.path() / "short/truth/masks/cam1/masks.mkv", masks,
                fs::copy_options::overwrite_existing);
  LabelledSequence sequence = LabelledSequence::OpenRecording(folder.path(), 0, {}).value();
  LabelledFrame frame;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(sequence.Next(frame).value());
  EXPECT_THAT(MessageOf(sequence.Next(frame)), HasSubstr("ends before frame 10"));
  fs::remove(masks);
  EXPECT_FALSE(LabelledSequence::OpenRecording(folder.path(), 0, {}));
  fs::resize_file(folder.path() / "cam2.mp4", 100);
  EXPECT_THAT(MessageOf(LabelledSequence::OpenRecording(folder.path(), 1, {})),
              HasSubstr("cam2.mp4"));
}

TEST(LabelledSequence, WithoutTruth) {
  const TemporaryFolder folder;
  testing::WriteMaskRecording(folder.path(), 1, 12);
  const Seen seen = ReadAll(
      LabelledSequence::OpenUnlabelled(folder / "cam1.mp4", {.begin = 2, .last = 6}).value());
  EXPECT_EQ(seen.shown.size(), 5u);
  EXPECT_TRUE(seen.counted.empty());
  EXPECT_EQ(ReadAll(LabelledSequence::OpenUnlabelled(folder / "cam1.mp4", {}).value()).shown.size(),
            12u);
  EXPECT_FALSE(LabelledSequence::OpenUnlabelled(folder / "none.mp4", {}));
}

}  // namespace
}  // namespace vantage
