// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "fuzz/driver.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <limits>
#include <new>
#include <optional>
#include <string_view>
#include <thread>

namespace vantage::fuzz {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kHang_secs = 120;

struct Flags {
  std::uint64_t seconds = 10;
  std::uint64_t seed = 1;
  std::uint64_t rounds = std::numeric_limits<std::uint64_t>::max();
};

std::optional<Flags> Parse(int argc, char** argv) {
  Flags flags;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    std::uint64_t* value = name == "--seconds"  ? &flags.seconds
                           : name == "--seed"   ? &flags.seed
                           : name == "--rounds" ? &flags.rounds
                                                : nullptr;
    unsigned long long number = 0;
    char rest = 0;
    if (value == nullptr || i + 1 == argc ||
        std::sscanf(argv[i + 1], "%llu%c", &number, &rest) != 1)
      return std::nullopt;
    *value = number;
  }
  return flags;
}

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What the rounds' process tells its parent, whatever becomes of it.
struct Progress {
  std::atomic<std::uint64_t> rounds{0};
};

int RunRounds(const Flags& flags, const std::function<void(std::uint64_t)>& round,
              Progress& progress) {
  const Clock::time_point start = Clock::now();
  while (progress.rounds < flags.rounds &&
         SecondsSince(start) < static_cast<double>(flags.seconds)) {
    try {
      round(flags.seed + progress.rounds);
    } catch (const std::exception& failure) {
      fmt::print(stderr, "{}\n", failure.what());
      return 1;
    }
    ++progress.rounds;
  }
  return 0;
}

/// Waits for the rounds' end; ends them when one takes too long.
int Watch(pid_t child, const Progress& progress) {
  std::uint64_t rounds = 0;
  Clock::time_point moved = Clock::now();
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (progress.rounds != rounds) {
      rounds = progress.rounds;
      moved = Clock::now();
    } else if (SecondsSince(moved) > kHang_secs) {
      fmt::print(stderr, "a round takes more than {} s\n", kHang_secs);
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      break;
    }
  }
  if (WIFSIGNALED(status)) fmt::print(stderr, "signal {}\n", WTERMSIG(status));
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? 0 : 1;
}

}  // namespace

int Drive(int argc, char** argv, const std::function<void(std::uint64_t)>& round) {
  const std::optional<Flags> flags = Parse(argc, argv);
  if (!flags) {
    fmt::print(stderr, "usage: {} [--seconds N] [--seed S] [--rounds N]\n", argv[0]);
    return 2;
  }
  void* shared =
      mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) return 2;
  Progress& progress = *new (shared) Progress;
  const Clock::time_point start = Clock::now();
  const pid_t child = fork();
  if (child < 0) return 2;
  if (child == 0) return RunRounds(*flags, round, progress);
  const int status = Watch(child, progress);
  if (status != 0) {
    const std::uint64_t seed = flags->seed + progress.rounds;
    fmt::print(stderr, "failed in the round of seed {0}: {1} --seed {0} --rounds 1\n", seed,
               argv[0]);
  }
  fmt::print("{} rounds from seed {} in {:.0f} s\n", progress.rounds.load(), flags->seed,
             SecondsSince(start));
  return status;
}

}  // namespace vantage::fuzz
