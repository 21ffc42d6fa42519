// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bench/child_process.h"
#include "bench/linking_cases.h"
#include "bench/report.h"
#include "vantage/linking/stream_linker.h"

// Linking as the frames come, one second behind: an hour of the hall, simulated on the fly.

namespace vantage::bench {
namespace {

constexpr std::int64_t kLag_frames = 20;
constexpr std::int64_t kMinute_frames = 1200;
/// Of the hour, where the whole-sequence optimum is sought too.
constexpr std::int64_t kBeginning_frames = 2000;

template <class T>
T ValueOf(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

/// In these maps people are seen up to half a cell off, anew in every frame, and so seem to move
/// all the time: a lower cost of movement than the default serves better, chosen by BM_LinkNoise's
/// sweep on another recording.
LinkingOptions HallOptions() { return {.depth = 1, .movement_cost = 0.5}; }

StreamLinker MakeLinker(const testing::SceneOptions& options,
                        std::span<const std::uint8_t> access) {
  return ValueOf(StreamLinker::Create(
      {.columns = options.columns, .rows = options.rows, .access = access, .obstacle = {}},
      HallOptions(), kLag_frames));
}

// --- An hour -------------------------------------------------------------------------------------

/// Positions of people or of paths in a recording.
class PositionLog {
 public:
  /// Touches its memory, so that keeping positions adds nothing to the peak that is measured later.
  explicit PositionLog(std::size_t capacity) { entries_.resize(capacity); }

  void Add(std::int64_t id, FrameIndex frame, double column, double row) {
    if (size_ == entries_.size()) throw std::length_error("more positions than expected");
    entries_[size_++] = {id, frame, column * kSceneCell_m, row * kSceneCell_m};
  }
  void AddCell(std::int64_t id, FrameIndex frame, CellIndex cell, int columns) {
    const CellIndex column = cell % columns, row = cell / columns;
    Add(id, frame, column + 0.5, row + 0.5);
  }
  void Add(const StreamFrame& frame, int columns) {
    for (const StreamPosition& position : frame.positions) {
      AddCell(position.path, frame.frame, position.cell, columns);
    }
  }

  Tracks ToTracks() const {
    std::map<std::int64_t, Track> by_id;
    for (std::size_t i = 0; i < size_; ++i) {
      const Entry& entry = entries_[i];
      by_id[entry.id].points.push_back({.frame = entry.frame, .x_m = entry.x_m, .y_m = entry.y_m});
    }
    Tracks tracks;
    for (auto& [id, track] : by_id) {
      track.id = TrackId{id};
      tracks.push_back(std::move(track));
    }
    return tracks;
  }

 private:
  struct Entry {
    std::int64_t id = 0;
    FrameIndex frame = 0;
    double x_m = 0, y_m = 0;
  };
  std::vector<Entry> entries_;
  std::size_t size_ = 0;
};

struct HourRun {
  double secs = 0;  ///< of processor time, of the linker alone
  double first_minute_secs = 0;
  double last_minute_secs = 0;
  double slowest_secs = 0;  ///< of one frame
  double peak_mb = 0;
  double mota = 0;
  std::int64_t switches = 0, truth_tracks = 0, paths = 0;
};

HourRun LinkHour() {
  const testing::SceneOptions options = testing::HourCase();
  testing::Scene scene(options);
  const auto positions = static_cast<std::size_t>(options.frames * options.max_people);
  PositionLog truth(positions), results(2 * positions);
  HourRun run;
  const std::int64_t before_bytes = PeakBytes();
  StreamLinker linker = MakeLinker(options, scene.access());
  for (FrameIndex frame = 0; frame < options.frames; ++frame) {
    const testing::SceneFrame& next = scene.Next();
    for (const testing::ScenePerson& person : next.people) {
      truth.Add(person.id + 1, frame, person.column, person.row);
    }
    const double before_secs = ProcessorSeconds();
    const std::optional<StreamFrame> known = ValueOf(linker.Add(next.map));
    const double secs = ProcessorSeconds() - before_secs;
    run.secs += secs;
    run.slowest_secs = std::max(run.slowest_secs, secs);
    if (frame < kMinute_frames) run.first_minute_secs += secs;
    if (frame >= options.frames - kMinute_frames) run.last_minute_secs += secs;
    if (known) results.Add(*known, options.columns);
  }
  for (const StreamFrame& frame : linker.Finish()) results.Add(frame, options.columns);
  run.peak_mb = 1e-6 * static_cast<double>(PeakBytes() - before_bytes);
  const TrackMeasures measures = Evaluate(truth.ToTracks(), results.ToTracks());
  run.mota = measures.mota;
  run.switches = measures.switches;
  run.truth_tracks = measures.truth_tracks;
  run.paths = linker.report().paths;
  return run;
}

void BM_LinkHour(benchmark::State& state) {
  for (auto _ : state) {
    const Result<ChildRun<HourRun>> child = RunInChild<HourRun>(LinkHour);
    if (!child) return state.SkipWithError(child.error().message.c_str());
    const HourRun& run = child->value;
    state.SetIterationTime(run.secs);
    state.counters["MB"] = run.peak_mb;
    state.counters["us/frame_first"] = 1e6 * run.first_minute_secs / kMinute_frames;
    state.counters["us/frame_last"] = 1e6 * run.last_minute_secs / kMinute_frames;
    state.counters["ms_slowest"] = 1e3 * run.slowest_secs;
    state.counters["last_to_first"] = run.last_minute_secs / run.first_minute_secs;
    state.counters["mota"] = run.mota;
    state.counters["switches"] = static_cast<double>(run.switches);
    state.counters["people"] = static_cast<double>(run.truth_tracks);
    state.counters["paths"] = static_cast<double>(run.paths);
  }
}
BENCHMARK(BM_LinkHour)->Iterations(1)->UseManualTime()->Unit(benchmark::kSecond);

// --- Its beginning, live and with hindsight ------------------------------------------------------

struct Beginning {
  Beginning() : scene(Options()), truth(TruthOf(scene.people)) {}
  static testing::SceneOptions Options() {
    testing::SceneOptions options = testing::HourCase();
    options.frames = kBeginning_frames;
    return options;
  }
  testing::RecordedScene scene;
  Tracks truth;
};
const Beginning& TheBeginning() {
  static const Beginning beginning;
  return beginning;
}

PositionLog EmptyLog() {
  return PositionLog(
      static_cast<std::size_t>(2 * kBeginning_frames * Beginning::Options().max_people));
}

struct Linked {
  Tracks tracks;
  double cost = 0;
};

Linked LinkLive(const Beginning& beginning) {
  const testing::RecordedScene& scene = beginning.scene;
  StreamLinker linker = MakeLinker(scene.options, scene.access);
  PositionLog log = EmptyLog();
  const std::size_t cells = scene.access.size();
  for (std::size_t at = 0; at < scene.probability.size(); at += cells) {
    const std::optional<StreamFrame> known =
        ValueOf(linker.Add(std::span(scene.probability).subspan(at, cells)));
    if (known) log.Add(*known, scene.options.columns);
  }
  for (const StreamFrame& frame : linker.Finish()) log.Add(frame, scene.options.columns);
  return {log.ToTracks(), linker.report().cost};
}

Linked LinkWhole(const Beginning& beginning) {
  const LinkingResult result = ValueOf(LinkPaths(beginning.scene.problem(), HallOptions()));
  PositionLog log = EmptyLog();
  const int columns = beginning.scene.options.columns;
  for (std::size_t path = 0; path < result.paths.size(); ++path) {
    FrameIndex frame = result.paths[path].first_frame;
    for (const CellIndex cell : result.paths[path].cells) {
      log.AddCell(static_cast<std::int64_t>(path) + 1, frame++, cell, columns);
    }
  }
  return {log.ToTracks(), result.report.cost};
}

/// Positions are the cells' centres here, both ways.
void BM_LinkLive(benchmark::State& state, Linked (*link)(const Beginning&)) {
  const Beginning& beginning = TheBeginning();
  for (auto _ : state) {
    const double before_secs = ProcessorSeconds();
    const Linked linked = link(beginning);
    state.SetIterationTime(ProcessorSeconds() - before_secs);
    const TrackMeasures measures = Evaluate(beginning.truth, linked.tracks);
    state.counters["mota"] = measures.mota;
    state.counters["idf1"] = measures.idf1;
    state.counters["misses"] = static_cast<double>(measures.misses);
    state.counters["false"] = static_cast<double>(measures.false_positives);
    state.counters["switches"] = static_cast<double>(measures.switches);
    state.counters["earned"] = -linked.cost;
  }
}
BENCHMARK_CAPTURE(BM_LinkLive, lag, LinkLive)
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_LinkLive, whole, LinkWhole)
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

const bool kCompared = Compare({.name = "linking.hour.1t.vs_real_time",
                                .ours = "BM_LinkHour",
                                .peer_name = "the hour that it lasts",
                                .limit = 3600,
                                .unit = "s",
                                .threads = 1}) &&
                       Compare({.name = "linking.hour.last_minute_vs_first",
                                .ours = "BM_LinkHour",
                                .peer_name = "as long as in the first minute",
                                .limit = 1,
                                .unit = "last_to_first",
                                .threads = 1,
                                .lower_is_better = true}) &&
                       Compare({.name = "linking.live.mota.vs_whole",
                                .ours = "BM_LinkLive/lag",
                                .peer = "BM_LinkLive/whole",
                                .peer_name = "ours with all frames known",
                                .unit = "mota",
                                .threads = 1}) &&
                       Compare({.name = "linking.live.earned.vs_whole",
                                .ours = "BM_LinkLive/lag",
                                .peer = "BM_LinkLive/whole",
                                .peer_name = "the optimum of 2,000 frames",
                                .unit = "earned",
                                .threads = 1});

}  // namespace
}  // namespace vantage::bench
