// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/base/test_support.h"

namespace vantage::simulation {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using vantage::testing::MessageOf;
using Pictures = std::vector<std::optional<FrameIndex>>;

std::vector<CameraFault> Parsed(const std::vector<std::string_view>& texts) {
  std::vector<CameraFault> faults;
  for (const std::string_view text : texts) faults.push_back(ParseCameraFault(text).value());
  return faults;
}

Pictures Delivered(FrameIndex frames, int camera, const std::vector<std::string_view>& texts) {
  return DeliveredFrames(frames, 10, camera, Parsed(texts));
}

TEST(Faults, NoneDeliversEveryFrame) {
  EXPECT_THAT(Delivered(4, 0, {}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(Delivered(4, 0, {"drop:2:1:2"}), ElementsAre(0, 1, 2, 3)) << "of another camera";
}

TEST(Faults, DroppedFramesAreMissing) {
  EXPECT_THAT(Delivered(6, 1, {"drop:2:1:3"}), ElementsAre(0, 4, 5));
  EXPECT_THAT(Delivered(4, 0, {"drop:1:2:999999999999"}), ElementsAre(0, 1));
  EXPECT_THAT(Delivered(4, 0, {"drop:1:9:1"}), ElementsAre(0, 1, 2, 3));
}

TEST(Faults, FrozenAndBlackPicturesKeepTheirPlace) {
  EXPECT_THAT(Delivered(6, 0, {"freeze:1:2:2", "black:1:5:1"}),
              ElementsAre(0, 1, 1, 1, 4, std::nullopt));
}

TEST(Faults, AClockThatRunsFastSkipsAndOneThatRunsSlowRepeats) {
  // At 10 frames a second 5 more a second are every second one more.
  EXPECT_THAT(Delivered(8, 0, {"drift:1:2:5"}), ElementsAre(0, 1, 2, 4, 5, 7));
  EXPECT_THAT(Delivered(8, 0, {"drift:1:2:-5"}), ElementsAre(0, 1, 2, 3, 3, 4, 4, 5));
  EXPECT_THAT(Delivered(5, 0, {"drift:1:0:-10", "drift:1:0:-10"}), ElementsAre(0, 0, 0, 0, 0))
      << "never backward";
}

TEST(Faults, RefusesOtherTexts) {
  for (const std::string_view text :
       {"", "drop", "drop:1:2", "drop:0:2:1", "drop:1:-1:1", "drop:1:1:0", "freeze:1:0:1",
        "melt:1:1:1", "drift:1:0:nan", "drift:1:0:11", "drop:1:1:1:1", "black:1:x:1"}) {
    EXPECT_THAT(MessageOf(ParseCameraFault(text)), HasSubstr("is not a fault")) << text;
  }
}

}  // namespace
}  // namespace vantage::simulation
