// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/flow.h"

#include <gmock/gmock.h>
#include <oneapi/tbb/global_control.h>

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <numeric>
#include <thread>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::ElementsAreArray;
using testing::MessageOf;
using namespace std::chrono_literals;

constexpr std::array kThreads = {1, 2, 3, 8};
constexpr int kCameras = 3;

std::vector<std::int64_t> Numbers(std::int64_t count) {
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// Reading and a second stage with a lane for each camera, a third without order, and one that
/// collects. Counts what each stage has done, and fails the test where a queue is longer or an
/// order other than promised.
class Chain {
 public:
  static constexpr std::int64_t kQueues[] = {2, 3, 4};

  explicit Chain(std::int64_t frames) : frames_(frames) {
    stages_ = {{.lanes = kCameras, .queue = kQueues[0], .work = Work(0)},
               {.lanes = kCameras, .queue = kQueues[1], .work = Work(1)},
               {.in_order = false, .queue = kQueues[2], .work = Work(2)},
               {.work = Work(3)}};
  }

  using Extra = std::function<Result<bool>(std::size_t stage, std::int64_t frame, int lane)>;
  /// Done first by each piece.
  Extra extra;

  std::vector<FlowStage>& stages() { return stages_; }
  Result<FlowReport> Run(int threads, const RunControl& control = {}) {
    return RunFlow(stages_, threads, control);
  }

  std::vector<std::int64_t> collected;
  std::atomic<std::int64_t> pieces = 0;
  std::array<std::array<std::atomic<std::int64_t>, kCameras>, 4> done = {};

 private:
  std::function<Result<bool>(std::int64_t, int)> Work(std::size_t stage) {
    return [this, stage](std::int64_t frame, int lane) -> Result<bool> {
      ++pieces;
      if (extra) {
        VANTAGE_ASSIGN_OR_RETURN(const bool more, extra(stage, frame, lane));
        if (!more) return false;
      }
      if (frame == frames_) return false;
      const auto own = static_cast<std::size_t>(lane);
      if (stage != 2) {
        EXPECT_EQ(done[stage][own], frame) << "in order";
      }
      if (stage == 1) {
        EXPECT_GT(done[0][own], frame);
      } else if (stage == 2) {
        for (const auto& camera : done[1]) EXPECT_GT(camera, frame) << "masks of all cameras";
      }
      if (stage < 3) {
        EXPECT_LT(frame, done[stage + 1][stage == 0 ? own : 0] + kQueues[stage]);
      }
      ++done[stage][own];
      if (stage == 3) collected.push_back(frame);
      return true;
    };
  }

  std::int64_t frames_;
  std::vector<FlowStage> stages_;
  // As many threads as are asked for, also where there are fewer processors.
  tbb::global_control threads_{tbb::global_control::max_allowed_parallelism, 8};
};

TEST(Flow, EachFrameGoesThroughEachStage) {
  for (const int threads : kThreads) {
    Chain chain(200);
    const auto report = chain.Run(threads);
    ASSERT_TRUE(report) << MessageOf(report);
    EXPECT_EQ(report->frames, 200);
    EXPECT_THAT(chain.collected, ElementsAreArray(Numbers(200)));
    EXPECT_EQ(chain.done[2][0], 200);
    EXPECT_EQ(report->stage_secs.size(), 4u);
    EXPECT_GE(report->idle_secs, 0);
  }
}

TEST(Flow, NothingAtAll) {
  for (const int threads : kThreads) {
    Chain chain(0);
    EXPECT_EQ(chain.Run(threads).value().frames, 0);
    EXPECT_EQ(chain.pieces, kCameras) << "each camera says so for itself";
  }
}

TEST(Flow, QueuesFillUpAndNoFurther) {
  Chain chain(100);
  std::mutex mutex;
  std::condition_variable changed;
  std::int64_t begun = 0;  // by the first camera's reading
  // Until the last stage has finished frame 0, that many frames find room.
  constexpr std::int64_t kRoom = Chain::kQueues[0] + Chain::kQueues[1] + Chain::kQueues[2];
  bool full = false;
  chain.extra = [&](std::size_t stage, std::int64_t frame, int lane) -> Result<bool> {
    if (stage == 0 && lane == 0) {
      const std::lock_guard lock(mutex);
      ++begun;
      changed.notify_all();
    }
    if (stage == 3 && frame == 0) {
      std::unique_lock lock(mutex);
      full = changed.wait_for(lock, 20s, [&] { return begun >= kRoom; });
      changed.wait_for(lock, 50ms, [&] { return begun > kRoom; });
      EXPECT_EQ(begun, kRoom);
    }
    return true;
  };
  ASSERT_TRUE(chain.Run(2));
  EXPECT_TRUE(full) << "reading runs ahead";
}

TEST(Flow, WhatComesBackFromTheEndIsWaitedFor) {
  for (const int threads : kThreads) {
    Chain chain(50);
    chain.stages()[1].returned = [](std::int64_t frame) { return frame - frame % 8; };
    chain.extra = [&](std::size_t stage, std::int64_t frame, int) -> Result<bool> {
      if (stage == 1) {
        EXPECT_GE(chain.done[3][0], frame - frame % 8);
        EXPECT_LE(chain.done[3][0], frame);
      }
      return true;
    };
    EXPECT_EQ(chain.Run(threads).value().frames, 50);
  }
}

TEST(Flow, TheFirstErrorCounts) {
  struct Trouble {
    std::size_t stage;
    std::int64_t frame;
    int lane;
    bool is_error;
  };
  struct Case {
    std::vector<Trouble> troubles;
    std::string first;  ///< empty: an end
    std::int64_t frames;
  };
  const std::vector<Case> cases = {
      // Reading is ahead, yet the earlier frame's error counts.
      {{{0, 12, 1, true}, {3, 10, 0, true}}, "stage 3 frame 10 lane 0", 10},
      {{{0, 12, 1, true}, {2, 11, 0, true}, {2, 9, 0, true}}, "stage 2 frame 9 lane 0", 9},
      // In one frame: the earlier stage, errors before ends, the first lane.
      {{{1, 12, 0, true}, {0, 12, 2, true}}, "stage 0 frame 12 lane 2", 12},
      {{{0, 7, 0, false}, {0, 7, 2, true}, {0, 7, 1, true}}, "stage 0 frame 7 lane 1", 7},
      // The recording has ended before the error.
      {{{0, 12, 1, true}, {3, 11, 0, false}}, "", 11},
      {{{0, 12, 1, true}, {0, 11, 2, false}}, "", 11},
  };
  for (const Case& the_case : cases) {
    for (const int threads : kThreads) {
      Chain chain(40);
      chain.extra = [&](std::size_t stage, std::int64_t frame, int lane) -> Result<bool> {
        for (const Trouble& trouble : the_case.troubles) {
          if (std::tuple(stage, frame, lane) !=
              std::tuple(trouble.stage, trouble.frame, trouble.lane)) {
            continue;
          }
          if (trouble.is_error) return Fail("stage {} frame {} lane {}", stage, frame, lane);
          return false;
        }
        return true;
      };
      const auto report = chain.Run(threads);
      if (the_case.first.empty()) {
        ASSERT_TRUE(report) << MessageOf(report);
        EXPECT_EQ(report->frames, the_case.frames);
      } else {
        EXPECT_EQ(MessageOf(report), the_case.first);
      }
      EXPECT_THAT(chain.collected, ElementsAreArray(Numbers(the_case.frames)));
    }
  }
}

TEST(Flow, StopsWhenAsked) {
  for (const int threads : kThreads) {
    Chain chain(1'000'000);
    std::atomic<bool> stop = false;
    chain.extra = [&](std::size_t stage, std::int64_t frame, int) -> Result<bool> {
      if (stage == 3 && frame == 20) stop = true;
      return true;
    };
    EXPECT_EQ(MessageOf(chain.Run(threads, {.progress = {}, .stop = &stop})),
              Cancelled().value().message);
    const std::int64_t pieces = chain.pieces;
    EXPECT_LE(chain.collected.size(), 21u);
    std::this_thread::sleep_for(10ms);
    EXPECT_EQ(chain.pieces, pieces) << "somebody still works";
  }
}

TEST(Flow, ExceptionsReachTheCaller) {
  for (const int threads : kThreads) {
    Chain chain(40);
    chain.extra = [](std::size_t stage, std::int64_t frame, int) -> Result<bool> {
      if (stage == 1 && frame == 5) throw std::bad_alloc();
      return true;
    };
    EXPECT_THROW(static_cast<void>(chain.Run(threads)), std::bad_alloc);
    const std::int64_t pieces = chain.pieces;
    std::this_thread::sleep_for(10ms);
    EXPECT_EQ(chain.pieces, pieces) << "somebody still works";
  }
}

}  // namespace
}  // namespace vantage
