// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <vector>

/// For tests only.

namespace vantage::testing {

/// Every instruction set of Highway that this machine has; the best is chosen again at the end.
class HighwayTargets {
 public:
  HighwayTargets() : targets_(hwy::SupportedAndGeneratedTargets()) {}
  ~HighwayTargets() { ChooseBest(); }
  HighwayTargets(const HighwayTargets&) = delete;
  HighwayTargets& operator=(const HighwayTargets&) = delete;

  std::size_t size() const { return targets_.size(); }
  void Choose(std::size_t i) { Use(targets_[i]); }
  void ChooseBest() { Use(0); }

 private:
  static void Use(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  std::vector<std::int64_t> targets_;
};

}  // namespace vantage::testing
