// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "vantage/linking/linker.h"
#include "vantage/linking/stream_linker.h"

/// For tests only: random linking problems, and what the rules of the problem say of an answer,
/// written down once more and plainly.

namespace vantage::testing {

/// The same numbers from the same seed on every machine.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int Int(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
  }
  double Unit() { return static_cast<double>(engine_()) / 4294967296.0; }
  bool Chance(double p) { return Unit() < p; }

 private:
  std::mt19937 engine_;
};

/// A problem that owns its numbers.
struct Instance {
  int columns = 1;
  int rows = 1;
  int frames = 1;
  std::vector<float> probability;
  std::vector<std::uint8_t> access, obstacle;
  LinkingOptions options;

  int cells() const { return columns * rows; }
  LinkingProblem problem() const;
  StreamGrid grid() const;
  std::span<const float> Map(int frame) const;
};

struct Limits {
  int side = 8;
  int frames = 12;
  int depth = 3;
};

/// Sizes, maps (noise of every strength, sure people with costs at the clip, many ties, rare and
/// weak people), access, obstacles and options, all at random; the depth is
/// given.
Instance RandomInstance(unsigned seed, const Limits& limits = {});

/// Costs in integer units of 2^-20, as they are defined.
std::int64_t Units(double cost);
std::int64_t NodeUnits(const Instance& instance, int frame, int cell);
std::int64_t MoveUnits(const Instance& instance, int from, int to);

bool Access(const Instance& instance, int cell);
/// What a path pays to begin or end at the cell, besides the birth cost; none: it may not.
std::optional<std::int64_t> EdgeUnits(const Instance& instance, int cell, bool free_frame);
bool Blocked(const Instance& instance, int cell);
bool MayMove(const Instance& instance, int from, int to);

/// Checks (with GoogleTest) that the paths are legal and returns what they cost.
std::int64_t CheckPaths(const Instance& instance, const std::vector<LinkedPath>& paths);

}  // namespace vantage::testing
