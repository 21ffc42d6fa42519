// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "bench/report.h"
#include "bench/vtest_frames.h"
#include "vantage/background/ghosts.h"
#include "vantage/background/mixture.h"

// Cases have one argument, the width of the frames, and run on one thread.

namespace vantage::bench {
namespace {

/// The masks of a model that has seen all frames once, and the model.
struct Masks {
  MixtureModel model;
  std::vector<cv::Mat> masks;
};

Masks MasksOf(int width) {
  const std::vector<cv::Mat>& frames = FramesOf(width);
  const ImageSize size = width == kVideoSize.width ? kVideoSize : kLargeSize;
  Masks all{.model = MixtureModel::Create(size, {}).value(), .masks = {}};
  for (int round = 0; round < 2; ++round) {
    all.masks.clear();
    for (const cv::Mat& frame : frames) {
      cv::Mat mask;
      if (!all.model.Apply(frame, mask, 1)) return all;
      all.masks.push_back(mask);
    }
  }
  return all;
}

/// Times `judge(frame, mask, model)` frame after frame.
template <class Judge>
void RunMasks(benchmark::State& state, const Judge& judge) {
  const auto width = static_cast<int>(state.range(0));
  const std::vector<cv::Mat>& frames = FramesOf(width);
  if (frames.size() < kFrames) {
    state.SkipWithError("vtest.avi of opencv-doc is not here");
    return;
  }
  const Masks all = MasksOf(width);
  const int before = cv::getNumThreads();
  cv::setNumThreads(1);
  for (std::size_t i = 0; i < kFrames; ++i) judge(frames[i], all.masks[i], all.model);
  std::size_t next = 0;
  for (auto _ : state) {
    judge(frames[next], all.masks[next], all.model);
    next = (next + 1) % kFrames;
  }
  cv::setNumThreads(before);
}

/// All that ghost detection adds to a frame: the components, and their judgement by FEP.
void RunGhosts(benchmark::State& state, GhostJudgement judgement) {
  GhostOptions options;
  options.judgement = judgement;
  const ImageSize size = state.range(0) == kVideoSize.width ? kVideoSize : kLargeSize;
  GhostDetector detector = GhostDetector::Create(size, options).value();
  RunMasks(state, [&](const cv::Mat& frame, const cv::Mat& mask, const MixtureModel& model) {
    const auto picture = [&](const cv::Rect& region) { return model.BackgroundImage(region); };
    const auto verdict = detector.Judge(frame, mask, picture);
    if (!verdict) state.SkipWithError("the mask was refused");
    benchmark::DoNotOptimize(verdict->ghosts_px);
  });
}

void BM_Ghosts(benchmark::State& state) { RunGhosts(state, GhostJudgement::kStill); }
BENCHMARK(BM_Ghosts)->Arg(kVideoSize.width)->Arg(kLargeSize.width);

void BM_GhostsPlain(benchmark::State& state) { RunGhosts(state, GhostJudgement::kPlain); }
BENCHMARK(BM_GhostsPlain)->Arg(kVideoSize.width)->Arg(kLargeSize.width);

/// What finding the components costs with OpenCV, a part of the work.
void BM_ConnectedComponents(benchmark::State& state) {
  RunMasks(state, [](const cv::Mat& /*frame*/, const cv::Mat& mask, const MixtureModel& /*model*/) {
    cv::Mat labels, stats, centroids;
    benchmark::DoNotOptimize(cv::connectedComponentsWithStats(mask, labels, stats, centroids, 8));
  });
}
BENCHMARK(BM_ConnectedComponents)->Arg(kVideoSize.width)->Arg(kLargeSize.width);

bool CompareInput(const std::string& input, int width) {
  for (const bool plain : {false, true}) {
    Compare({.name = "background." + input + ".ghosts" + (plain ? ".plain" : "") + ".cost",
             .ours = fmt::format("{}/{}", plain ? "BM_GhostsPlain" : "BM_Ghosts", width),
             .peer = fmt::format("BM_ConnectedComponents/{}", width),
             .peer_name = "cv::connectedComponentsWithStats alone",
             .unit = "ms",
             .threads = 1});
  }
  return true;
}

const bool compared =
    CompareInput("vtest", kVideoSize.width) && CompareInput("960x768", kLargeSize.width);

}  // namespace
}  // namespace vantage::bench
