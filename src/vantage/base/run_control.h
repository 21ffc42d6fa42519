// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "vantage/base/result.h"

namespace vantage {

/// How a caller follows and stops long work. Both members may be empty.
struct RunControl {
  /// Called from one thread at a time with the units done and the total (0: not known).
  std::function<void(std::int64_t done, std::int64_t total)> progress;
  /// Set by the caller (e.g. on Ctrl-C): the work returns `Cancelled()` soon after, leaving no
  /// output.
  const std::atomic<bool>* stop = nullptr;

  bool Stopped() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }
  void Report(std::int64_t done, std::int64_t total) const {
    if (progress) progress(done, total);
  }
};

inline tl::unexpected<Error> Cancelled() { return Fail("interrupted; no output was written"); }

}  // namespace vantage
