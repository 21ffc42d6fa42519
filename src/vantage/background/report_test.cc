// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace vantage {
namespace {

TEST(BackgroundReport, EventsAsTextAndJson) {
  BackgroundReport report;
  report.frames = 900;
  report.ghosts_px = 12;
  report.disturbances.events = {
      {.kind = DisturbanceKind::kLight, .frame = 20, .frames = 3, .factor = 0.614},
      {.kind = DisturbanceKind::kMoved, .frame = 50, .frames = 1, .length_px = 5.04}};
  EXPECT_EQ(TextOf(report.disturbances.events[0], 600),
            "light changed, levels x 0.61: frame 620, 3 frames unreliable");
  EXPECT_EQ(TextOf(report.disturbances.events[1]),
            "camera moved, picture shifted by 5.0 px: frame 50, 1 frame unreliable");
  const nlohmann::ordered_json json = JsonOf(report);
  EXPECT_EQ(json["frames"], 900);
  EXPECT_EQ(json["ghosts_px"], 12);
  ASSERT_EQ(json["events"].size(), 2u);
  EXPECT_EQ(json["events"][0]["kind"], "light");
  EXPECT_EQ(json["events"][0]["factor"], 0.614);
  EXPECT_EQ(json["events"][1]["length_px"], 5.04);
  EXPECT_FALSE(json["events"][1].contains("factor"));
}

}  // namespace
}  // namespace vantage
