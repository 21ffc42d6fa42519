// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/meetings.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "vantage/identity/test_people.h"

namespace vantage {
namespace {

using testing::Draws;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::RandomWalks;
using testing::WalkGrid;

constexpr GroundGrid kGrid = {.min_x_m = 0, .min_y_m = 0, .cell_m = 0.5, .columns = 100, .rows = 4};

/// Stands in these columns of a row, one frame after another.
LinkedPath Along(std::vector<int> columns, int row, std::int64_t first_frame = 0) {
  LinkedPath path{.first_frame = first_frame, .cells = {}};
  for (const int column : columns) path.cells.push_back(kGrid.Index(column, row));
  return path;
}

/// Squared, in cells: without rounding. None where not both are there.
std::optional<int> SquaredCells(const LinkedPath& a, const LinkedPath& b, const GroundGrid& grid,
                                std::int64_t frame) {
  const std::int64_t in_a = frame - a.first_frame;
  const std::int64_t in_b = frame - b.first_frame;
  if (in_a < 0 || in_b < 0 || in_a >= std::ssize(a.cells) || in_b >= std::ssize(b.cells)) {
    return std::nullopt;
  }
  const CellIndex cell_a = a.cells[static_cast<std::size_t>(in_a)];
  const CellIndex cell_b = b.cells[static_cast<std::size_t>(in_b)];
  const int columns = grid.Column(cell_a) - grid.Column(cell_b);
  const int rows = grid.Row(cell_a) - grid.Row(cell_b);
  return columns * columns + rows * rows;
}

/// As the header says it, of all pairs at all frames.
std::vector<Meeting> PlainMeetings(const std::vector<LinkedPath>& paths, const GroundGrid& grid,
                                   double distance_m, std::int64_t apart, std::int64_t frames) {
  std::vector<Meeting> meetings;
  std::map<std::pair<std::size_t, std::size_t>, std::int64_t> last;
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    for (std::size_t i = 0; i < paths.size(); ++i) {
      for (std::size_t j = i + 1; j < paths.size(); ++j) {
        const auto here = SquaredCells(paths[i], paths[j], grid, frame);
        if (!here || grid.cell_m * std::sqrt(*here) >= distance_m) continue;
        bool is_nearest = frame != paths[i].first_frame && frame != paths[j].first_frame;
        for (std::int64_t other = frame - apart; other <= frame + apart; ++other) {
          const auto there = SquaredCells(paths[i], paths[j], grid, other);
          if (!there || other == frame) continue;
          is_nearest &= *there >= *here;
        }
        const auto before = last.find({i, j});
        if (before != last.end()) is_nearest &= frame - before->second > apart;
        if (!is_nearest) continue;
        meetings.push_back({.frame = frame, .first = i, .second = j});
        last[{i, j}] = frame;
      }
    }
  }
  return meetings;
}

TEST(FindMeetings, AreThoseOfAllPairsAtAllFrames) {
  std::size_t found = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    Draws draws(seed);
    const GroundGrid grid = WalkGrid(draws.Int(2, 12));
    constexpr int kFrames = 80;
    const auto paths = RandomWalks(draws, grid, draws.Int(0, 8), kFrames);
    const double distance_m = 0.3 + 0.3 * draws.Int(0, 12);
    const int apart = draws.Int(1, 12);
    const auto meetings = FindMeetings(paths, grid, distance_m, apart);
    ASSERT_EQ(meetings, PlainMeetings(paths, grid, distance_m, apart, kFrames));
    found += meetings.size();
  }
  EXPECT_GT(found, 3000U);
}

TEST(FindMeetings, WhoCrossOnceMeetOnceWhereTheyAreNearest) {
  std::vector<int> there, back;
  for (int frame = 0; frame < 41; ++frame) {
    there.push_back(frame);
    back.push_back(40 - frame);
  }
  const std::vector<LinkedPath> paths = {Along(there, 1, 7), Along(back, 2, 7)};
  EXPECT_THAT(FindMeetings(paths, kGrid, 1.2, 3),
              ElementsAre(Meeting{.frame = 27, .first = 0, .second = 1}));
  EXPECT_THAT(FindMeetings(paths, kGrid, 0.51, 3), ::testing::SizeIs(1));
  EXPECT_THAT(FindMeetings(paths, kGrid, 0.5, 3), IsEmpty()) << "nearer than, not as near as";
}

TEST(FindMeetings, WhoStandTogetherMeetFromTheFirstMomentOnAgainAndAgain) {
  // From frame 3 to frame 22.
  std::vector<int> comes = {6, 5, 4};
  comes.resize(23, 3);
  comes.insert(comes.end(), {4, 5, 6});
  const std::vector<LinkedPath> paths = {Along(std::vector<int>(26, 2), 0), Along(comes, 0)};
  std::vector<std::int64_t> frames;
  for (const Meeting& meeting : FindMeetings(paths, kGrid, 1.2, 5)) frames.push_back(meeting.frame);
  EXPECT_THAT(frames, ElementsAre(3, 9, 15, 21));
}

TEST(FindMeetings, DependOnTheCellsAndNotOnWhereTheGridLies) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    Draws draws(seed);
    const GroundGrid exact = WalkGrid(12);
    const auto paths = RandomWalks(draws, exact, 6, 80);
    // A fifth of a metre has no exact number, nor have the centres of cells here.
    GroundGrid rounded = exact;
    rounded.cell_m = 0.2;
    rounded.min_x_m = 0.37;
    EXPECT_EQ(FindMeetings(paths, rounded, 4.1 * 0.2, 5), FindMeetings(paths, exact, 4.1 * 0.5, 5));
  }
}

TEST(FindMeetings, WhoWalkSideBySideMeetManyTimes) {
  std::vector<int> steady, swaying;
  const int offsets[] = {2, 3, 1, 0, 2, 3, 3, 2, 1, 2};
  for (int frame = 0; frame < 90; ++frame) {
    steady.push_back(frame);
    swaying.push_back(frame + offsets[frame % 10]);
  }
  const std::vector<LinkedPath> paths = {Along(steady, 1), Along(swaying, 2)};
  for (const int apart : {3, 4, 5, 9}) {
    const auto meetings = FindMeetings(paths, kGrid, 1.2, apart);
    EXPECT_EQ(meetings.size(), apart < 5 ? 18U : 9U) << apart;
    for (std::size_t i = 1; i < meetings.size(); ++i) {
      EXPECT_GT(meetings[i].frame - meetings[i - 1].frame, apart);
    }
  }
}

TEST(FindMeetings, NeverAtTheFirstFrameOfEither) {
  // Nearest when the second appears, and then ever further apart.
  const std::vector<LinkedPath> parting = {Along({5, 5, 5, 5, 5, 5}, 0), Along({6, 7, 8, 9}, 0, 2)};
  EXPECT_THAT(FindMeetings(parting, kGrid, 5, 2), IsEmpty());
  // Nearest at the last frame.
  const std::vector<LinkedPath> meeting = {Along({5, 5, 5, 5, 5, 5}, 0), Along({9, 8, 7, 6}, 0, 2)};
  EXPECT_THAT(FindMeetings(meeting, kGrid, 5, 2),
              ElementsAre(Meeting{.frame = 5, .first = 0, .second = 1}));
}

TEST(FindMeetings, WhoAreNotThereAtTheSameTimeDoNotMeet) {
  const std::vector<LinkedPath> paths = {Along({5, 5, 5}, 0), Along({5, 5, 5}, 0, 3), LinkedPath()};
  EXPECT_THAT(FindMeetings(paths, kGrid, 5, 2), IsEmpty());
  EXPECT_THAT(FindMeetings({}, kGrid, 5, 2), IsEmpty());
}

}  // namespace
}  // namespace vantage
