// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>

/// Random tests until a time is over. A round is all that follows from one seed, so that any round
/// can be run again by itself.

namespace vantage::fuzz {

/// Numbers of one round.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// low..high, both included.
  int Int(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  double Real(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  bool Chance(double probability) { return Real(0, 1) < probability; }
  std::uint64_t Seed() { return engine_(); }

 private:
  std::mt19937_64 engine_;
};

/// Ends the round and the run as failed.
inline void Require(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

/// Understands --seconds N (10), --seed S (1) and --rounds N (no limit) and runs rounds with the
/// seeds S, S + 1, ... in a process of their own. Prints the seed of a round that throws, crashes
/// or takes minutes. The program's exit status.
int Drive(int argc, char** argv, const std::function<void(std::uint64_t seed)>& round);

}  // namespace vantage::fuzz
