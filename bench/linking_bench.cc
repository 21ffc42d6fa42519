// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bench/child_process.h"
#include "bench/report.h"
#include "vantage/linking/lemon_oracle.h"
#include "vantage/linking/linker.h"
#include "vantage/linking/network.h"
#include "vantage/linking/node_store.h"
#include "vantage/linking/sweep.h"
#include "vantage/linking/test_scenes.h"

namespace vantage::bench {
namespace {

using testing::LemonAlgorithm;
using testing::LemonAnswer;
using testing::RecordedScene;
using testing::SceneOptions;

/// A problem that every solver is given.
struct Case {
  Case(const SceneOptions& scene_options, int depth) : scene(scene_options) {
    options.depth = depth;
    options.movement_cost = 2;
  }
  RecordedScene scene;
  LinkingOptions options;
  /// The first solver's answer in units of 2^-20; the others must have the same.
  std::optional<std::int64_t> optimum_units;
};

Case& Room() {
  static Case problem(testing::RoomCase(), 1);
  return problem;
}
Case& Arena() {
  static Case problem(testing::ArenaCase(), 1);
  return problem;
}
Case& Crowd() {
  static Case problem(testing::CrowdCase(), 3);
  return problem;
}

struct Answer {
  std::int64_t cost_units = 0;
  std::int64_t paths = 0;
};

Answer Ours(const Case& problem) {
  const Result<LinkingResult> result = LinkPaths(problem.scene.problem(), problem.options);
  if (!result) throw std::runtime_error(result.error().message);
  return {std::llround(result->report.cost * 1048576.0), result->report.paths};
}

template <LemonAlgorithm kAlgorithm>
Answer Lemon(const Case& problem) {
  const LemonAnswer answer =
      testing::SolveWithLemon(problem.scene.problem(), problem.options, kAlgorithm);
  return {answer.cost_units, answer.paths};
}

/// From the maps to the answer: the graph is built by each solver, its time and memory included;
/// the maps themselves are not. Every solution is a process of its own, whose peak memory is known
/// and which begins with none that somebody else has freed.
void BM_Link(benchmark::State& state, Answer (*solve)(const Case&), Case& (*get)()) {
  Case& problem = get();
  double largest_bytes = 0;
  for (auto _ : state) {
    const Result<ChildRun<Answer>> run = RunInChild<Answer>([&] { return solve(problem); });
    if (!run) return state.SkipWithError(run.error().message.c_str());
    if (!problem.optimum_units) problem.optimum_units = run->value.cost_units;
    if (run->value.cost_units != *problem.optimum_units) {
      return state.SkipWithError(fmt::format("its cost is {} units, another solver's {}",
                                             run->value.cost_units, *problem.optimum_units)
                                     .c_str());
    }
    state.SetIterationTime(run->secs);
    largest_bytes = std::max(largest_bytes, static_cast<double>(run->peak_bytes));
    state.counters["paths"] = static_cast<double>(run->value.paths);
    state.counters["cost"] = static_cast<double>(run->value.cost_units) / 1048576.0;
  }
  state.counters["MB"] = 1e-6 * largest_bytes;
}

struct SweepRun {
  double sweep_secs = 0;
  double link_secs = 0;
};

SweepRun SweepOnce(const Case& problem) {
  const LinkingProblem maps = problem.scene.problem();
  const linking::Network network =
      linking::MakeNetwork(
          {.columns = maps.columns, .rows = maps.rows, .access = maps.access, .obstacle = {}},
          problem.options)
          .value();
  linking::NodeStore nodes(network);
  for (std::int64_t frame = 0; frame < maps.frames; ++frame) {
    nodes.AddFrame(maps.probability.subspan(static_cast<std::size_t>(frame) * network.cells(),
                                            network.cells()));
    nodes.Costs(frame);  // they are kept: the sweep finds them ready
  }
  const double before_secs = ProcessorSeconds();
  linking::Sweep(network, nodes).PassOnce();
  const double swept_secs = ProcessorSeconds();
  Ours(problem);
  return {swept_secs - before_secs, ProcessorSeconds() - swept_secs};
}

/// One pass of dynamic programming over every arc, by the kernel that linking uses, and how many
/// times as long the whole of linking takes.
void BM_LinkSweep(benchmark::State& state) {
  double sweep_secs = 0, link_secs = 0;
  for (auto _ : state) {
    const Result<ChildRun<SweepRun>> run = RunInChild<SweepRun>([] { return SweepOnce(Arena()); });
    if (!run) return state.SkipWithError(run.error().message.c_str());
    state.SetIterationTime(run->value.sweep_secs);
    sweep_secs += run->value.sweep_secs;
    link_secs += run->value.link_secs;
  }
  const auto nodes = static_cast<double>(Arena().scene.probability.size());
  state.counters["ns/node"] = 1e9 * sweep_secs / static_cast<double>(state.iterations()) / nodes;
  state.counters["multiple"] = link_secs / sweep_secs;
}
BENCHMARK(BM_LinkSweep)->Iterations(5)->UseManualTime()->Unit(benchmark::kMillisecond);

/// CostScaling and NetworkSimplex take minutes, 3 to 16 times as long as CapacityScaling
/// (BENCHMARKS.md): they run, and count, when the environment has VANTAGE_BENCH_SLOW.
bool WithSlowPeers() { return std::getenv("VANTAGE_BENCH_SLOW") != nullptr; }

void BM_LinkSlowly(benchmark::State& state, Answer (*solve)(const Case&), Case& (*get)()) {
  if (!WithSlowPeers()) return state.SkipWithError("takes minutes; set VANTAGE_BENCH_SLOW to run");
  BM_Link(state, solve, get);
}

void Often(benchmark::internal::Benchmark* benchmark) {
  benchmark->UseManualTime()->Unit(benchmark::kMillisecond);
}
void Once(benchmark::internal::Benchmark* benchmark) {
  benchmark->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
}

constexpr auto* kCapacityScaling = Lemon<LemonAlgorithm::kCapacityScaling>;
constexpr auto* kCostScaling = Lemon<LemonAlgorithm::kCostScaling>;
constexpr auto* kNetworkSimplex = Lemon<LemonAlgorithm::kNetworkSimplex>;

BENCHMARK_CAPTURE(BM_Link, room.ours, Ours, Room)->Apply(Often);
BENCHMARK_CAPTURE(BM_Link, room.CapacityScaling, kCapacityScaling, Room)->Apply(Once);
BENCHMARK_CAPTURE(BM_LinkSlowly, room.CostScaling, kCostScaling, Room)->Apply(Once);
BENCHMARK_CAPTURE(BM_LinkSlowly, room.NetworkSimplex, kNetworkSimplex, Room)->Apply(Once);
BENCHMARK_CAPTURE(BM_Link, arena.ours, Ours, Arena)->Apply(Often);
BENCHMARK_CAPTURE(BM_Link, arena.CapacityScaling, kCapacityScaling, Arena)->Apply(Once);
BENCHMARK_CAPTURE(BM_LinkSlowly, arena.CostScaling, kCostScaling, Arena)->Apply(Once);
BENCHMARK_CAPTURE(BM_LinkSlowly, arena.NetworkSimplex, kNetworkSimplex, Arena)->Apply(Once);
BENCHMARK_CAPTURE(BM_Link, crowd.ours, Ours, Crowd)->Apply(Often);
BENCHMARK_CAPTURE(BM_Link, crowd.CapacityScaling, kCapacityScaling, Crowd)->Apply(Once);
BENCHMARK_CAPTURE(BM_LinkSlowly, crowd.CostScaling, kCostScaling, Crowd)->Apply(Once);
BENCHMARK_CAPTURE(BM_LinkSlowly, crowd.NetworkSimplex, kNetworkSimplex, Crowd)->Apply(Once);

/// With the fastest of LEMON's algorithms on the case: time, and memory of the same run.
bool CompareCase(const std::string& name) {
  std::vector<Peer> peers = {
      {fmt::format("BM_Link/{}.CapacityScaling", name), "LEMON CapacityScaling"}};
  if (WithSlowPeers()) {
    for (const std::string algorithm : {"CostScaling", "NetworkSimplex"}) {
      peers.push_back({fmt::format("BM_LinkSlowly/{}.{}", name, algorithm), "LEMON " + algorithm});
    }
  }
  const std::string ours = fmt::format("BM_Link/{}.ours", name);
  return Compare({.name = fmt::format("linking.{}.1t.vs_lemon", name),
                  .ours = ours,
                  .peers = peers,
                  .unit = "ms",
                  .threads = 1}) &&
         Compare({.name = fmt::format("linking.{}.memory.vs_lemon", name),
                  .ours = ours,
                  .peers = peers,
                  .best_in = "ms",
                  .unit = "MB",
                  .threads = 1,
                  .lower_is_better = true});
}

const bool kCompared = CompareCase("room") && CompareCase("arena") && CompareCase("crowd") &&
                       Compare({.name = "linking.arena.multiple_of_sweep",
                                .ours = "BM_LinkSweep",
                                .peer_name = "10 sweeps",
                                .limit = 10,
                                .unit = "multiple",
                                .threads = 1,
                                .lower_is_better = true});

}  // namespace
}  // namespace vantage::bench
