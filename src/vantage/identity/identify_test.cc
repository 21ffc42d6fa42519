// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/identify.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "vantage/base/test_support.h"
#include "vantage/identity/test_people.h"

namespace vantage {
namespace {

using testing::Draws;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::MessageOf;

constexpr std::int64_t kFrames = 300;
constexpr std::int64_t kCrossing = 100;  // where they stand side by side
constexpr double kFramesPerSecond = 5;

/// Cells of 20 cm; somebody is where a path is.
OccupancyMaps MapsOf(const std::vector<LinkedPath>& paths) {
  OccupancyMaps maps;
  maps.grid = {.min_x_m = 0, .min_y_m = 0, .cell_m = 0.2, .columns = 40, .rows = 30};
  maps.frames_per_second = kFramesPerSecond;
  const auto cells = static_cast<std::size_t>(maps.grid.count());
  maps.visible.assign(cells, 1);
  maps.in_area.assign(cells, 1);
  maps.values.assign(cells * kFrames, 0);
  for (const LinkedPath& path : paths) {
    for (std::size_t step = 0; step < path.cells.size(); ++step) {
      const auto frame = static_cast<std::size_t>(path.first_frame) + step;
      maps.values[frame * cells + static_cast<std::size_t>(path.cells[step])] = 0.9F;
    }
  }
  return maps;
}

/// Stands at column 5, walks to column 35 around `kCrossing` and stays there; or the other way.
LinkedPath Crossing(int row, bool to_the_right) {
  LinkedPath path;
  for (std::int64_t frame = 0; frame < kFrames; ++frame) {
    const int walked = static_cast<int>(std::clamp<std::int64_t>(frame - (kCrossing - 15), 0, 30));
    path.cells.push_back((to_the_right ? 5 + walked : 35 - walked) + 40 * row);
  }
  return path;
}

/// Two pairs who cross, 3 m apart from each other.
std::vector<LinkedPath> People() {
  return {Crossing(5, true), Crossing(7, false), Crossing(20, true), Crossing(22, false)};
}

/// The rest of the first two exchanged, from `kCrossing` on.
std::vector<LinkedPath> Swapped(std::vector<LinkedPath> paths) {
  std::swap_ranges(paths[0].cells.begin() + kCrossing, paths[0].cells.end(),
                   paths[1].cells.begin() + kCrossing);
  return paths;
}

/// What changes how people are seen.
struct Seeing {
  double missing = 0;                   ///< share of the bands of which nothing is known
  bool move = false;                    ///< one cell off, as who is refined to another
  std::vector<float> offsets = {0, 0};  ///< of the colours of each camera
  bool alike = false;                   ///< everybody wears the same
};

/// One of two cameras sees each person at each frame, in whole numbers as OpenCV has them.
Appearances Seen(const std::vector<LinkedPath>& people, const Seeing& seeing = {}) {
  Draws draws(1);
  std::vector<Eigen::VectorXd> clothes;
  for (std::size_t i = 0; i < people.size(); ++i) {
    clothes.push_back(Eigen::VectorXd::Constant(3 * kAppearanceBands, 120) +
                      (seeing.alike ? 0.0 : 12.0) * draws.Normals(3 * kAppearanceBands));
  }
  Appearances appearances;
  for (std::int64_t frame = 0; frame < kFrames; ++frame) {
    for (std::size_t i = 0; i < people.size(); ++i) {
      Appearance seen{.frame = frame, .cell = 0, .camera = draws.Int(0, 1), .colors = {}};
      seen.cell = people[i].cells[static_cast<std::size_t>(frame)] + (seeing.move ? 1 : 0);
      const Eigen::VectorXd noise = 10 * draws.Normals(3 * kAppearanceBands);
      for (std::size_t k = 0; k < seen.colors.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        seen.colors[k] = static_cast<float>(std::round(clothes[i][at] + noise[at])) +
                         seeing.offsets[static_cast<std::size_t>(seen.camera)];
      }
      for (std::size_t band = 0; band < kAppearanceBands; ++band) {
        if (!draws.Chance(seeing.missing)) continue;
        std::fill_n(seen.colors.begin() + static_cast<std::ptrdiff_t>(3 * band), 3,
                    std::numeric_limits<float>::quiet_NaN());
      }
      appearances.push_back(seen);
    }
  }
  return appearances;
}

Identified Identify(const std::vector<LinkedPath>& paths, const Appearances& appearances,
                    const IdentityOptions& options = {}) {
  auto result = IdentifyPeople(paths, MapsOf({}), appearances, options);
  EXPECT_TRUE(result) << MessageOf(result);
  return std::move(result).value_or(Identified());
}

TEST(IdentifyPeople, WhoWereExchangedAreExchangedBack) {
  const auto people = People();
  const Appearances appearances = Seen(people);
  const Identified result = Identify(Swapped(people), appearances);
  EXPECT_EQ(result.paths, people);
  EXPECT_TRUE(result.report.learnt);
  EXPECT_EQ(result.report.appearances, std::ssize(appearances));
  EXPECT_EQ(result.report.meetings, 2);
  ASSERT_EQ(result.report.exchanges.size(), 1U);
  EXPECT_EQ(result.report.exchanges[0].meeting, (Meeting{kCrossing, 0, 1}));
  EXPECT_GT(result.report.exchanges[0].evidence, IdentityOptions().margin);
  EXPECT_GT(result.report.seconds, 0);
}

TEST(IdentifyPeople, WhoAreRightStay) {
  const Identified result = Identify(People(), Seen(People()));
  EXPECT_EQ(result.paths, People());
  EXPECT_TRUE(result.report.learnt);
  EXPECT_THAT(result.report.exchanges, IsEmpty());
}

TEST(IdentifyPeople, ColoursBelongToWhoIsNearest) {
  // The first two always stand side by side, within reach of each other's colours.
  auto people = People();
  for (std::int64_t frame = 0; frame < kFrames; ++frame) {
    const int walked = static_cast<int>(std::clamp<std::int64_t>(frame - (kCrossing - 1), 0, 2));
    people[0].cells[static_cast<std::size_t>(frame)] = 18 + walked + 40 * 5;
    people[1].cells[static_cast<std::size_t>(frame)] = 20 - walked + 40 * 5;
  }
  const Appearances appearances = Seen(people);
  EXPECT_EQ(Identify(people, appearances).paths, people);
  EXPECT_EQ(Identify(Swapped(people), appearances).paths, people);
}

TEST(IdentifyPeople, WithoutColoursEverythingStays) {
  const auto swapped = Swapped(People());
  const Appearances appearances = Seen(People());
  const auto expect_same = [](const Identified& result, const std::vector<LinkedPath>& paths) {
    EXPECT_EQ(result.paths, paths);
    EXPECT_FALSE(result.report.learnt);
    EXPECT_THAT(result.report.exchanges, IsEmpty());
  };
  expect_same(Identify(swapped, appearances, {.appearance = false}), swapped);
  expect_same(Identify(swapped, {}), swapped);
  expect_same(Identify({}, appearances), {});
  expect_same(Identify({swapped[0]}, appearances), {swapped[0]});
  // Nobody is near the paths when they are seen.
  Appearances elsewhere = appearances;
  for (Appearance& seen : elsewhere) seen.cell += 4;
  expect_same(Identify(swapped, elsewhere), swapped);
  elsewhere = appearances;
  for (Appearance& seen : elsewhere) seen.frame += kFrames;
  expect_same(Identify(swapped, elsewhere), swapped);
  // Too few looks for so many colours.
  elsewhere = appearances;
  std::erase_if(elsewhere, [](const Appearance& seen) { return seen.frame % 60 != 0; });
  expect_same(Identify(swapped, elsewhere), swapped);
}

TEST(IdentifyPeople, ThoseWhoLookAlikeAreLeftToLinking) {
  const auto swapped = Swapped(People());
  const Identified result = Identify(swapped, Seen(People(), {.alike = true}));
  EXPECT_EQ(result.paths, swapped);
}

TEST(IdentifyPeople, ColoursOfCamerasDoNotMatter) {
  const Identified plain = Identify(Swapped(People()), Seen(People()));
  const Identified result = Identify(Swapped(People()), Seen(People(), {.offsets = {70, -40}}));
  EXPECT_EQ(result.paths, People());
  ASSERT_EQ(result.report.exchanges.size(), 1U);
  EXPECT_NEAR(result.report.exchanges[0].evidence, plain.report.exchanges[0].evidence, 1e-6);
}

TEST(IdentifyPeople, BandsMayBeMissingAndPeopleACellOff) {
  for (const Seeing& seeing : {Seeing{.missing = 0.4}, Seeing{.move = true},
                               Seeing{.missing = 0.2, .move = true, .offsets = {0, 90}}}) {
    const Identified result = Identify(Swapped(People()), Seen(People(), seeing));
    EXPECT_EQ(result.paths, People());
    ASSERT_EQ(result.report.exchanges.size(), 1U);
    EXPECT_TRUE(std::isfinite(result.report.exchanges[0].evidence));
  }
  // A camera that never saw one band, then nothing known at all.
  Appearances appearances = Seen(People());
  for (Appearance& seen : appearances) {
    if (seen.camera == 1) seen.colors[4] = std::numeric_limits<float>::quiet_NaN();
  }
  EXPECT_EQ(Identify(Swapped(People()), appearances).paths, People());
  for (Appearance& seen : appearances) {
    seen.colors.fill(std::numeric_limits<float>::quiet_NaN());
  }
  EXPECT_FALSE(Identify(Swapped(People()), appearances).report.learnt);
}

TEST(IdentifyPeople, SeveralCamerasAtOnceAreOneLook) {
  // Who is seen twice as often, by two cameras in the same way, is no better known.
  Appearances once = Seen(People());
  for (Appearance& seen : once) seen.camera = 0;
  Appearances twice;
  for (const Appearance& seen : once) {
    twice.push_back(seen);
    twice.push_back(seen);
    twice.back().camera = 1;
  }
  const Identified a = Identify(Swapped(People()), once);
  const Identified b = Identify(Swapped(People()), twice);
  ASSERT_EQ(a.report.exchanges.size(), 1U);
  ASSERT_EQ(b.report.exchanges.size(), 1U);
  EXPECT_EQ(a.report.exchanges[0].evidence, b.report.exchanges[0].evidence);
}

TEST(IdentifyPeople, OptionsDecideWhoMayBeExchanged) {
  const auto swapped = Swapped(People());
  const Appearances appearances = Seen(People());
  EXPECT_EQ(Identify(swapped, appearances, {.distance_m = 0.39}).report.meetings, 0)
      << "they pass each other at 40 cm";
  EXPECT_EQ(Identify(swapped, appearances, {.margin = 1e6}).paths, swapped);
  // As long as an independent look takes, so little one says.
  const double much =
      Identify(swapped, appearances, {.independent_secs = 1}).report.exchanges.at(0).evidence;
  const double little =
      Identify(swapped, appearances, {.independent_secs = 3}).report.exchanges.at(0).evidence;
  EXPECT_GT(much, little);
  for (const double tiny : {1e-3, 1e-300}) {
    EXPECT_EQ(Identify(swapped, appearances, {.independent_secs = tiny}).paths, People()) << tiny;
  }
}

TEST(IdentifyPeople, NamesTheOptionThatIsOutOfRange) {
  const auto message = [](const IdentityOptions& options) {
    return MessageOf(IdentifyPeople({}, MapsOf({}), {}, options));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message({.interval_secs = 0}), HasSubstr("identity.interval is 0"));
  EXPECT_THAT(message({.interval_secs = 61}), HasSubstr("identity.interval is 61"));
  EXPECT_THAT(message({.distance_m = 0}), HasSubstr("identity.distance is 0"));
  EXPECT_THAT(message({.independent_secs = -1}), HasSubstr("identity.independent is -1"));
  EXPECT_THAT(message({.margin = nan}), HasSubstr("identity.margin is nan"));
  EXPECT_THAT(message({.interval_secs = 60}), "");
}

TEST(IdentifyPeople, CanBeStopped) {
  const std::atomic<bool> stop = true;
  EXPECT_THAT(MessageOf(IdentifyPeople(Swapped(People()), MapsOf({}), Seen(People()), {},
                                       {.progress = {}, .stop = &stop})),
              HasSubstr("interrupted"));
}

TEST(LookInterval, IsAtLeastOneFrame) {
  EXPECT_EQ(LookInterval({.interval_secs = 0.2}, 20), 4);
  EXPECT_EQ(LookInterval({.interval_secs = 0.2}, 7), 1);
  EXPECT_EQ(LookInterval({.interval_secs = 0.01}, 7), 1);
}

TEST(IdentifyTracks, MakesTracksAnewWhenSomebodyWasExchanged) {
  const OccupancyMaps maps = MapsOf(People());
  const TrackOptions options;
  LinkMapsResult linked;
  linked.paths = Swapped(People());
  linked.paths.push_back({.first_frame = 3, .cells = {0, 0}});  // nothing supports it
  linked.tracks = BuildTracks(linked.paths, maps, options).value();
  auto people = People();
  people.push_back(linked.paths.back());
  const Tracks expected = BuildTracks(people, maps, options).value();
  ASSERT_EQ(expected.size(), 4U);
  ASSERT_NE(linked.tracks, expected);
  const auto before = linked.paths;

  const auto report = IdentifyTracks(maps, Seen(People()), {}, options, linked);
  ASSERT_TRUE(report) << MessageOf(report);
  EXPECT_EQ(report->exchanges.size(), 1U);
  EXPECT_EQ(linked.tracks, expected);
  EXPECT_EQ(linked.paths, before) << "the optimum";
  EXPECT_EQ(linked.report.dropped_paths, 1);
}

TEST(IdentifyTracks, KeepsTracksWhenNothingChanged) {
  const Tracks given = {{.id = TrackId{42}, .points = {{.frame = 1, .x_m = 2, .y_m = 3}}}};
  LinkMapsResult linked{
      .tracks = given, .paths = People(), .report = {.linking = {}, .dropped_paths = 7}};
  const auto report = IdentifyTracks(MapsOf(People()), Seen(People()), {}, {}, linked);
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->learnt);
  EXPECT_EQ(linked.tracks, given);
  EXPECT_EQ(linked.paths, People());
  EXPECT_EQ(linked.report.dropped_paths, 7);
  EXPECT_THAT(MessageOf(IdentifyTracks(MapsOf(People()), {}, {.margin = 0}, {}, linked)),
              HasSubstr("identity.margin"));
}

}  // namespace
}  // namespace vantage
