// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <random>

namespace vantage::simulation {

/// Random numbers that are the same with every standard library (the distributions of <random> are
/// not).
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  /// In [low, high).
  double Uniform(double low, double high) {
    constexpr double kStep = 1.0 / 9007199254740992.0;  // 2^-53
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * kStep);
  }
  /// 0 to count - 1.
  int Below(int count) { return static_cast<int>(Uniform(0, count)); }
  bool Chance(double probability) { return Uniform(0, 1) < probability; }
  std::uint32_t Seed() { return static_cast<std::uint32_t>(engine_() >> 32); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace vantage::simulation
