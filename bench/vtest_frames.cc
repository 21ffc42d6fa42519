// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "bench/vtest_frames.h"

#include <opencv2/core.hpp>

#include "vantage/video/open.h"

namespace vantage::bench {
namespace {

constexpr const char* kVideo = "/usr/share/doc/opencv-doc/examples/data/vtest.avi";

std::vector<cv::Mat> ReadVideo() {
  std::vector<cv::Mat> frames;
  const auto source = OpenVideo(kVideo);
  cv::Mat frame;
  while (source && frames.size() < kFrames && (*source)->Read(frame).value_or(false)) {
    frames.push_back(frame.clone());
  }
  return frames;
}

}  // namespace

const std::vector<cv::Mat>& FramesOf(int width) {
  static const std::vector<cv::Mat> video = ReadVideo();
  static const std::vector<cv::Mat> large = [] {
    std::vector<cv::Mat> frames(video.size());
    for (std::size_t i = 0; i < video.size(); ++i) {
      cv::copyMakeBorder(video[i], frames[i], 0, kLargeSize.height - kVideoSize.height, 0,
                         kLargeSize.width - kVideoSize.width, cv::BORDER_REFLECT);
    }
    return frames;
  }();
  return width == kVideoSize.width ? video : large;
}

}  // namespace vantage::bench
