// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// Identities of an hour: simulated people who walk about a hall, meet, and are exchanged by linking
// at some of their meetings.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "bench/report.h"
#include "vantage/identity/identify.h"
#include "vantage/identity/meetings.h"
#include "vantage/metrics/clear_mot.h"

namespace vantage::bench {
namespace {

constexpr double kFramesPerSecond = 20;
constexpr int kPeople = 14;
constexpr std::int64_t kLookInterval = 4;
constexpr double kSwitched = 0.05;  // of all meetings

struct Hall {
  OccupancyMaps maps;  ///< without values: identities need the grid and the rate alone
  std::vector<LinkedPath> people;
  std::vector<LinkedPath> linked;
  Appearances appearances;
};

/// Walks towards one random place after another, at up to 3 m/s.
LinkedPath Walk(std::mt19937_64& engine, const GroundGrid& grid, std::int64_t frames) {
  std::uniform_real_distribution<double> unit;
  const auto place = [&]() -> Eigen::Vector2d {
    const double x_m = unit(engine) * grid.columns * grid.cell_m;
    return {x_m, unit(engine) * grid.rows * grid.cell_m};
  };
  Eigen::Vector2d at = place();
  Eigen::Vector2d target = place();
  double step_m = 0.1;
  LinkedPath path;
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    if ((target - at).norm() < step_m) {
      target = place();
      step_m = (0.3 + 2.7 * unit(engine)) / kFramesPerSecond;
    }
    at += step_m * (target - at).normalized();
    path.cells.push_back(grid.CellAt(at).value());
  }
  return path;
}

Hall MakeHall(std::int64_t frames) {
  std::mt19937_64 engine(1);
  std::normal_distribution<float> normal;
  Hall hall;
  hall.maps.grid = {.min_x_m = 0, .min_y_m = 0, .cell_m = 0.3, .columns = 134, .rows = 67};
  hall.maps.frames_per_second = kFramesPerSecond;
  for (int i = 0; i < kPeople; ++i) hall.people.push_back(Walk(engine, hall.maps.grid, frames));
  // Clothes differ as much as light and posture change them, which they do within seconds.
  constexpr float kSpread = 8;
  std::vector<BandColors> clothes(kPeople);
  for (BandColors& colors : clothes) {
    for (float& color : colors) color = 128 + kSpread * normal(engine);
  }
  std::vector<BandColors> light(kPeople);
  for (std::int64_t frame = 0; frame < frames; frame += kLookInterval) {
    for (std::size_t i = 0; i < hall.people.size(); ++i) {
      Appearance& seen = hall.appearances.emplace_back();
      seen.frame = frame;
      seen.cell = hall.people[i].cells[static_cast<std::size_t>(frame)];
      for (std::size_t c = 0; c < seen.colors.size(); ++c) {
        light[i][c] = 0.9F * light[i][c] + std::sqrt(1 - 0.81F) * kSpread * normal(engine);
        seen.colors[c] = clothes[i][c] + light[i][c];
      }
    }
  }
  hall.linked = hall.people;
  std::vector<std::size_t> path_of(kPeople);  // along which path somebody goes now
  std::iota(path_of.begin(), path_of.end(), 0);
  std::uniform_real_distribution<double> unit;
  for (const Meeting& meeting : FindMeetings(hall.people, hall.maps.grid, 1.2, 10)) {
    if (unit(engine) >= kSwitched) continue;
    std::swap(path_of[meeting.first], path_of[meeting.second]);
    auto& first = hall.linked[path_of[meeting.first]].cells;
    auto& second = hall.linked[path_of[meeting.second]].cells;
    std::swap_ranges(first.begin() + meeting.frame, first.end(), second.begin() + meeting.frame);
  }
  return hall;
}

Tracks TracksOf(const std::vector<LinkedPath>& paths, const GroundGrid& grid) {
  Tracks tracks;
  for (const LinkedPath& path : paths) {
    Track& track = tracks.emplace_back();
    track.id = static_cast<TrackId>(tracks.size());
    FrameIndex frame = path.first_frame;
    for (const CellIndex cell : path.cells) {
      const Eigen::Vector2d at = grid.Center(cell);
      track.points.push_back({.frame = frame++, .x_m = at.x(), .y_m = at.y()});
    }
  }
  return tracks;
}

void BM_Identify(benchmark::State& state) {
  const std::int64_t frames =
      state.range(0) * 60 * static_cast<std::int64_t>(std::lround(kFramesPerSecond));
  const Hall hall = MakeHall(frames);
  for (auto _ : state) {
    const auto result = IdentifyPeople(hall.linked, hall.maps, hall.appearances, {});
    if (!result) return state.SkipWithError(result.error().message.c_str());
    state.counters["meetings"] = static_cast<double>(result->report.meetings);
    state.counters["exchanges"] = static_cast<double>(result->report.exchanges.size());
    state.PauseTiming();
    const Tracks truth = TracksOf(hall.people, hall.maps.grid);
    const auto measure = [&](const std::vector<LinkedPath>& paths, const std::string& name) {
      const auto measures = EvaluateTracks(truth, TracksOf(paths, hall.maps.grid), {});
      state.counters["switches" + name] = static_cast<double>(measures.value().switches);
      state.counters["idf1" + name] = measures.value().idf1;
    };
    measure(result->paths, "");
    measure(hall.linked, "_of_linking");
    state.ResumeTiming();
  }
}
BENCHMARK(BM_Identify)
    ->Arg(1)
    ->Arg(10)
    ->Arg(60)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

const bool compared = Compare({.name = "identity.hour.1t.vs_realtime",
                               .ours = "BM_Identify/60",
                               .peer_name = "the hour that it lasts",
                               .limit = 3600,
                               .unit = "s",
                               .threads = 1});

}  // namespace
}  // namespace vantage::bench
