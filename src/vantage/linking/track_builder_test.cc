// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/track_builder.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

constexpr int kColumns = 20;
constexpr int kRows = 10;

OccupancyMaps AreaMaps(std::int64_t frames) {
  OccupancyMaps maps;
  maps.grid = {.min_x_m = 0, .min_y_m = 0, .cell_m = 0.5, .columns = kColumns, .rows = kRows};
  maps.frames_per_second = 10;
  maps.visible.assign(kColumns * kRows, 1);
  maps.in_area.assign(kColumns * kRows, 1);
  maps.values.assign(static_cast<std::size_t>(frames) * kColumns * kRows, 0);
  return maps;
}

float& Q(OccupancyMaps& maps, std::int64_t frame, int column, int row) {
  return maps
      .values[static_cast<std::size_t>(frame * maps.grid.count() + maps.grid.Index(column, row))];
}

LinkedPath Straight(const GroundGrid& grid, int frames, int column, int row) {
  return {
      .first_frame = 0,
      .cells = std::vector<CellIndex>(static_cast<std::size_t>(frames), grid.Index(column, row))};
}

TEST(TrackBuilder, PositionIsTheCentreOfMassOfTheCellsAround) {
  OccupancyMaps maps = AreaMaps(1);
  Q(maps, 0, 5, 5) = 0.6F;
  Q(maps, 0, 6, 5) = 0.2F;
  const Tracks tracks =
      BuildTracks({Straight(maps.grid, 1, 5, 5)}, maps, {.smoothing_secs = 0, .min_length_secs = 0})
          .value();
  ASSERT_EQ(tracks.size(), 1U);
  // Centres at x = 2.75 and 3.25 with weights 3 : 1.
  EXPECT_NEAR(tracks[0].points[0].x_m, 2.875, 1e-6);
  EXPECT_NEAR(tracks[0].points[0].y_m, 2.75, 1e-6);
}

TEST(TrackBuilder, GapsAreInferredOnStraightLinesAndLooseEndsDropped) {
  OccupancyMaps maps = AreaMaps(10);
  LinkedPath path;
  for (int frame = 0; frame < 10; ++frame) path.cells.push_back(maps.grid.Index(2 + frame, 4));
  for (const int frame : {2, 3, 6, 7}) Q(maps, frame, 2 + frame, 4) = 0.9F;
  const Tracks tracks =
      BuildTracks({path}, maps, {.smoothing_secs = 0, .min_length_secs = 0}).value();
  ASSERT_EQ(tracks.size(), 1U);
  ASSERT_EQ(tracks[0].points.size(), 6U);
  for (const TrackPoint& point : tracks[0].points) {
    EXPECT_EQ(point.inferred, point.frame == 4 || point.frame == 5);
    EXPECT_NEAR(point.x_m, 0.5 * (2 + static_cast<double>(point.frame)) + 0.25, 1e-6);
  }
}

TEST(TrackBuilder, SmoothingKeepsStraightLinesAndReducesNoise) {
  OccupancyMaps maps = AreaMaps(60);
  LinkedPath path;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise_m(-0.2, 0.2);
  // A person at constant speed, seen with noise: the mass is split between two columns so that its
  // centre is the noisy position.
  std::vector<double> truth_m, noisy_m;
  for (int frame = 0; frame < 60; ++frame) {
    truth_m.push_back(1.5 + 0.1 * frame);
    noisy_m.push_back(truth_m.back() + noise_m(random));
    const int column = static_cast<int>(std::floor((noisy_m.back() - 0.25) / 0.5));
    ASSERT_TRUE(column >= 0 && column + 1 < kColumns);
    const double share = (noisy_m.back() - 0.25) / 0.5 - column;
    Q(maps, frame, column, 4) = static_cast<float>(1 - share);
    Q(maps, frame, column + 1, 4) = static_cast<float>(share);
    path.cells.push_back(maps.grid.Index(column, 4));
  }
  const auto rms = [&](double smoothing_secs) {
    const Tracks tracks =
        BuildTracks({path}, maps, {.smoothing_secs = smoothing_secs, .min_length_secs = 0}).value();
    double sum = 0;
    for (std::size_t i = 0; i < 60; ++i) {
      sum += std::pow(tracks[0].points[i].x_m - truth_m[i], 2);
    }
    return std::sqrt(sum / 60);
  };
  EXPECT_LT(rms(1.0), 0.5 * rms(0));

  // Without noise a straight line stays what it is.
  OccupancyMaps exact = AreaMaps(20);
  LinkedPath line;
  for (int frame = 0; frame < 20; ++frame) {
    Q(exact, frame, frame, 4) = 0.9F;
    line.cells.push_back(exact.grid.Index(frame, 4));
  }
  const Tracks straight =
      BuildTracks({line}, exact, {.smoothing_secs = 1, .min_length_secs = 0}).value();
  for (const TrackPoint& point : straight[0].points) {
    EXPECT_NEAR(point.x_m, 0.5 * static_cast<double>(point.frame) + 0.25, 1e-6);
  }
}

TEST(TrackBuilder, ShortTracksAreDroppedAndIdsFollowFirstFrames) {
  OccupancyMaps maps = AreaMaps(40);
  LinkedPath late = Straight(maps.grid, 20, 3, 3);
  late.first_frame = 20;
  LinkedPath brief = Straight(maps.grid, 4, 8, 8);
  for (int frame = 0; frame < 40; ++frame) {
    Q(maps, frame, 3, 3) = Q(maps, frame, 8, 8) = Q(maps, frame, 15, 5) = 0.9F;
  }
  const Tracks tracks = BuildTracks({late, brief, Straight(maps.grid, 40, 15, 5)}, maps,
                                    {.smoothing_secs = 0, .min_length_secs = 1})
                            .value();
  ASSERT_EQ(tracks.size(), 2U);
  EXPECT_EQ(tracks[0].id, TrackId{1});
  EXPECT_EQ(tracks[0].points.front().frame, 0);
  EXPECT_EQ(tracks[1].id, TrackId{2});
  EXPECT_EQ(tracks[1].points.front().frame, 20);
}

TEST(TrackBuilder, NothingSeenIsNoTrackEvenWithoutAMinimalLength) {
  OccupancyMaps maps = AreaMaps(5);
  EXPECT_EQ(BuildTracks({Straight(maps.grid, 5, 3, 3)}, maps, {.min_length_secs = 0}).value(),
            Tracks());
}

TEST(TrackBuilder, RefusesOptionsOutOfRange) {
  EXPECT_THAT(testing::MessageOf(BuildTracks({}, AreaMaps(1), {.support = 0})),
              ::testing::HasSubstr("tracks.support is 0"));
}

}  // namespace
}  // namespace vantage
