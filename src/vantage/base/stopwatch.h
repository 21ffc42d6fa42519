// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

namespace vantage {

/// Wall-clock time since it was made, or since the last lap.
class Stopwatch {
 public:
  double Seconds() const { return std::chrono::duration<double>(Clock::now() - last_).count(); }

  /// Adds the time to `sum_secs` and starts anew.
  void LapInto(double& sum_secs) {
    const Clock::time_point now = Clock::now();
    sum_secs += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace vantage
