// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "bench/report.h"
#include "vantage/linking/lemon_oracle.h"
#include "vantage/linking/linker.h"

namespace vantage::bench {
namespace {

/// A room of 28 x 28 cells with a door in the middle of each wall. Four people cross it again and
/// again; one sighting in ten is missed and every other frame has a false one.
struct Room {
  static constexpr int kSide = 28;
  static constexpr int kFrames = 300;
  static constexpr int kPeople = 4;
  static constexpr double kMisses = 0.1;

  std::vector<float> probability = std::vector<float>(std::size_t{kSide} * kSide * kFrames, 0.002F);
  std::vector<std::uint8_t> access = std::vector<std::uint8_t>(std::size_t{kSide} * kSide, 0);
  LinkingOptions options;

  Room() {
    const std::array<Place, 4> doors = {
        {{0, kSide / 2}, {kSide - 1, kSide / 2}, {kSide / 2, 0}, {kSide / 2, kSide - 1}}};
    for (const Place& door : doors) access[Cell(door)] = 1;
    for (int person = 0; person < kPeople; ++person) {
      int frame = 10 * person;
      while (frame < kFrames) {
        const Place& from = doors[Below(4)];
        const Place& to = doors[Below(4)];
        frame = Walk(from, to, frame) + 20;
      }
    }
    for (int frame = 0; frame < kFrames; frame += 2) See(frame, AnyPlace());
  }

  LinkingProblem problem() const {
    return {.columns = kSide,
            .rows = kSide,
            .frames = kFrames,
            .probability = probability,
            .access = access,
            .obstacle = {}};
  }

 private:
  struct Place {
    int x, y;
    friend bool operator==(const Place&, const Place&) = default;
  };

  static std::size_t Cell(const Place& place) {
    return static_cast<std::size_t>(place.x) + static_cast<std::size_t>(place.y) * kSide;
  }
  std::size_t Below(std::size_t count) { return engine_() % count; }
  Place AnyPlace() { return {static_cast<int>(Below(kSide)), static_cast<int>(Below(kSide))}; }
  void See(int frame, const Place& place) {
    const double surety = 1 - std::pow(10, -0.5 - 0.003 * static_cast<double>(Below(1000)));
    probability[static_cast<std::size_t>(frame) * kSide * kSide + Cell(place)] =
        static_cast<float>(surety);
  }

  /// Through a random place in between, one cell a frame; returns the frame after the last.
  int Walk(Place place, const Place& last, int frame) {
    for (const Place& goal : {AnyPlace(), last}) {
      for (; place != goal && frame < kFrames; ++frame) {
        if (Below(1000) >= 1000 * kMisses) See(frame, place);
        place.x += std::clamp(goal.x - place.x, -1, 1);
        place.y += std::clamp(goal.y - place.y, -1, 1);
      }
    }
    return frame;
  }

  std::mt19937 engine_{1};
};

void BM_LinkOurs(benchmark::State& state) {
  const Room room;
  for (auto _ : state) {
    const Result<LinkingResult> result = LinkPaths(room.problem(), room.options);
    if (!result) return state.SkipWithError(result.error().message.c_str());
    state.counters["paths"] = static_cast<double>(result->report.paths);
    state.counters["cost"] = result->report.cost;
  }
}
BENCHMARK(BM_LinkOurs)->UseRealTime()->Unit(benchmark::kMillisecond);

/// The graph is built by each solver, its time included.
void BM_LinkNetworkSimplex(benchmark::State& state) {
  const Room room;
  for (auto _ : state) {
    const testing::LemonAnswer answer = testing::SolveWithLemon(room.problem(), room.options);
    state.counters["paths"] = static_cast<double>(answer.paths);
    state.counters["cost"] = static_cast<double>(answer.cost_units) / 1048576.0;
  }
}
BENCHMARK(BM_LinkNetworkSimplex)->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(1);

const bool compared = Compare({.name = "linking.room300.1t.vs_lemon",
                               .ours = "BM_LinkOurs",
                               .peer = "BM_LinkNetworkSimplex",
                               .peer_name = "LEMON NetworkSimplex",
                               .unit = "ms",
                               .threads = 1});

}  // namespace
}  // namespace vantage::bench
