// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/report.h"
#include "vantage/base/file.h"
#include "vantage/base/stopwatch.h"
#include "vantage/pipeline/flow.h"
#include "vantage/pipeline/mask_stream.h"
#include "vantage/pipeline/track.h"
#include "vantage/scene/scene.h"
#include "vantage/simulation/recording.h"

// The whole way on the simulated floorball: 8 cameras of 960 x 768 px, 20 frames a second, from
// videos to tracks. Cases have one argument, the threads.

namespace vantage::bench {
namespace {

constexpr FrameIndex kFrames = 400;  // 20 s

/// The recording is made once and kept, for as long as the simulator is the same.
Result<Scene> ArenaScene() {
  const std::filesystem::path folder =
      std::filesystem::path(VANTAGE_BINARY_DIR) / "bench-data" /
      fmt::format("floorball-{}-{}", kFrames, VANTAGE_SIMULATION_HASH);
  if (!std::filesystem::exists(folder / "scene.toml")) {
    fmt::print(stderr, "recording {} frames of floorball once, into {}\n", kFrames,
               folder.string());
    VANTAGE_ASSIGN_OR_RETURN(StagedDirectory staged, StagedDirectory::Create(folder, true));
    simulation::RecordOptions options;
    options.preset = "floorball";
    options.stage.frames = kFrames;
    options.masks = false;
    RunControl control;
    control.progress = [](FrameIndex done, FrameIndex total) {
      if (done % 20 == 0) fmt::print(stderr, "  {} of {}\n", done, total);
    };
    VANTAGE_RETURN_IF_ERROR(simulation::RecordScene(options, staged.temporary(), 2, control));
    VANTAGE_RETURN_IF_ERROR(staged.Commit());
  }
  return LoadScene(folder / "scene.toml");
}

/// `sized`: the size of people is given.
const Result<Scene>& Arena(bool sized = false) {
  static const Result<Scene> scene = ArenaScene();
  static const Result<Scene> sized_scene = [] {
    Result<Scene> same = ArenaScene();
    if (same) {
      same->person.width_m = 0.6;
      same->person.height_m = 1.8;
    }
    return same;
  }();
  return sized ? sized_scene : scene;
}

/// Seconds of recording for each second of real time.
void CountRealtime(benchmark::State& state, const Scene& scene, double frames, double secs) {
  state.counters["realtime"] = frames / scene.frames_per_second / secs;
}

void Track(benchmark::State& state, bool sized) {
  if (!Arena(sized)) {
    state.SkipWithError(Arena(sized).error().message.c_str());
    return;
  }
  const Scene& scene = *Arena(sized);
  const int threads = static_cast<int>(state.range(0));
  StageOptions options;
  if (const Status bound = BindStages(scene, options); !bound) {
    state.SkipWithError(bound.error().message.c_str());
    return;
  }
  double frames = 0;
  double secs = 0;
  for (auto _ : state) {
    const auto result = TrackPeople(scene, options, threads);
    if (!result) {
      state.SkipWithError(result.error().message.c_str());
      return;
    }
    const TrackingReport& report = result->report;
    const MapsReport& maps = report.maps;
    frames += static_cast<double>(maps.frames);
    secs += report.total_secs;
    // Shares of the threads' time.
    const double all_secs = report.total_secs * threads;
    state.counters["rehearsal"] = maps.rehearsal_secs * threads / all_secs;
    state.counters["read"] = maps.read_secs / all_secs;
    state.counters["background"] = maps.background_secs / all_secs;
    state.counters["occupancy"] = maps.occupancy_secs / all_secs;
    state.counters["hold"] = maps.hold_secs / all_secs;
    state.counters["idle"] = maps.idle_secs / all_secs;
    state.counters["tracks"] = static_cast<double>(result->tracks.size());
  }
  CountRealtime(state, scene, frames, secs);
}

/// As users get it: the size of people is measured first.
void BM_PipelineArena(benchmark::State& state) { Track(state, false); }

/// With a size that the scene gives.
void BM_PipelineArenaSized(benchmark::State& state) { Track(state, true); }

/// Decoding alone.
void BM_PipelineArenaDecoding(benchmark::State& state) {
  if (!Arena()) {
    state.SkipWithError(Arena().error().message.c_str());
    return;
  }
  double frames = 0;
  double secs = 0;
  for (auto _ : state) {
    const Stopwatch watch;
    auto stream = MaskStream::Create(*Arena(), {}, 1);
    if (!stream) {
      state.SkipWithError(stream.error().message.c_str());
      return;
    }
    MaskStages stages(*stream, 1);
    const FlowStage end{.work = [](std::int64_t, int) -> Result<bool> { return true; }};
    const auto flow = RunFlow(std::vector{stages.Reading(), end}, static_cast<int>(state.range(0)));
    if (!flow) {
      state.SkipWithError(flow.error().message.c_str());
      return;
    }
    frames += static_cast<double>(flow->frames);
    secs += watch.Seconds();
  }
  CountRealtime(state, *Arena(), frames, secs);
}

#define VANTAGE_PIPELINE_BENCHMARK(function) \
  BENCHMARK(function)->Arg(1)->Arg(2)->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond)
VANTAGE_PIPELINE_BENCHMARK(BM_PipelineArena);
VANTAGE_PIPELINE_BENCHMARK(BM_PipelineArenaSized);
VANTAGE_PIPELINE_BENCHMARK(BM_PipelineArenaDecoding);

const bool compared = Compare({.name = "pipeline.arena8.2t.realtime",
                               .ours = "BM_PipelineArena/2",
                               .peer_name = "real time, 20 frames/s",
                               .limit = 1,
                               .unit = "realtime",
                               .threads = 2}) &&
                      Compare({.name = "pipeline.arena8.1t.realtime",
                               .ours = "BM_PipelineArena/1",
                               .peer_name = "real time, 20 frames/s",
                               .limit = 1,
                               .unit = "realtime"}) &&
                      Compare({.name = "pipeline.arena8_sized.2t.realtime",
                               .ours = "BM_PipelineArenaSized/2",
                               .peer_name = "real time, 20 frames/s",
                               .limit = 1,
                               .unit = "realtime",
                               .threads = 2}) &&
                      Compare({.name = "pipeline.arena8_sized.2t.vs_sequential",
                               .ours = "BM_PipelineArenaSized/2",
                               .peer = "BM_PipelineArenaSized/1",
                               .peer_name = "sequential mode",
                               .unit = "realtime",
                               .threads = 2}) &&
                      Compare({.name = "pipeline.arena8_sized.2t.vs_decoding",
                               .ours = "BM_PipelineArenaSized/2",
                               .peer = "BM_PipelineArenaDecoding/2",
                               .peer_name = "decoding alone",
                               .unit = "realtime",
                               .threads = 2});

}  // namespace
}  // namespace vantage::bench
