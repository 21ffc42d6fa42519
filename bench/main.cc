// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/report.h"
#include "vantage/base/file.h"
#include "vantage/base/result.h"

namespace vantage::bench {
namespace {

std::vector<Comparison>& Comparisons() {
  static std::vector<Comparison> comparisons;
  return comparisons;
}

/// Nanoseconds of a unit of time; none for counters.
std::optional<double> Nanoseconds(const std::string& unit) {
  static const std::map<std::string, double> units = {
      {"ns", 1}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}};
  const auto found = units.find(unit);
  return found == units.end() ? std::nullopt : std::optional(found->second);
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

/// Prints Google Benchmark's table and keeps what each case measured.
class Recorder final : public benchmark::ConsoleReporter {
 public:
  Recorder() : ConsoleReporter(::isatty(STDOUT_FILENO) == 1 ? OO_ColorTabular : OO_Tabular) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;  // we take the median ourselves
      std::string name = run.run_name.function_name;
      if (!run.run_name.args.empty()) name += "/" + run.run_name.args;
      if (run.error_occurred) {
        errors_[name] = run.error_message;
        continue;
      }
      Case& measured = cases_[name];
      measured.real_ns.push_back(1e9 * run.real_accumulated_time /
                                 static_cast<double>(run.iterations));
      for (const auto& [counter, value] : run.counters) {
        measured.counters[counter].push_back(value.value);
      }
    }
  }

  /// What a case measured, in `unit`; the median over its repetitions.
  Result<double> Value(const std::string& name, const std::string& unit) const {
    if (const auto error = errors_.find(name); error != errors_.end()) {
      return Fail("case {} was skipped: {}", name, error->second);
    }
    const auto found = cases_.find(name);
    if (found == cases_.end()) return Fail("case {} did not run", name);
    if (const auto ns = Nanoseconds(unit)) return Median(found->second.real_ns) / *ns;
    const auto counter = found->second.counters.find(unit);
    if (counter == found->second.counters.end()) {
      return Fail("case {} has no counter '{}'", name, unit);
    }
    return Median(counter->second);
  }

 private:
  struct Case {
    std::vector<double> real_ns;
    std::map<std::string, std::vector<double>> counters;
  };
  std::map<std::string, Case> cases_;
  std::map<std::string, std::string> errors_;
};

bool LowerIsBetter(const Comparison& comparison) {
  return comparison.lower_is_better || Nanoseconds(comparison.unit);
}

/// The one with whom ours are compared.
Result<Peer> FindPeer(const Comparison& comparison, const Recorder& recorder) {
  if (comparison.peers.empty()) return Peer{comparison.peer, comparison.peer_name};
  const bool own_unit = comparison.best_in.empty();
  const bool least = !own_unit || LowerIsBetter(comparison);
  Peer best;
  double best_value = 0;
  for (const Peer& peer : comparison.peers) {
    VANTAGE_ASSIGN_OR_RETURN(
        const double value,
        recorder.Value(peer.benchmark, own_unit ? comparison.unit : comparison.best_in));
    if (best.name.empty() || (least ? value < best_value : value > best_value)) {
      best = peer;
      best_value = value;
    }
  }
  return best;
}

Result<nlohmann::ordered_json> Evaluate(const Comparison& comparison, const Recorder& recorder) {
  VANTAGE_ASSIGN_OR_RETURN(const double ours, recorder.Value(comparison.ours, comparison.unit));
  VANTAGE_ASSIGN_OR_RETURN(const Peer chosen, FindPeer(comparison, recorder));
  VANTAGE_ASSIGN_OR_RETURN(
      const double peer,
      comparison.limit ? *comparison.limit : recorder.Value(chosen.benchmark, comparison.unit));
  if (!(ours > 0 && peer > 0))
    return Fail("{} and {} must be above 0 {}", ours, peer, comparison.unit);
  const bool lower_is_better = LowerIsBetter(comparison);
  return nlohmann::ordered_json{{"name", comparison.name},
                                {"unit", comparison.unit},
                                {"ours", ours},
                                {"peer", peer},
                                {"peer_name", chosen.name},
                                {"ratio", lower_is_better ? peer / ours : ours / peer},
                                {"threads", comparison.threads}};
}

/// Takes "--bench_json=PATH" out of the arguments; the rest is Google Benchmark's.
std::filesystem::path TakeJsonPath(int& argc, char** argv) {
  constexpr std::string_view kFlag = "--bench_json=";
  std::filesystem::path path;
  int kept = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument.substr(0, kFlag.size()) == kFlag) {
      path = argument.substr(kFlag.size());
    } else {
      argv[kept++] = argv[i];
    }
  }
  argc = kept;
  return path;
}

int Run(int argc, char** argv) {
  const std::filesystem::path json_path = TakeJsonPath(argc, argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  Recorder recorder;
  benchmark::RunSpecifiedBenchmarks(&recorder);

  fmt::print("\n{:<40} {:>12} {:>12} {:<10} {:>7}  {}\n", "comparison", "ours", "peer", "unit",
             "ratio", "peer");
  auto list = nlohmann::ordered_json::array();
  for (const Comparison& comparison : Comparisons()) {
    const auto row = Evaluate(comparison, recorder);
    if (!row) {
      fmt::print("{:<40} left out: {}\n", comparison.name, row.error().message);
      continue;
    }
    fmt::print("{:<40} {:>12.4g} {:>12.4g} {:<10} {:>7.2f}  {}\n", comparison.name,
               (*row)["ours"].get<double>(), (*row)["peer"].get<double>(), comparison.unit,
               (*row)["ratio"].get<double>(), (*row)["peer_name"].get<std::string>());
    list.push_back(*row);
  }
  if (!json_path.empty()) {
    if (Status written = WriteTextFile(json_path, list.dump(2) + "\n"); !written) {
      fmt::print(stderr, "vantage_bench: {}\n", written.error().message);
      return 1;
    }
  }
  return 0;
}

}  // namespace

bool Compare(Comparison comparison) {
  Comparisons().push_back(std::move(comparison));
  return true;
}

}  // namespace vantage::bench

int main(int argc, char** argv) { return vantage::bench::Run(argc, argv); }
