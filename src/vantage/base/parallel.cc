// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/base/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <map>

namespace vantage {
namespace {

/// Kept from call to call: the workers of an arena stay awake for a moment after its work, whereas
/// those of a new one must be woken, which takes 0.1 ms. One for each number of threads, since
/// calls may be nested; and for each calling thread, so that callers do not share workers.
tbb::task_arena& ArenaOf(int threads) {
  thread_local std::map<int, tbb::task_arena> arenas;
  return arenas.try_emplace(threads, threads).first->second;
}

}  // namespace

void ParallelFor(int threads, std::int64_t count, const std::function<void(std::int64_t)>& body) {
  if (threads <= 1 || count <= 1) {
    for (std::int64_t i = 0; i < count; ++i) body(i);
    return;
  }
  ArenaOf(threads).execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, count, 1),
                      [&](const tbb::blocked_range<std::int64_t>& range) {
                        for (std::int64_t i = range.begin(); i != range.end(); ++i) body(i);
                      });
  });
}

int HardwareThreads() { return tbb::info::default_concurrency(); }

}  // namespace vantage
