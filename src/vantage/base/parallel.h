// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

namespace vantage {

/// Calls body(i) for every i in [0, count), on at most `threads` threads of oneTBB.
/// threads <= 1 runs in order on the caller's thread: the reference path. Bodies must be
/// independent of each other, so that the result never depends on the thread count.
void ParallelFor(int threads, std::int64_t count, const std::function<void(std::int64_t)>& body);

/// Number of processors that this process may use, at least 1.
int HardwareThreads();

}  // namespace vantage
