// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/authors_pom.h"
#include "bench/occupancy_cases.h"
#include "bench/report.h"
#include "vantage/base/parallel.h"
#include "vantage/base/stopwatch.h"
#include "vantage/occupancy/solver.h"

namespace vantage::bench {
namespace {

using Maps = std::vector<std::vector<float>>;
/// Writes the map of one frame.
using SolveFrame = std::function<void(const OccupancyFrame&, std::span<float>)>;

/// kFast: as users get it; of the authors' example, whose evidence and damping are given, the mode
/// alone. kFastPicture: the fast mode, with its adaptive damping, on the authors' evidence.
enum class Method { kAuthors, kExact, kFast, kFastPicture };

OccupancyOptions OptionsOf(Method method, const OccupancyCase& problem) {
  const OccupancyOptions defaults;
  if (method == Method::kFast && problem.has_truth) return defaults;
  OccupancyOptions options = problem.options;
  if (method == Method::kExact) return options;
  options.mode = SolveMode::kFast;
  if (method == Method::kFastPicture) {
    options.damping = defaults.damping;
    options.tolerance = defaults.tolerance;
    options.stable_iterations = defaults.stable_iterations;
  }
  return options;
}

SolveFrame SolverOf(Method method, const OccupancyCase& problem) {
  if (method == Method::kAuthors) {
    return [authors = AuthorsPom(problem.views, problem.options)](
               const OccupancyFrame& frame, std::span<float> q) { authors.Solve(frame.masks, q); };
  }
  const bool exact = method == Method::kExact;
  const auto solver = std::make_shared<const OccupancySolver>(
      OccupancySolver::Create(exact ? problem.views : problem.fast_views,
                              OptionsOf(method, problem))
          .value());
  return [solver](const OccupancyFrame& frame, std::span<float> q) {
    benchmark::DoNotOptimize(solver->Solve(frame.masks, q).value());
  };
}

Maps RoomFor(const OccupancyCase& problem) {
  return Maps(problem.frames.size(), std::vector<float>(problem.views.front().rectangles.size()));
}

/// Every frame, `threads` of them at a time.
void SolveAll(const OccupancyCase& problem, const SolveFrame& solve, int threads, Maps& maps) {
  ParallelFor(threads, static_cast<std::int64_t>(problem.frames.size()), [&](std::int64_t i) {
    const auto frame = static_cast<std::size_t>(i);
    solve(problem.frames[frame], maps[frame]);
  });
}

std::map<const OccupancyCase*, Maps>& KnownAuthorsMaps() {
  static std::map<const OccupancyCase*, Maps> known;
  return known;
}

/// What the authors' scheme answers; computed where it has not been measured yet.
const Maps& AuthorsMaps(const OccupancyCase& problem) {
  const auto [entry, is_new] = KnownAuthorsMaps().try_emplace(&problem);
  if (is_new) {
    entry->second = RoomFor(problem);
    SolveAll(problem, SolverOf(Method::kAuthors, problem), HardwareThreads(), entry->second);
  }
  return entry->second;
}

/// How far the maps are from the authors': the largest difference, and the cells above one half in
/// one of the two only.
void CountDifferences(const Maps& maps, const Maps& authors, benchmark::State& state) {
  double largest = 0, cells = 0;
  for (std::size_t f = 0; f < maps.size(); ++f) {
    for (std::size_t i = 0; i < maps[f].size(); ++i) {
      const double ours = maps[f][i], theirs = authors[f][i];
      const double difference = std::abs(ours - theirs);
      largest = std::max(largest, std::isnan(difference) ? HUGE_VAL : difference);
      if ((ours > 0.5) != (theirs > 0.5)) ++cells;
    }
  }
  state.counters["max_difference"] = largest;
  state.counters["cells_differ"] = cells;
}

/// Times all frames of a case again and again; the seconds for one frame are counted as such, and
/// as a share of the time between two frames at 20 a second.
double TimePerFrame(const OccupancyCase& problem, const SolveFrame& solve, int threads, Maps& maps,
                    benchmark::State& state) {
  const Stopwatch watch;
  for (auto _ : state) SolveAll(problem, solve, threads, maps);
  const double secs =
      watch.Seconds() / static_cast<double>(state.iterations()) / problem.frames.size();
  state.counters["ms/frame"] = 1e3 * secs;
  state.counters["core_share"] = 20 * secs;
  return secs;
}

void BM_Occupancy(benchmark::State& state, Method method, const OccupancyCase& (*case_of)()) {
  const OccupancyCase& problem = case_of();
  if (!problem.missing.empty()) return state.SkipWithError(problem.missing.c_str());
  const SolveFrame solve = SolverOf(method, problem);
  Maps maps = RoomFor(problem);
  TimePerFrame(problem, solve, static_cast<int>(state.range(0)), maps, state);
  if (problem.has_truth) state.counters["moda"] = Moda(problem, maps);
  if (method == Method::kAuthors) {
    KnownAuthorsMaps()[&problem] = std::move(maps);
    return;
  }
  CountDifferences(maps, AuthorsMaps(problem), state);
  // The two must solve the same problem, or the comparison says nothing.
  if (method == Method::kExact && state.counters["max_difference"] > 1e-4) {
    state.SkipWithError("the exact mode and the authors' scheme disagree");
  }
}

void OnOneAndTwoThreads(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(BM_Occupancy, pom.authors, Method::kAuthors, PomCase)->Apply(OnOneAndTwoThreads);
BENCHMARK_CAPTURE(BM_Occupancy, pom.exact, Method::kExact, PomCase)->Apply(OnOneAndTwoThreads);
BENCHMARK_CAPTURE(BM_Occupancy, pom.fast, Method::kFast, PomCase)->Apply(OnOneAndTwoThreads);
BENCHMARK_CAPTURE(BM_Occupancy, wildtrack.authors, Method::kAuthors, WildtrackCase)
    ->Apply(OnOneAndTwoThreads);
BENCHMARK_CAPTURE(BM_Occupancy, wildtrack.exact, Method::kExact, WildtrackCase)
    ->Apply(OnOneAndTwoThreads);
BENCHMARK_CAPTURE(BM_Occupancy, wildtrack.fast, Method::kFast, WildtrackCase)
    ->Apply(OnOneAndTwoThreads);
BENCHMARK_CAPTURE(BM_Occupancy, arena8.authors, Method::kAuthors, ArenaCase)
    ->Apply(OnOneAndTwoThreads);
BENCHMARK_CAPTURE(BM_Occupancy, arena8.exact, Method::kExact, ArenaCase)->Apply(OnOneAndTwoThreads);
BENCHMARK_CAPTURE(BM_Occupancy, arena8.fast, Method::kFast, ArenaCase)->Apply(OnOneAndTwoThreads);
BENCHMARK_CAPTURE(BM_Occupancy, wildtrack.fast_picture, Method::kFastPicture, WildtrackCase)
    ->Apply(OnOneAndTwoThreads);
BENCHMARK_CAPTURE(BM_Occupancy, arena8.fast_picture, Method::kFastPicture, ArenaCase)
    ->Apply(OnOneAndTwoThreads);

/// The fast mode in the hall; counts the time for one frame divided by `size`.
void TimeArena(const ArenaOptions& options, double size, benchmark::State& state) {
  const OccupancyCase problem = MakeArena(options);
  Maps maps = RoomFor(problem);
  const double secs = TimePerFrame(problem, SolverOf(Method::kFast, problem), 1, maps, state);
  state.counters["us/unit"] = 1e6 * secs / size;
  state.counters["moda"] = Moda(problem, maps);
}

void BM_ArenaCameras(benchmark::State& state) {
  const auto cameras = static_cast<int>(state.range(0));
  TimeArena({.cameras = cameras}, cameras, state);
}
BENCHMARK(BM_ArenaCameras)->Arg(2)->Arg(4)->Arg(8)->UseRealTime()->Unit(benchmark::kMillisecond);

/// The argument is the side of a cell in centimetres.
void BM_ArenaCells(benchmark::State& state) {
  const double cell_m = static_cast<double>(state.range(0)) / 100;
  TimeArena({.cell_m = cell_m}, 1 / (cell_m * cell_m), state);
}
BENCHMARK(BM_ArenaCells)->Arg(100)->Arg(70)->Arg(50)->UseRealTime()->Unit(benchmark::kMillisecond);

/// The argument is the width of the pictures.
void BM_ArenaPixels(benchmark::State& state) {
  const auto width = static_cast<int>(state.range(0));
  const ImageSize size{width, width * 4 / 5};
  TimeArena({.size = size}, 1e-3 * size.width * size.height, state);
}
BENCHMARK(BM_ArenaPixels)
    ->Arg(480)
    ->Arg(960)
    ->Arg(1920)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

bool CompareCase(const std::string& name, const std::vector<std::string>& methods) {
  for (const int threads : {1, 2}) {
    for (const std::string& method : methods) {
      Compare({.name = fmt::format("occupancy.{}.{}.{}t.vs_authors", name, method, threads),
               .ours = fmt::format("BM_Occupancy/{}.{}/{}", name, method, threads),
               .peer = fmt::format("BM_Occupancy/{}.authors/{}", name, threads),
               .peer_name = "the authors' scheme, ignored 0.99",
               .unit = "ms/frame",
               .threads = threads,
               .lower_is_better = true});
    }
  }
  return true;
}

/// Linear growth leaves the time of one unit of size as it is at the smallest.
bool CompareSizes(const std::string& what, const std::string& benchmark, int smallest,
                  std::initializer_list<int> larger) {
  for (const int size : larger) {
    Compare({.name = fmt::format("occupancy.arena8.fast.{}.{}_vs_{}", what, size, smallest),
             .ours = fmt::format("{}/{}", benchmark, size),
             .peer = fmt::format("{}/{}", benchmark, smallest),
             .peer_name = "the smallest; 1 is linear growth",
             .unit = "us/unit",
             .threads = 1,
             .lower_is_better = true});
  }
  return true;
}

const bool kCompared = CompareCase("pom", {"exact", "fast"}) &&
                       CompareCase("wildtrack", {"exact", "fast", "fast_picture"}) &&
                       CompareCase("arena8", {"exact", "fast", "fast_picture"}) &&
                       Compare({.name = "occupancy.arena8.core_share_at_20fps",
                                .ours = "BM_Occupancy/arena8.fast/1",
                                .peer_name = "the tenth that it may take",
                                .limit = 0.1,
                                .unit = "core_share",
                                .threads = 1,
                                .lower_is_better = true}) &&
                       CompareSizes("cameras", "BM_ArenaCameras", 2, {4, 8}) &&
                       CompareSizes("cell_cm", "BM_ArenaCells", 100, {70, 50}) &&
                       CompareSizes("width_px", "BM_ArenaPixels", 480, {960, 1920});

}  // namespace
}  // namespace vantage::bench
