// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/linking/stream_linker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "vantage/base/test_support.h"
#include "vantage/linking/test_instances.h"
#include "vantage/linking/test_scenes.h"

namespace vantage {
namespace {

using testing::Blocked;
using testing::EdgeUnits;
using ::testing::HasSubstr;
using testing::Instance;
using testing::MayMove;
using testing::MoveUnits;
using testing::NodeUnits;
using testing::RandomInstance;
using testing::Units;

Instance StreamInstance(unsigned seed, const testing::Limits& limits = {}) {
  Instance instance = RandomInstance(seed, limits);
  instance.options.max_paths = 0;
  // Never, as it is for LinkPaths when nothing is said; a stream has another default.
  if (!instance.options.inside_cost) instance.options.inside_cost = 1e6;
  return instance;
}

StreamLinker MakeLinker(const Instance& instance, std::int64_t lag_frames) {
  Result<StreamLinker> linker = StreamLinker::Create(instance.grid(), instance.options, lag_frames);
  EXPECT_TRUE(linker) << testing::MessageOf(linker);
  return std::move(*linker);
}

/// All frames, in order.
std::vector<StreamFrame> LinkAll(const Instance& instance, StreamLinker& linker) {
  std::vector<StreamFrame> frames;
  for (int frame = 0; frame < instance.frames; ++frame) {
    Result<std::optional<StreamFrame>> result = linker.Add(instance.Map(frame));
    EXPECT_TRUE(result) << testing::MessageOf(result);
    if (result && *result) frames.push_back(std::move(**result));
  }
  for (StreamFrame& frame : linker.Finish()) frames.push_back(std::move(frame));
  return frames;
}

/// The paths that the positions make, ordered as LinkPaths orders them.
std::vector<LinkedPath> PathsOf(const std::vector<StreamFrame>& frames) {
  std::map<PathId, LinkedPath> by_id;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].frame, static_cast<std::int64_t>(i));
    for (const StreamPosition& position : frames[i].positions) {
      LinkedPath& path = by_id[position.path];
      if (path.cells.empty()) path.first_frame = frames[i].frame;
      EXPECT_EQ(path.end_frame(), frames[i].frame) << "path " << position.path << " has a gap";
      path.cells.push_back(position.cell);
    }
  }
  std::vector<LinkedPath> paths;
  for (auto& [id, path] : by_id) {
    EXPECT_EQ(id, std::ssize(paths) + 1);
    paths.push_back(std::move(path));
  }
  return paths;
}

TEST(StreamLinker, WithALagOfTheWholeRecordingIsTheOptimum) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    const Instance instance = StreamInstance(seed);
    StreamLinker linker = MakeLinker(instance, instance.frames);
    const std::vector<LinkedPath> paths = PathsOf(LinkAll(instance, linker));
    const Result<LinkingResult> right = LinkPaths(instance.problem(), instance.options);
    ASSERT_TRUE(right);
    ASSERT_EQ(testing::CheckPaths(instance, paths), Units(right->report.cost));
    ASSERT_EQ(Units(linker.report().cost), Units(right->report.cost));
    ASSERT_EQ(linker.report().paths, std::ssize(paths));
    ASSERT_EQ(linker.report().final_frames, instance.frames);
  }
}

TEST(StreamLinker, WithAnyLagPathsAreLegalAndCostWhatTheReportSays) {
  int worse = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    const Instance instance = StreamInstance(seed);
    StreamLinker linker = MakeLinker(instance, 1 + seed % 4);
    const std::vector<LinkedPath> paths = PathsOf(LinkAll(instance, linker));
    const std::int64_t cost = testing::CheckPaths(instance, paths);
    ASSERT_EQ(cost, Units(linker.report().cost));
    const Result<LinkingResult> right = LinkPaths(instance.problem(), instance.options);
    ASSERT_GE(cost, Units(right->report.cost));
    worse += cost > Units(right->report.cost) ? 1 : 0;
  }
  EXPECT_GT(worse, 50);  // too short a lag does cost something
}

/// What the best continuation costs, by trying them all: every set of disjoint paths through the
/// frames [first, last] in which each of `held` begins one path, without an entry.
std::int64_t BestContinuation(const Instance& instance, int first, int last,
                              const std::vector<CellIndex>& held) {
  struct Path {
    std::uint64_t nodes;
    std::int64_t cost;
    std::uint64_t holds;  // which of `held` it begins at
  };
  const std::int64_t birth = Units(instance.options.birth_cost);
  std::vector<Path> all;
  const std::function<void(int, int, Path)> extend = [&](int frame, int cell, Path path) {
    if (Blocked(instance, cell)) return;
    path.nodes |= std::uint64_t{1} << ((frame - first) * instance.cells() + cell);
    path.cost += NodeUnits(instance, frame, cell);
    if (const auto exit = EdgeUnits(instance, cell, frame == last)) {
      Path ended = path;
      if (frame < last) ended.cost += *exit + birth - birth / 2;
      all.push_back(ended);
    }
    if (frame == last) return;
    for (int to = 0; to < instance.cells(); ++to) {
      if (!MayMove(instance, cell, to)) continue;
      extend(frame + 1, to, {path.nodes, path.cost + MoveUnits(instance, cell, to), path.holds});
    }
  };
  for (int frame = first; frame <= last; ++frame) {
    for (int cell = 0; cell < instance.cells(); ++cell) {
      if (const auto entry = EdgeUnits(instance, cell, frame == 0)) {
        extend(frame, cell, {0, *entry + birth / 2, 0});
      }
    }
  }
  for (std::size_t i = 0; i < held.size(); ++i) {
    extend(first, held[i], {0, 0, std::uint64_t{1} << i});
  }
  const std::uint64_t all_held = (std::uint64_t{1} << held.size()) - 1;
  constexpr std::int64_t kImpossible = std::numeric_limits<std::int64_t>::max() / 2;
  const std::function<std::int64_t(std::size_t, std::uint64_t, std::uint64_t)> best =
      [&](std::size_t from, std::uint64_t taken, std::uint64_t begun) {
        std::int64_t lowest = begun == all_held ? 0 : kImpossible;
        for (std::size_t i = from; i < all.size(); ++i) {
          if ((all[i].nodes & taken) != 0) continue;
          lowest = std::min(lowest,
                            all[i].cost + best(i + 1, taken | all[i].nodes, begun | all[i].holds));
        }
        return lowest;
      };
  return best(0, 0, 0);
}

/// What the paths through the last frames cost so far. Those up to `last_id` began before.
std::int64_t OpenCost(const Instance& instance, const std::vector<StreamFrame>& frames,
                      PathId last_id) {
  const std::int64_t birth = Units(instance.options.birth_cost);
  std::int64_t cost = 0;
  std::map<PathId, CellIndex> before;
  for (const StreamFrame& frame : frames) {
    std::map<PathId, CellIndex> now;
    for (const auto& [path, cell] : frame.positions) {
      cost += NodeUnits(instance, static_cast<int>(frame.frame), cell);
      if (const auto at = before.find(path); at != before.end()) {
        cost += MoveUnits(instance, at->second, cell);
      } else if (path > last_id) {
        cost += birth / 2 + EdgeUnits(instance, cell, frame.frame == 0).value();
      }
      before.erase(path);
      now.emplace(path, cell);
    }
    for (const auto& [path, cell] : before) {  // who ended
      cost += birth - birth / 2 + EdgeUnits(instance, cell, false).value();
    }
    before = std::move(now);
  }
  return cost;
}

TEST(StreamLinker, IsAtEveryMomentTheBestContinuationOfWhatIsFinal) {
  int continued = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    const Instance instance = StreamInstance(seed, {.side = 2, .frames = 7, .depth = 1});
    const int lag_frames = 1 + static_cast<int>(seed % 2);
    StreamLinker linker = MakeLinker(instance, lag_frames);
    for (int frame = 0; frame < instance.frames; ++frame) {
      // Before the frame comes: who goes on from a final frame, and where.
      std::vector<CellIndex> held;
      const std::vector<StreamFrame> before = linker.Tentative();
      if (!before.empty()) {
        for (const StreamPosition& position : before.front().positions) {
          if (position.path <= linker.report().paths) held.push_back(position.cell);
        }
      }
      continued += held.empty() ? 0 : 1;
      const PathId last_id = linker.report().paths;
      const int first = static_cast<int>(linker.report().final_frames);
      const Result<std::optional<StreamFrame>> result = linker.Add(instance.Map(frame));
      ASSERT_TRUE(result);
      // From `first` on: what became final now, and the rest.
      std::vector<StreamFrame> now = linker.Tentative();
      if (*result) now.insert(now.begin(), **result);
      ASSERT_EQ(now.front().frame, first);
      ASSERT_EQ(now.back().frame, frame);
      const std::int64_t rest = OpenCost(instance, now, last_id);
      ASSERT_EQ(rest, BestContinuation(instance, first, frame, held)) << "frame " << frame;
    }
  }
  EXPECT_GT(continued, 100);
}

TEST(StreamLinker, GivesIdsOnceAndKeepsThem) {
  testing::SceneOptions options = testing::ArenaCase();
  options.frames = 300;
  const testing::RecordedScene scene(options);
  const LinkingProblem problem = scene.problem();
  Result<StreamLinker> linker = StreamLinker::Create(
      {.columns = problem.columns, .rows = problem.rows, .access = problem.access, .obstacle = {}},
      {.depth = 1}, 20);
  ASSERT_TRUE(linker);
  const auto cells = static_cast<std::size_t>(problem.columns * problem.rows);
  std::map<PathId, std::pair<std::int64_t, CellIndex>> last;  // frame and cell
  const auto check = [&](const StreamFrame& frame) {
    for (const auto& [path, cell] : frame.positions) {
      const auto before = last.find(path);
      if (before == last.end()) {
        EXPECT_EQ(path, std::ssize(last) + 1);
      } else {
        EXPECT_EQ(before->second.first + 1, frame.frame) << "path " << path;
        const CellIndex from = before->second.second;
        EXPECT_LE(std::abs(from % problem.columns - cell % problem.columns), 1);
        EXPECT_LE(std::abs(from / problem.columns - cell / problem.columns), 1);
      }
      last[path] = {frame.frame, cell};
    }
  };
  std::vector<StreamFrame> expected;
  for (std::size_t frame = 0; frame < 300; ++frame) {
    const auto result = linker->Add(problem.probability.subspan(frame * cells, cells));
    ASSERT_TRUE(result);
    if (*result) check(**result);
    // Paths with a final position are the same path in what is tentative.
    const std::vector<StreamFrame> tentative = linker->Tentative();
    ASSERT_EQ(std::ssize(tentative),
              std::min<std::int64_t>(static_cast<std::int64_t>(frame) + 1, 20));
    for (const StreamPosition& position : tentative.front().positions) {
      if (const auto before = last.find(position.path); before != last.end()) {
        EXPECT_EQ(before->second.first + 1, tentative.front().frame);
      } else {
        EXPECT_GT(position.path, linker->report().paths);
      }
    }
  }
  for (const StreamFrame& frame : linker->Finish()) check(frame);
  EXPECT_GE(std::ssize(last), 12);
  EXPECT_EQ(linker->report().paths, std::ssize(last));
}

TEST(StreamLinker, RefusesWhatIsNotAStream) {
  const std::vector<std::uint8_t> access(6, 1);
  const StreamGrid grid = {.columns = 3, .rows = 2, .access = access, .obstacle = {}};
  EXPECT_THAT(testing::MessageOf(StreamLinker::Create(grid, {}, 0)), HasSubstr("the lag is 0"));
  EXPECT_THAT(testing::MessageOf(StreamLinker::Create(grid, {.max_paths = 2}, 1)),
              HasSubstr("linking.max_paths is 2"));
  EXPECT_THAT(testing::MessageOf(StreamLinker::Create(
                  {.columns = 3, .rows = 3, .access = access, .obstacle = {}}, {}, 1)),
              HasSubstr("access has 6 values; it must have 9"));

  Result<StreamLinker> linker = StreamLinker::Create(grid, {.depth = 1, .birth_cost = 1}, 1);
  ASSERT_TRUE(linker);
  std::vector<float> map(6, 0.01F);
  map[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(testing::MessageOf(linker->Add(map)), HasSubstr("cell 4 in frame 0 is nan"));
  EXPECT_THAT(testing::MessageOf(linker->Add(std::vector<float>(5, 0.0F))),
              HasSubstr("the map of frame 0 has 5 values; it must have 6"));
  EXPECT_EQ(linker->report().frames, 0);
  map[4] = 0.99F;
  ASSERT_TRUE(linker->Add(map));
  const auto result = linker->Add(map);
  ASSERT_TRUE(result && *result);
  EXPECT_THAT((*result)->positions, ::testing::ElementsAre(StreamPosition{.path = 1, .cell = 4}));
}

}  // namespace
}  // namespace vantage
