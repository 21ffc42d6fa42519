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

  /// In [0, 1).
  double Unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// In [low, high).
  double Uniform(double low, double high) { return low + (high - low) * Unit(); }
  /// 0 to count - 1.
  int Below(int count) { return static_cast<int>(Unit() * count); }
  bool Chance(double probability) { return Unit() < probability; }
  /// Whether something that happens `per_sec` times a second happens within this time.
  bool Happens(double per_sec, double seconds) { return Chance(per_sec * seconds); }
  std::uint32_t Seed() { return static_cast<std::uint32_t>(engine_() >> 32); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace vantage::simulation
