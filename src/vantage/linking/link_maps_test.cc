// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/link_maps.h"

#include <gmock/gmock.h>

#include "vantage/base/test_support.h"
#include "vantage/linking/access.h"

namespace vantage {
namespace {

/// Maps of cells of 1 m, all seen, the outer ring being extension.
OccupancyMaps EmptyMaps(int columns, int rows, std::int64_t frames) {
  OccupancyMaps maps;
  maps.grid = {.min_x_m = 0, .min_y_m = 0, .cell_m = 1, .columns = columns, .rows = rows};
  maps.frames_per_second = 10;
  const auto cells = static_cast<std::size_t>(columns * rows);
  maps.visible.assign(cells, 1);
  maps.in_area.assign(cells, 0);
  for (int row = 1; row + 1 < rows; ++row) {
    for (int column = 1; column + 1 < columns; ++column) {
      maps.in_area[static_cast<std::size_t>(maps.grid.Index(column, row))] = 1;
    }
  }
  maps.values.assign(cells * static_cast<std::size_t>(frames), 0.001F);
  return maps;
}

void Put(OccupancyMaps& maps, std::int64_t frame, int column, int row, float q) {
  maps.values[static_cast<std::size_t>(frame * maps.grid.count() + maps.grid.Index(column, row))] =
      q;
}

TEST(Access, BorderIsWhereTheSeenEnds) {
  OccupancyMaps maps = EmptyMaps(5, 4, 1);
  maps.visible[static_cast<std::size_t>(maps.grid.Index(0, 0))] = 0;
  const auto access = AccessCells(maps, AccessRule::kBorder, {});
  // The hidden corner is none; its inner neighbour (1, 1) is one; (2, 1), (3, 1), (2, 2) ... are
  // not.
  const std::vector<std::uint8_t> expected = {0, 1, 1, 1, 1,  //
                                              1, 1, 0, 0, 1,  //
                                              1, 0, 0, 0, 1,  //
                                              1, 1, 1, 1, 1};
  EXPECT_EQ(access, expected);
}

TEST(Access, DoorsCountUnderEveryRule) {
  const OccupancyMaps maps = EmptyMaps(5, 5, 1);
  const std::vector<Polygon> doors = {Polygon::Rectangle({2, 2}, {3, 3}).value()};
  const auto center = static_cast<std::size_t>(maps.grid.Index(2, 2));
  for (const AccessRule rule : {AccessRule::kBorder, AccessRule::kAnywhere, AccessRule::kDoors}) {
    EXPECT_EQ(AccessCells(maps, rule, doors)[center], 1);
  }
  const auto only_doors = AccessCells(maps, AccessRule::kDoors, doors);
  EXPECT_EQ(std::count(only_doors.begin(), only_doors.end(), 1), 1);
}

TEST(Access, EntrancesAreTheCellsOfTheirPoints) {
  const OccupancyMaps maps = EmptyMaps(5, 4, 1);
  const std::vector<Polygon> doors = {Polygon::Rectangle({0, 0}, {1, 1}).value()};
  // Amid a cell, on a corner of cells, and twice the same.
  const std::vector<Eigen::Vector2d> points = {{2.5, 1.5}, {4, 3}, {2.1, 1.9}};
  const auto all = DoorsAndEntrances(maps.grid, doors, points);
  ASSERT_TRUE(all) << testing::MessageOf(all);
  const std::vector<std::uint8_t> expected = {1, 0, 0, 0, 0,  //
                                              0, 0, 1, 0, 0,  //
                                              0, 0, 0, 0, 0,  //
                                              0, 0, 0, 0, 1};
  EXPECT_EQ(AccessCells(maps, AccessRule::kDoors, *all), expected);
  EXPECT_THAT(testing::MessageOf(DoorsAndEntrances(maps.grid, {}, {{{5.5, 1.0}}})),
              ::testing::HasSubstr("area.entrances: (5.5, 1) is outside the grid"));
}

TEST(LinkMaps, OnePersonWhoWalksAcrossIsOneTrackInsideTheArea) {
  OccupancyMaps maps = EmptyMaps(12, 5, 24);
  maps.first_frame = 100;
  for (int frame = 0; frame < 24; ++frame) Put(maps, frame, frame / 2, 2, 0.95F);
  const auto result =
      LinkMaps(maps, {.movement_cost = 1}, {.smoothing_secs = 0, .min_length_secs = 0});
  ASSERT_TRUE(result) << testing::MessageOf(result);
  ASSERT_EQ(result->tracks.size(), 1U);
  const Track& track = result->tracks[0];
  // Columns 1 to 10 are area: frames 2 to 21 of the recording.
  EXPECT_EQ(track.points.front().frame, 102);
  EXPECT_EQ(track.points.back().frame, 121);
  for (const TrackPoint& point : track.points) {
    EXPECT_NEAR(point.x_m, static_cast<double>((point.frame - 100) / 2) + 0.5, 0.05);
    EXPECT_NEAR(point.y_m, 2.5, 0.05);
    EXPECT_FALSE(point.inferred);
  }
  EXPECT_EQ(result->report.linking.paths, 1);
}

TEST(LinkMaps, ObstaclesAreNotWalkedThrough) {
  OccupancyMaps maps = EmptyMaps(12, 5, 24);
  for (int frame = 0; frame < 24; ++frame) {
    if (frame / 2 != 5) Put(maps, frame, frame / 2, 2, 0.95F);  // hidden by the wall
  }
  const std::vector<Polygon> wall = {Polygon::Rectangle({5, 0}, {6, 5}).value()};
  const auto result = LinkMaps(maps, {.birth_cost = 0, .movement_cost = 0},
                               {.smoothing_secs = 0, .min_length_secs = 0}, {}, wall);
  ASSERT_TRUE(result);
  for (const Track& track : result->tracks) {
    for (const TrackPoint& point : track.points) EXPECT_FALSE(point.x_m > 5.1 && point.x_m < 5.9);
  }
  EXPECT_EQ(result->tracks.size(), 2U) << "one on each side";
}

}  // namespace
}  // namespace vantage
