// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <type_traits>

#include "vantage/base/result.h"

namespace vantage::bench {

template <class T>
struct ChildRun {
  T value{};
  /// Of processor time, all threads: what else the machine does matters less than to the wall
  /// clock.
  double secs = 0;
  /// Peak memory in use beyond what the process had at its beginning, touched pages only.
  std::int64_t peak_bytes = 0;
};

/// The most memory that this process ever had in use.
inline std::int64_t PeakBytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{1024} * usage.ru_maxrss;
}

inline double ProcessorSeconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto secs = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return secs(usage.ru_utime) + secs(usage.ru_stime);
}

/// Calls `work` in a child process, a copy of this one.
template <class T, class Work>
Result<ChildRun<T>> RunInChild(const Work& work) {
  static_assert(std::is_trivially_copyable_v<T>, "it goes through a pipe");
  int ends[2];
  if (::pipe(ends) != 0) return Fail("there is no pipe to the child process");
  ::malloc_trim(0);  // freed memory would be used again and not be counted
  const pid_t child = ::fork();
  if (child == 0) {
    ChildRun<T> run;
    const std::int64_t before_bytes = PeakBytes();
    const double before_secs = ProcessorSeconds();
    try {
      run.value = work();
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}\n", error.what());
      ::_exit(1);
    }
    run.secs = ProcessorSeconds() - before_secs;
    run.peak_bytes = PeakBytes() - before_bytes;
    ::_exit(::write(ends[1], &run, sizeof run) == sizeof run ? 0 : 1);
  }
  ::close(ends[1]);
  ChildRun<T> run;
  const bool complete = ::read(ends[0], &run, sizeof run) == sizeof run;
  ::close(ends[0]);
  if (child > 0) ::waitpid(child, nullptr, 0);
  if (!complete) return Fail("the child process failed, perhaps for lack of memory");
  return run;
}

}  // namespace vantage::bench
