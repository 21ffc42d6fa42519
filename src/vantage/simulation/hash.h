// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

/// Internal to the simulation module: random numbers that are functions of what they are for, so
/// that they depend neither on order nor on threads.

namespace vantage::simulation::internal {

/// One round of SplitMix64 (Steele, Lea, Flood, 2014): every bit of the result depends on every
/// bit of x.
constexpr std::uint64_t Mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

/// Hash of a sequence of integers.
template <class... Rest>
constexpr std::uint64_t Hash(std::uint64_t first, Rest... rest) {
  std::uint64_t hash = Mix(first);
  ((hash = Mix(hash ^ static_cast<std::uint64_t>(rest))), ...);
  return hash;
}

/// Hash of `count` objects without padding, on top of `hash`.
template <class T>
std::uint64_t HashObjects(std::uint64_t hash, const T* objects, std::size_t count) {
  static_assert(sizeof(T) % sizeof(std::uint32_t) == 0);
  const auto* bytes = reinterpret_cast<const unsigned char*>(objects);
  hash = Mix(hash ^ count);
  for (std::size_t i = 0; i < count * sizeof(T); i += sizeof(std::uint32_t)) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes + i, sizeof word);
    hash = Mix(hash ^ word);
  }
  return hash;
}

/// Uniform in [0, 1) from the upper and from the lower half of a hash.
constexpr float UpperUnit(std::uint64_t hash) { return static_cast<float>(hash >> 40) * 0x1p-24F; }
constexpr float LowerUnit(std::uint64_t hash) {
  return static_cast<float>((hash >> 8) & 0xffffffU) * 0x1p-24F;
}

}  // namespace vantage::simulation::internal
