// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/recent_tracks.h"

#include <gmock/gmock.h>

#include "vantage/base/test_support.h"
#include "vantage/linking/link_maps.h"

namespace vantage {
namespace {

using testing::MessageOf;

/// Two people, one who walks and one who stands, seen surely (simulated).
OccupancyMaps TwoPeople(int frames) {
  OccupancyMaps maps{.grid = {.cell_m = 0.5, .columns = 20, .rows = 6},
                     .first_frame = 100,
                     .frames_per_second = 10,
                     .in_area = std::vector<std::uint8_t>(120, 1),
                     .visible = std::vector<std::uint8_t>(120, 1),
                     .values = {}};
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<float> map(120, 0.001F);
    map[static_cast<std::size_t>(maps.grid.Index(frame / 3 % 20, 1))] = 0.99F;
    map[static_cast<std::size_t>(maps.grid.Index(8, 4))] = 0.99F;
    maps.values.insert(maps.values.end(), map.begin(), map.end());
  }
  return maps;
}

TEST(RecentTracks, AreThoseOfTheLastMapsHoweverTheyCome) {
  constexpr int kWindow = 12;
  const OccupancyMaps all = TwoPeople(50);
  const LinkingOptions linking{.movement_cost = 2};
  const std::size_t cells = static_cast<std::size_t>(all.grid.count());
  for (const std::size_t step : {1U, 8U, 30U}) {
    auto recent = RecentTracks::Create(all, kWindow, linking, {}, {}, {});
    ASSERT_TRUE(recent) << MessageOf(recent);
    for (std::size_t frame = 0; frame < 50; frame += step) {
      const std::size_t end = std::min<std::size_t>(frame + step, 50);
      ASSERT_TRUE(recent->Add(std::span(all.values).subspan(frame * cells, (end - frame) * cells)));
      EXPECT_EQ(recent->next_frame(), 100 + static_cast<FrameIndex>(end));
      const std::size_t first = end < kWindow ? 0 : end - kWindow;
      OccupancyMaps window = all;
      window.first_frame = 100 + static_cast<FrameIndex>(first);
      window.values.assign(all.values.begin() + static_cast<std::ptrdiff_t>(first * cells),
                           all.values.begin() + static_cast<std::ptrdiff_t>(end * cells));
      const auto expected = LinkMaps(window, linking, {.smoothing_secs = 0, .min_length_secs = 0});
      const auto tracks = recent->Link();
      ASSERT_TRUE(expected && tracks) << MessageOf(tracks);
      // Before the window is full, a path that may go on has not paid for its end: found sooner.
      EXPECT_GE(tracks->size(), expected->tracks.size());
      if (end < kWindow) continue;
      EXPECT_EQ(*tracks, expected->tracks);
      EXPECT_EQ(tracks->size(), 2U);
    }
  }
}

}  // namespace
}  // namespace vantage
