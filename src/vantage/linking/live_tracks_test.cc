// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/live_tracks.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "vantage/base/test_support.h"
#include "vantage/linking/link_maps.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::MessageOf;

constexpr int kColumns = 24;
constexpr int kRows = 14;

/// Cells of 0.5 m at 10 frames per second, all seen; the outer two rings are extension.
OccupancyMaps EmptyMaps(std::int64_t frames) {
  OccupancyMaps maps;
  maps.grid = {.min_x_m = -3, .min_y_m = 2, .cell_m = 0.5, .columns = kColumns, .rows = kRows};
  maps.first_frame = 700;
  maps.frames_per_second = 10;
  maps.visible.assign(kColumns * kRows, 1);
  maps.in_area.assign(kColumns * kRows, 0);
  for (int row = 2; row + 2 < kRows; ++row) {
    for (int column = 2; column + 2 < kColumns; ++column) {
      maps.in_area[static_cast<std::size_t>(maps.grid.Index(column, row))] = 1;
    }
  }
  maps.values.assign(static_cast<std::size_t>(frames) * kColumns * kRows, 0.002F);
  return maps;
}

void Put(OccupancyMaps& maps, std::int64_t frame, int column, int row, float q = 1) {
  maps.values[static_cast<std::size_t>(frame * maps.grid.count() + maps.grid.Index(column, row))] =
      q;
}

/// People who come over the border, wander and leave; a tenth of them is missed, often for several
/// frames, and there are false alarms.
OccupancyMaps Crowd(unsigned seed, int people, std::int64_t frames) {
  OccupancyMaps maps = EmptyMaps(frames);
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int person = 0; person < people; ++person) {
    const double start = uniform(-10, static_cast<double>(frames) - 10);
    const double speed = uniform(0.15, 0.5);  // cells per frame
    const double first_row = uniform(1, kRows - 1);
    const double last_row = uniform(1, kRows - 1);
    const bool rightwards = person % 2 == 0;
    int hidden = 0;
    for (std::int64_t frame = 0; frame < frames; ++frame) {
      const double x = speed * (static_cast<double>(frame) - start);
      if (x < 0 || x >= kColumns) continue;
      const double row = first_row + (last_row - first_row) * x / kColumns;
      if (hidden == 0 && uniform(0, 1) < 0.03) hidden = 1 + static_cast<int>(random() % 7);
      if (hidden > 0) {
        --hidden;
        continue;
      }
      const int column = static_cast<int>(rightwards ? x : kColumns - 1e-9 - x);
      Put(maps, frame, column, static_cast<int>(row), static_cast<float>(uniform(0.7, 1)));
    }
  }
  for (float& q : maps.values) {
    // No two ways cost the same: the optimum is one.
    if (q < 0.5F) q = static_cast<float>(uniform(0.001, 0.004));
  }
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    if (uniform(0, 1) < 0.5) {
      Put(maps, frame, static_cast<int>(random() % kColumns), static_cast<int>(random() % kRows),
          0.8F);
    }
  }
  return maps;
}

/// With the default a path is begun only when it earns 45 within the lag.
constexpr double kLittle = 5;

/// What a stream gave out: the rows, and with each the number of maps added before.
struct Played {
  std::vector<TrackRow> rows;
  std::vector<std::int64_t> maps_added;
  LiveReport report;

  Tracks ToTracks() const {
    Tracks tracks;
    for (const TrackRow& row : rows) {
      const auto index = static_cast<std::size_t>(row.track) - 1;
      if (index >= tracks.size()) tracks.resize(index + 1);
      tracks[index].id = row.track;
      tracks[index].points.push_back(row.point);
    }
    return tracks;
  }
};

Played Play(const OccupancyMaps& maps, double lag_secs, const TrackOptions& options = {},
            const LinkingOptions& linking = {}) {
  Played played;
  auto live = LiveTracks::Create(maps, linking, options, lag_secs);
  EXPECT_TRUE(live) << MessageOf(live);
  if (!live) return played;
  const auto keep = [&](const std::vector<TrackRow>& rows) {
    played.rows.insert(played.rows.end(), rows.begin(), rows.end());
    played.maps_added.resize(played.rows.size(), live->report().linking.frames);
  };
  for (std::int64_t frame = 0; frame < maps.frame_count(); ++frame) {
    const auto rows = live->Add(maps.Frame(frame));
    EXPECT_TRUE(rows) << MessageOf(rows);
    if (rows) keep(*rows);
  }
  keep(live->Finish());
  played.report = live->report();
  return played;
}

TEST(LiveTracks, ALagOfTheWholeRecordingGivesWhatTheWholeRecordingGives) {
  int inferred = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    if (seed == 7) continue;  // two optimal answers: an exchange of two people that costs nothing
    const OccupancyMaps maps = Crowd(seed, 2 + static_cast<int>(seed), 90);
    const LinkingOptions linking{.movement_cost = 2, .inside_cost = kInsideCostOfStreams};
    const auto whole = LinkMaps(maps, linking, {});
    ASSERT_TRUE(whole) << MessageOf(whole);
    for (const double lag_secs : {9.0, 500.0}) {
      const Played played = Play(maps, lag_secs, {}, linking);
      EXPECT_EQ(played.ToTracks(), whole->tracks) << seed;
      EXPECT_NEAR(played.report.linking.cost, whole->report.linking.cost, 1e-9);
      EXPECT_EQ(played.report.linking.paths, whole->report.linking.paths);
      EXPECT_EQ(played.report.tracks, std::ssize(whole->tracks));
      EXPECT_EQ(played.report.positions, std::ssize(played.rows));
      inferred += static_cast<int>(played.report.inferred);
    }
  }
  EXPECT_GT(inferred, 50) << "or the stretches between are not looked at";
}

TEST(LiveTracks, PositionsComeAFixedLagAfterTheirFrameAndInOrder) {
  const OccupancyMaps maps = Crowd(3, 9, 120);
  for (const int lag_frames : {1, 2, 4, 13, 40}) {
    const Played played = Play(maps, lag_frames / 10.0, {.min_length_secs = 0.2},
                               {.birth_cost = 0, .movement_cost = 2});
    EXPECT_EQ(played.report.lag_frames, lag_frames);
    EXPECT_EQ(played.report.linking.final_frames, 120);
    EXPECT_GT(played.rows.size(), 100u) << lag_frames;
    std::set<TrackId> known;
    for (std::size_t i = 0; i < played.rows.size(); ++i) {
      const TrackRow& row = played.rows[i];
      const FrameIndex frame = row.point.frame - maps.first_frame;
      EXPECT_EQ(played.maps_added[i], std::min<std::int64_t>(frame + lag_frames + 1, 120));
      if (i > 0) {
        const TrackRow& before = played.rows[i - 1];
        EXPECT_LT(std::pair(before.point.frame, before.track),
                  std::pair(row.point.frame, row.track));
      }
      if (known.insert(row.track).second) {
        EXPECT_EQ(row.track, TrackId{std::ssize(known)});
      }
    }
    // Nobody jumps: an id stays with one person. At most a cell per frame, and the centres of mass
    // of 3 x 3 cells are at most a cell off at both ends.
    for (const Track& track : played.ToTracks()) {
      for (std::size_t i = 1; i < track.points.size(); ++i) {
        const TrackPoint& a = track.points[i - 1];
        const TrackPoint& b = track.points[i];
        const double limit_m = 0.5 * (static_cast<double>(b.frame - a.frame) + 2);
        EXPECT_LE(std::abs(b.x_m - a.x_m), limit_m);
        EXPECT_LE(std::abs(b.y_m - a.y_m), limit_m);
      }
    }
  }
}

TEST(LiveTracks, WithEnoughLagAPersonAloneIsAsInTheWholeRecording) {
  OccupancyMaps maps = EmptyMaps(90);
  for (int frame = 5; frame < 85; ++frame) {
    if (frame % 11 < 8) Put(maps, frame, (frame - 5) * 3 / 10, 6);  // gaps of 3 frames
  }
  const auto whole = LinkMaps(maps, {.inside_cost = kInsideCostOfStreams}, {});
  ASSERT_TRUE(whole);
  ASSERT_EQ(whole->tracks.size(), 1u);
  // The smoothing needs 7 frames, the minimal length 10 of every 11, both known after 14.
  EXPECT_EQ(Play(maps, 1.5).ToTracks(), whole->tracks);
  // With less the window is cut, and the positions are not the same, but near.
  const Tracks cut = Play(maps, 0.4, {.min_length_secs = 0}).ToTracks();
  ASSERT_EQ(cut.size(), 1u);
  ASSERT_EQ(cut[0].points.size(), whole->tracks[0].points.size());
  double worst_m = 0;
  for (std::size_t i = 0; i < cut[0].points.size(); ++i) {
    EXPECT_EQ(cut[0].points[i].frame, whole->tracks[0].points[i].frame);
    EXPECT_EQ(cut[0].points[i].inferred, whole->tracks[0].points[i].inferred);
    worst_m = std::max(worst_m, std::abs(cut[0].points[i].x_m - whole->tracks[0].points[i].x_m));
  }
  EXPECT_GT(worst_m, 0);
  EXPECT_LT(worst_m, 0.5);
}

TEST(LiveTracks, AGapLongerThanTheLagHasPositionsOnlyOnceItsEndIsKnown) {
  OccupancyMaps maps = EmptyMaps(70);
  for (int frame = 0; frame < 70; ++frame) {
    // Stands still in the middle; not seen from frame 30 to 41.
    if (frame < 30 || frame >= 42) Put(maps, frame, 12, 7);
  }
  const Played played = Play(maps, 0.5, {.smoothing_secs = 0, .min_length_secs = 0});
  const Tracks tracks = played.ToTracks();
  ASSERT_EQ(tracks.size(), 1u) << "the id is kept";
  for (const TrackPoint& point : tracks[0].points) {
    const FrameIndex frame = point.frame - maps.first_frame;
    EXPECT_FALSE(frame >= 30 && frame < 37) << frame;
    EXPECT_EQ(point.inferred, frame >= 37 && frame < 42) << frame;
  }
  EXPECT_EQ(tracks[0].points.size(), 70u - 7u);
  EXPECT_EQ(played.report.inferred, 5);
  // With a lag that covers it, all is as in the whole recording.
  EXPECT_EQ(Play(maps, 2, {.smoothing_secs = 0, .min_length_secs = 0}).report.inferred, 12);
}

TEST(LiveTracks, ShortTracksAreNotShownAndLongOnesFromWhereTheyAreKnownToBeLong) {
  OccupancyMaps maps = EmptyMaps(80);
  for (int frame = 0; frame < 9; ++frame) Put(maps, frame, 6, 7);
  for (int frame = 20; frame < 80; ++frame) {
    // In over the right border, 4 frames later in the area.
    Put(maps, frame, std::max(kColumns - 1 - (frame - 20) / 2, 10), 4);
  }
  const TrackOptions options = {.smoothing_secs = 0, .min_length_secs = 1.5};
  const auto first_of = [&](double lag_secs) -> FrameIndex {
    const Tracks tracks = Play(maps, lag_secs, options, {.birth_cost = kLittle}).ToTracks();
    EXPECT_EQ(tracks.size(), 1u) << lag_secs;
    return tracks.empty() ? -1 : tracks[0].points.front().frame - maps.first_frame;
  };
  EXPECT_EQ(first_of(10), 24) << "in the area from frame 24 on";
  EXPECT_EQ(first_of(1.4), 24) << "15 frames are known with it";
  EXPECT_EQ(first_of(0.5), 24 + 14 - 5);
  EXPECT_EQ(first_of(0), 24 + 14 - 1) << "one frame at least";
}

TEST(LiveTracks, RefusesWhatItCannotDo) {
  const OccupancyMaps maps = EmptyMaps(3);
  const auto message = [&](double lag_secs, const LinkingOptions& linking = {},
                           const TrackOptions& tracks = {}) {
    return MessageOf(LiveTracks::Create(maps, linking, tracks, lag_secs));
  };
  EXPECT_THAT(message(-1), HasSubstr("the lag is -1 s; it must be between 0"));
  EXPECT_THAT(message(std::numeric_limits<double>::quiet_NaN()), HasSubstr("the lag is nan s"));
  EXPECT_THAT(message(1e9), HasSubstr("the lag is"));
  EXPECT_THAT(message(1, {.depth = 11}), HasSubstr("linking.depth is 11"));
  EXPECT_THAT(message(1, {.max_paths = 3}), HasSubstr("max_paths"));
  EXPECT_THAT(message(1, {}, {.support = 0}), HasSubstr("tracks.support is 0"));
  OccupancyMaps still = EmptyMaps(1);
  still.frames_per_second = 0;
  EXPECT_THAT(MessageOf(LiveTracks::Create(still, {}, {}, 1)), HasSubstr("frames per second"));
  still.frames_per_second = 1e300;
  EXPECT_EQ(MessageOf(LiveTracks::Create(still, {}, {}, 1)), "");
}

TEST(LiveTracks, AFailedMapChangesNothing) {
  const OccupancyMaps maps = Crowd(5, 6, 60);
  auto live = LiveTracks::Create(maps, {}, {}, 0.8);
  ASSERT_TRUE(live);
  std::vector<TrackRow> rows;
  for (std::int64_t frame = 0; frame < 60; ++frame) {
    std::vector<float> wrong(maps.Frame(frame).begin(), maps.Frame(frame).end());
    EXPECT_FALSE(live->Add(std::span(wrong).subspan(1)));
    wrong[5] = std::nanf("");
    EXPECT_THAT(MessageOf(live->Add(wrong)), HasSubstr("nan"));
    const auto added = live->Add(maps.Frame(frame));
    ASSERT_TRUE(added) << MessageOf(added);
    rows.insert(rows.end(), added->begin(), added->end());
  }
  const std::vector<TrackRow> last = live->Finish();
  rows.insert(rows.end(), last.begin(), last.end());
  EXPECT_EQ(rows, Play(maps, 0.8).rows);
}

TEST(LiveTracks, AnEmptyStreamEnds) {
  auto live = LiveTracks::Create(EmptyMaps(0), {}, {}, 1);
  ASSERT_TRUE(live);
  EXPECT_THAT(live->Finish(), IsEmpty());
  EXPECT_EQ(live->report().positions, 0);
}

}  // namespace
}  // namespace vantage
