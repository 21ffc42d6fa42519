// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

/// How a benchmark file says what its figures are compared with. Ours and the peer are both cases
/// of Google Benchmark, measured in the same run:
///
///   void BM_ProjectOurs(benchmark::State& state) {
///     while (state.KeepRunning()) { ... }
///     state.counters["Mpoint/s"] = benchmark::Counter(
///         1e-6 * kPoints, benchmark::Counter::kIsIterationInvariantRate);
///   }
///   BENCHMARK(BM_ProjectOurs)->UseRealTime();
///   ...
///   const bool compared = Compare({.name = "geometry.project.1t.vs_opencv",
///                                  .ours = "BM_ProjectOurs",
///                                  .peer = "BM_ProjectOpenCv",
///                                  .peer_name = "cv::projectPoints",
///                                  .unit = "Mpoint/s",
///                                  .threads = 1});
///
/// Rates are per second of real time when the case has UseRealTime(), and of this thread's
/// processor time otherwise: every case with more than one thread needs UseRealTime().

namespace vantage::bench {

struct Peer {
  std::string benchmark;  ///< case, as in Comparison
  std::string name;
};

struct Comparison {
  /// Name in bench.json: module.input.threads.vs_peer.
  std::string name;
  /// Cases: function name as given to BENCHMARK, then "/argument" for each argument; modifiers such
  /// as "/real_time" are left away.
  std::string ours;
  std::string peer = {};
  std::string peer_name = {};
  /// Instead of a peer: several, all of which must have run; the best in `best_in` counts.
  std::vector<Peer> peers = {};
  /// A unit of time or a counter of which less is better; empty: `unit`.
  std::string best_in = {};
  /// Instead of a peer: what ours must keep within.
  std::optional<double> limit = std::nullopt;
  /// "ns", "us", "ms" or "s": real time of one iteration. Anything else: the counter of this name.
  std::string unit;
  int threads = 1;
  /// Of a counter (times are better when lower).
  bool lower_is_better = false;
};

/// Registers a comparison; to be called while static variables are initialised. Always true.
bool Compare(Comparison comparison);

}  // namespace vantage::bench
