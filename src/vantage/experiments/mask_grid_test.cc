// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/mask_grid.h"

#include <gmock/gmock.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"
#include "vantage/experiments/test_mask_recording.h"

namespace vantage {
namespace {

using testing::GhostSequence;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

TEST(DrawMask, OneColorForEachOutcome) {
  const cv::Mat mask = (cv::Mat_<std::uint8_t>(1, 6) << 255, 255, 0, 0, 255, 255);
  const cv::Mat labels = (cv::Mat_<std::uint8_t>(1, 6) << 255, 0, 255, 0, 170, 50);
  const cv::Mat drawn = DrawMask(mask, labels);
  const auto at = [&](int x) { return drawn.at<cv::Vec3b>(0, x); };
  EXPECT_EQ(at(0), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(at(3), cv::Vec3b(0, 0, 0));
  EXPECT_GT(at(1)[2], 200);  // red: false
  EXPECT_LT(at(1)[0], 100);
  EXPECT_GT(at(2)[0], 200);  // blue: missed
  EXPECT_LT(at(2)[2], 100);
  EXPECT_EQ(at(4)[0], at(4)[2]);  // grey: not counted
  EXPECT_EQ(at(5), at(1));        // a shadow is background
  const cv::Mat bare = DrawMask(mask, {});
  EXPECT_EQ(bare.at<cv::Vec3b>(0, 1), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(bare.at<cv::Vec3b>(0, 2), cv::Vec3b(0, 0, 0));
}

class MaskGrid : public ::testing::Test {
 protected:
  MaskGrid() { testing::WriteMaskRecording(folder_.path()); }
  LabelledSequence Open(const FrameSpan& span = {}) const {
    return LabelledSequence::OpenRecording(folder_.path(), 0, span).value();
  }
  static MaskGridPlan Plan() {
    MaskGridRow none{.name = "none", .background = true};
    none.options.ghosts.rule.criterion = GhostCriterion::kNone;
    return {.rows = {none, {.name = "fep"}}, .columns = {0, 10, 500}};
  }
  TemporaryFolder folder_;
};

TEST_F(MaskGrid, DrawsTheColumns) {
  const auto grid = DrawMaskGrid(Open({.begin = 5}), Plan()).value();
  EXPECT_EQ(grid["columns"], (std::vector<std::string>{"frame 5", "frame 15"}));
  std::vector<std::string> names;
  for (const auto& row : grid["rows"]) {
    names.push_back(row["name"]);
    ASSERT_EQ(row["pictures"].size(), 2u);
    for (const std::string uri : row["pictures"]) EXPECT_THAT(uri, HasSubstr("data:image/"));
  }
  EXPECT_THAT(names, ::testing::ElementsAre("picture", "none: background", "none", "fep"));
  EXPECT_EQ(grid["foreground"][1]["name"], "fep");
  EXPECT_EQ(grid["foreground"][1]["frames"].size(), GhostSequence::kFrames - 5);
}

TEST_F(MaskGrid, AllForegroundWithoutTruth) {
  const auto bare =
      DrawMaskGrid(LabelledSequence::OpenUnlabelled(folder_ / "cam1.mp4", {}).value(), Plan())
          .value();
  const auto truth = DrawMaskGrid(Open(), Plan()).value();
  std::int64_t foreground = 0, wrong = 0;
  for (int i = 0; i < GhostSequence::kFrames; ++i) {
    const auto index = static_cast<std::size_t>(i);
    foreground += bare["foreground"][0]["frames"][index][1].get<std::int64_t>();
    wrong += truth["foreground"][0]["frames"][index][1].get<std::int64_t>();
  }
  EXPECT_GT(foreground, wrong);
  EXPECT_GT(wrong, 0);
}

TEST_F(MaskGrid, FailsAndStops) {
  MaskGridPlan wrong = Plan();
  wrong.rows[1].options.mixture.alpha = 2;
  EXPECT_THAT(MessageOf(DrawMaskGrid(Open(), wrong)), HasSubstr("alpha is 2"));
  const std::atomic<bool> stop{true};
  EXPECT_THAT(MessageOf(DrawMaskGrid(Open(), Plan(), {.progress = {}, .stop = &stop})),
              HasSubstr("interrupted"));
}

}  // namespace
}  // namespace vantage
