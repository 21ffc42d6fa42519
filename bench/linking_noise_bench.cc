// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/linking_cases.h"
#include "bench/report.h"
#include "bench/simple_linkers.h"
#include "vantage/base/stopwatch.h"
#include "vantage/linking/link_maps.h"
#include "vantage/occupancy/peaks.h"

// What exactness is worth: the same noisy maps to the exact linker and to two that decide frame by
// frame on the maps' peaks. Each has the options that are best for it on a recording of its own.

namespace vantage::bench {
namespace {

struct NoisyRecording {
  NoisyRecording(std::uint32_t seed, double mean_miss_frames) {
    testing::SceneOptions options = testing::ArenaCase();
    options.seed = seed;
    options.misses = 0.2;
    options.mean_miss_frames = mean_miss_frames;
    options.false_alarms = 1;
    options.position_error = 1;
    const testing::RecordedScene scene(options);
    maps = MapsOf(scene);
    truth = TruthOf(scene.people);
    for (std::int64_t frame = 0; frame < options.frames; ++frame) {
      std::vector<Eigen::Vector2d>& positions_m = detections.emplace_back();
      const std::vector<Peak> peaks = FindPeaks(maps.grid, maps.Frame(frame), {}).value();
      for (const Peak& peak : peaks) positions_m.push_back(peak.position_m);
    }
  }
  OccupancyMaps maps;
  Detections detections;
  Tracks truth;
};

struct NoiseCase {
  explicit NoiseCase(double mean_miss_frames)
      : tuning(11, mean_miss_frames),
        recordings{{12, mean_miss_frames}, {13, mean_miss_frames}, {14, mean_miss_frames}} {}
  NoisyRecording tuning;
  std::vector<NoisyRecording> recordings;
};

/// Misses are independent of each other.
const NoiseCase& Independent() {
  static const NoiseCase noise(1);
  return noise;
}
/// Misses come in runs: as many, but two frames long on average.
const NoiseCase& Runs() {
  static const NoiseCase noise(2);
  return noise;
}

struct Candidate {
  std::string options;
  std::function<Tracks(const NoisyRecording&)> link;
};

std::vector<Candidate> ExactCandidates() {
  std::vector<Candidate> candidates;
  for (const int depth : {1, 2}) {
    for (const double movement_cost : {0.25, 0.5, 1.0, 2.0}) {
      candidates.push_back({fmt::format("depth {}, movement cost {} a cell", depth, movement_cost),
                            [=](const NoisyRecording& recording) {
                              LinkingOptions options;
                              options.depth = depth;
                              options.movement_cost = movement_cost * depth;
                              return LinkMaps(recording.maps, options, {}).value().tracks;
                            }});
    }
  }
  return candidates;
}

std::vector<Candidate> SimpleCandidates(Tracks (*link)(const Detections&, const SimpleOptions&),
                                        const std::vector<double>& accelerations) {
  std::vector<Candidate> candidates;
  for (const double gate_m : {0.75, 1.0, 1.25, 1.5, 2.0}) {
    for (const int max_age_frames : {3, 6, 12, 24}) {
      for (const int min_hits : {3, 6, 12, 20, 30}) {
        for (const double acceleration : accelerations) {
          const SimpleOptions options{.gate_m = gate_m,
                                      .max_age_frames = max_age_frames,
                                      .min_hits = min_hits,
                                      .acceleration = acceleration};
          candidates.push_back({fmt::format("gate {} m, age {}, hits {}, acceleration {}", gate_m,
                                            max_age_frames, min_hits, acceleration),
                                [=](const NoisyRecording& recording) {
                                  return link(recording.detections, options);
                                }});
        }
      }
    }
  }
  return candidates;
}
std::vector<Candidate> GreedyCandidates() { return SimpleCandidates(LinkGreedily, {0}); }
std::vector<Candidate> SortCandidates() {
  return SimpleCandidates(LinkWithKalman, {0.01, 0.03, 0.1});
}

Candidate BestOf(const std::vector<Candidate>& candidates, const NoisyRecording& recording) {
  const auto mota = [&recording](const Candidate& candidate) {
    return Evaluate(recording.truth, candidate.link(recording)).mota;
  };
  Candidate best = candidates.front();
  double best_mota = mota(best);
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const double candidate_mota = mota(candidates[i]);
    if (candidate_mota <= best_mota) continue;
    best = candidates[i];
    best_mota = candidate_mota;
  }
  return best;
}

void BM_LinkNoise(benchmark::State& state, std::vector<Candidate> (*candidates)(),
                  const NoiseCase& (*get)()) {
  const NoiseCase& noise = get();
  const Candidate linker = BestOf(candidates(), noise.tuning);
  state.SetLabel(linker.options);
  for (auto _ : state) {
    double errors = 0, positions = 0, switches = 0, idf1 = 0, secs = 0;
    for (const NoisyRecording& recording : noise.recordings) {
      const Stopwatch stopwatch;
      const Tracks tracks = linker.link(recording);
      secs += stopwatch.Seconds();
      const TrackMeasures measures = Evaluate(recording.truth, tracks);
      switches += static_cast<double>(measures.switches);
      errors += static_cast<double>(measures.misses + measures.false_positives + measures.switches);
      positions += static_cast<double>(measures.truth_positions);
      idf1 += measures.idf1 / static_cast<double>(noise.recordings.size());
    }
    state.SetIterationTime(secs);
    state.counters["mota"] = 1 - errors / positions;
    state.counters["idf1"] = idf1;
    state.counters["switches"] = switches;
  }
}

void Once(benchmark::internal::Benchmark* benchmark) {
  benchmark->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(BM_LinkNoise, independent.ours, ExactCandidates, Independent)->Apply(Once);
BENCHMARK_CAPTURE(BM_LinkNoise, independent.greedy, GreedyCandidates, Independent)->Apply(Once);
BENCHMARK_CAPTURE(BM_LinkNoise, independent.sort, SortCandidates, Independent)->Apply(Once);
BENCHMARK_CAPTURE(BM_LinkNoise, runs.ours, ExactCandidates, Runs)->Apply(Once);
BENCHMARK_CAPTURE(BM_LinkNoise, runs.greedy, GreedyCandidates, Runs)->Apply(Once);
BENCHMARK_CAPTURE(BM_LinkNoise, runs.sort, SortCandidates, Runs)->Apply(Once);

bool CompareWith(const std::string& name, const std::string& noise, const std::string& peer,
                 const std::string& peer_name) {
  for (const std::string measure : {"mota", "idf1", "switches"}) {
    Compare({.name = fmt::format("linking.{}.{}.vs_{}", name, measure, peer),
             .ours = fmt::format("BM_LinkNoise/{}.ours", noise),
             .peer = fmt::format("BM_LinkNoise/{}.{}", noise, peer),
             .peer_name = peer_name,
             .unit = measure,
             .threads = 1,
             .lower_is_better = measure == "switches"});
  }
  return true;
}

bool CompareCase(const std::string& name, const std::string& noise) {
  return CompareWith(name, noise, "greedy", "greedy nearest neighbour") &&
         CompareWith(name, noise, "sort", "Kalman and Hungarian, as SORT");
}

const bool kCompared = CompareCase("noise", "independent") && CompareCase("noise_runs", "runs");

}  // namespace
}  // namespace vantage::bench
