// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <opencv2/bgsegm.hpp>
#include <opencv2/core.hpp>
#include <opencv2/video/background_segm.hpp>
#include <vector>

#include "bench/report.h"
#include "vantage/background/mixture.h"
#include "vantage/video/open.h"

namespace vantage::bench {
namespace {

/// From Debian's package opencv-doc: PETS 2009 S2.L1 View_001, 768x576.
constexpr const char* kVideo = "/usr/share/doc/opencv-doc/examples/data/vtest.avi";
/// Enough that a frame is long out of the caches when its turn comes again.
constexpr std::size_t kFrames = 100;
constexpr double kMegapixels = 768 * 576 * 1e-6;

const std::vector<cv::Mat>& Frames() {
  static const std::vector<cv::Mat> frames = [] {
    std::vector<cv::Mat> read;
    const auto source = OpenVideo(kVideo);
    cv::Mat frame;
    while (source && read.size() < kFrames && (*source)->Read(frame).value_or(false)) {
      read.push_back(frame.clone());
    }
    return read;
  }();
  return frames;
}

/// Times `apply(frame, mask)` frame after frame, the models warm from a first round.
template <class Apply>
void RunFrames(benchmark::State& state, const Apply& apply) {
  const std::vector<cv::Mat>& frames = Frames();
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
  state.counters["Mpixel/s"] =
      benchmark::Counter(kMegapixels, benchmark::Counter::kIsIterationInvariantRate);
}

void RunOurs(benchmark::State& state, ColorSpace color) {
  MixtureOptions options;
  options.color = color;
  MixtureModel model = MixtureModel::Create({768, 576}, options).value();
  const int threads = static_cast<int>(state.range(0));
  RunFrames(state, [&](const cv::Mat& frame, cv::Mat& mask) {
    if (!model.Apply(frame, mask, threads)) state.SkipWithError("the frame was refused");
  });
}

/// The peers with our learning rate, on as many of OpenCV's threads.
void RunPeer(benchmark::State& state, cv::BackgroundSubtractor& peer) {
  const int before = cv::getNumThreads();
  cv::setNumThreads(static_cast<int>(state.range(0)));
  RunFrames(state, [&](const cv::Mat& frame, cv::Mat& mask) {
    peer.apply(frame, mask, MixtureOptions().alpha);
  });
  cv::setNumThreads(before);
}

void BM_MixtureRgb(benchmark::State& state) { RunOurs(state, ColorSpace::kRgb); }
BENCHMARK(BM_MixtureRgb)->Arg(1)->Arg(2)->UseRealTime();

void BM_MixtureLuv(benchmark::State& state) { RunOurs(state, ColorSpace::kLuv); }
BENCHMARK(BM_MixtureLuv)->Arg(1)->Arg(2)->UseRealTime();

/// The same algorithm: 3 mixtures instead of its default of 5.
void BM_Mog(benchmark::State& state) {
  RunPeer(state, *cv::bgsegm::createBackgroundSubtractorMOG(200, 3));
}
BENCHMARK(BM_Mog)->Arg(1)->Arg(2)->UseRealTime();

void BM_Mog2(benchmark::State& state) { RunPeer(state, *cv::createBackgroundSubtractorMOG2()); }
BENCHMARK(BM_Mog2)->Arg(1)->Arg(2)->UseRealTime();

bool CompareWith(const char* name, const char* ours, const char* peer, const char* peer_name,
                 int threads) {
  return Compare({.name = name,
                  .ours = ours,
                  .peer = peer,
                  .peer_name = peer_name,
                  .unit = "Mpixel/s",
                  .threads = threads});
}

const bool compared =
    CompareWith("background.vtest.1t.vs_mog", "BM_MixtureRgb/1", "BM_Mog/1",
                "OpenCV contrib MOG, 3 mixtures", 1) &&
    CompareWith("background.vtest.1t.vs_mog2", "BM_MixtureRgb/1", "BM_Mog2/1", "OpenCV MOG2", 1) &&
    CompareWith("background.vtest.2t.vs_1t", "BM_MixtureRgb/2", "BM_MixtureRgb/1",
                "ours on 1 thread", 2) &&
    CompareWith("background.vtest.2t.vs_mog2", "BM_MixtureRgb/2", "BM_Mog2/2", "OpenCV MOG2", 2) &&
    CompareWith("background.vtest.luv.1t.vs_mog", "BM_MixtureLuv/1", "BM_Mog/1",
                "OpenCV contrib MOG, 3 mixtures", 1) &&
    CompareWith("background.vtest.luv.1t.vs_mog2", "BM_MixtureLuv/1", "BM_Mog2/1", "OpenCV MOG2",
                1) &&
    CompareWith("background.vtest.luv.2t.vs_1t", "BM_MixtureLuv/2", "BM_MixtureLuv/1",
                "ours on 1 thread", 2) &&
    CompareWith("background.vtest.luv.2t.vs_mog2", "BM_MixtureLuv/2", "BM_Mog2/2", "OpenCV MOG2",
                2);

}  // namespace
}  // namespace vantage::bench
