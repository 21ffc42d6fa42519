// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstring>
#include <opencv2/bgsegm.hpp>
#include <opencv2/core.hpp>
#include <opencv2/video/background_segm.hpp>
#include <string>
#include <vector>

#include "bench/report.h"
#include "bench/vtest_frames.h"
#include "vantage/background/mixture.h"
#include "vantage/background/mixture_kernel.h"
#include "vantage/base/parallel.h"

// Cases have two arguments: the width of the frames, which stands for the input, and the threads.

namespace vantage::bench {
namespace {

/// What a step reads and writes of a pixel at least: the fittest Gaussian (20 bytes) both ways, the
/// frame's 3 bytes, the slot and the mask. The other Gaussians are visited for 4 % of the vectors
/// of vtest.avi, another 3 bytes a pixel.
constexpr double kBytesPerPixel = 2 * 20 + 3 + 1 + 1;

ImageSize SizeOf(const benchmark::State& state) {
  return state.range(0) == kVideoSize.width ? kVideoSize : kLargeSize;
}

benchmark::Counter PerSecond(double amount) {
  return {amount, benchmark::Counter::kIsIterationInvariantRate};
}

/// Times `apply(frame, mask)` frame after frame, the models warm from a first round.
template <class Apply>
void RunFrames(benchmark::State& state, const Apply& apply) {
  const std::vector<cv::Mat>& frames = FramesOf(static_cast<int>(state.range(0)));
  if (frames.size() < kFrames) {
    state.SkipWithError("vtest.avi of opencv-doc is not here");
    return;
  }
  cv::Mat mask;
  for (const cv::Mat& frame : frames) apply(frame, mask);
  std::size_t next = 0;
  for (auto _ : state) {
    apply(frames[next], mask);
    benchmark::DoNotOptimize(mask.data);
    next = (next + 1) % kFrames;
  }
  state.counters["Mpixel/s"] = PerSecond(1e-6 * SizeOf(state).width * SizeOf(state).height);
}

void RunOurs(benchmark::State& state, ColorSpace color) {
  MixtureOptions options;
  options.color = color;
  MixtureModel model = MixtureModel::Create(SizeOf(state), options).value();
  const int threads = static_cast<int>(state.range(1));
  RunFrames(state, [&](const cv::Mat& frame, cv::Mat& mask) {
    if (!model.Apply(frame, mask, threads)) state.SkipWithError("the frame was refused");
  });
  state.counters["GB/s"] =
      PerSecond(1e-9 * kBytesPerPixel * SizeOf(state).width * SizeOf(state).height);
}

/// A peer at this learning rate, on as many of OpenCV's threads.
void RunPeer(benchmark::State& state, cv::BackgroundSubtractor& peer, double rate) {
  const int before = cv::getNumThreads();
  cv::setNumThreads(static_cast<int>(state.range(1)));
  RunFrames(state, [&](const cv::Mat& frame, cv::Mat& mask) { peer.apply(frame, mask, rate); });
  cv::setNumThreads(before);
}

void InputsAndThreads(benchmark::internal::Benchmark* cases) {
  cases->ArgsProduct({{kVideoSize.width, kLargeSize.width}, {1, 2}})->UseRealTime();
}

void BM_MixtureRgb(benchmark::State& state) { RunOurs(state, ColorSpace::kRgb); }
BENCHMARK(BM_MixtureRgb)->Apply(InputsAndThreads);

void BM_MixtureLuv(benchmark::State& state) { RunOurs(state, ColorSpace::kLuv); }
BENCHMARK(BM_MixtureLuv)->Apply(InputsAndThreads);

/// The same algorithm: 3 mixtures instead of its default of 5, and our learning rate.
void BM_Mog(benchmark::State& state) {
  RunPeer(state, *cv::bgsegm::createBackgroundSubtractorMOG(200, 3), MixtureOptions().alpha);
}
BENCHMARK(BM_Mog)->Apply(InputsAndThreads);

/// With its defaults.
void BM_Mog2(benchmark::State& state) { RunPeer(state, *cv::createBackgroundSubtractorMOG2(), -1); }
BENCHMARK(BM_Mog2)->Apply(InputsAndThreads);

/// The machine's bandwidth: memcpy between halves of a piece of memory of as many KiB, cut into as
/// many pieces as there are threads.
void BM_Copy(benchmark::State& state) {
  const auto half = static_cast<std::size_t>(state.range(0)) * 1024 / 2;
  const auto threads = static_cast<int>(state.range(1));
  std::vector<char> memory(2 * half, 1);
  const std::size_t piece = half / static_cast<std::size_t>(threads);
  for (auto _ : state) {
    ParallelFor(threads, threads, [&](std::int64_t i) {
      char* from = memory.data() + static_cast<std::size_t>(i) * piece;
      std::memcpy(from + half, from, piece);
    });
    benchmark::ClobberMemory();
  }
  state.counters["GB/s"] = PerSecond(2e-9 * static_cast<double>(half));
}
/// As large as the fittest Gaussians of vtest.avi, which stay in the third cache; far larger than
/// all caches.
constexpr int kStateKiB = kVideoSize.width * kVideoSize.height * 20 / 1024;
constexpr int kLargeKiB = 512 * 1024;
BENCHMARK(BM_Copy)->ArgsProduct({{kStateKiB, kLargeKiB}, {1, 2}})->UseRealTime();

bool CompareInput(const std::string& input, ImageSize size) {
  for (const bool luv : {false, true}) {
    const std::string name = "background." + input + (luv ? ".luv" : "");
    const std::string width = fmt::format("/{}/", size.width);
    const std::string ours = (luv ? "BM_MixtureLuv" : "BM_MixtureRgb") + width;
    const auto compare = [&](int threads, const std::string& with, const std::string& peer,
                             const std::string& peer_name, const std::string& unit) {
      Compare({.name = fmt::format("{}.{}t.vs_{}", name, threads, with),
               .ours = ours + std::to_string(threads),
               .peer = peer,
               .peer_name = peer_name,
               .unit = unit,
               .threads = threads});
    };
    const std::string rate = "Mpixel/s";
    const std::string copy = fmt::format("BM_Copy/{}/", kStateKiB);
    const std::string copy_name = "memcpy within the third cache";
    compare(1, "mog", "BM_Mog" + width + "1", "OpenCV contrib MOG, 3 mixtures", rate);
    compare(1, "mog2", "BM_Mog2" + width + "1", "OpenCV MOG2", rate);
    compare(2, "1t", ours + "1", "ours on 1 thread", rate);
    compare(2, "mog2", "BM_Mog2" + width + "2", "OpenCV MOG2", rate);
    compare(1, "memory", copy + "1", copy_name, "GB/s");
    compare(2, "memory", copy + "2", copy_name, "GB/s");
  }
  return true;
}

/// What all figures hang on, printed above the table.
bool PrintSettings() {
  const MixtureOptions options;
  benchmark::AddCustomContext("background instruction set", MixtureInstructionSet());
  benchmark::AddCustomContext(
      "background settings",
      fmt::format("ours K = {}, alpha = {}, modified rate; MOG 3 mixtures, rate {}; MOG2 defaults",
                  options.gaussians, options.alpha, options.alpha));
  benchmark::AddCustomContext(
      "background input",
      fmt::format("{} frames of vtest.avi {}x{}; mirrored at two edges to {}x{}", kFrames,
                  kVideoSize.width, kVideoSize.height, kLargeSize.width, kLargeSize.height));
  return true;
}

const bool compared =
    CompareInput("vtest", kVideoSize) && CompareInput("960x768", kLargeSize) && PrintSettings();

}  // namespace
}  // namespace vantage::bench
