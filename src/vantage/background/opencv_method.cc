// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/background/opencv_method.h"

#include <cstdint>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/video/background_segm.hpp>
#include <utility>

namespace vantage {
namespace {

// A pixel within this of the colour that it was absorbed with looks the same: the largest
// difference of a channel, levels. About four times the noise of ordinary cameras.
constexpr int kSameLevels = 20;

cv::Ptr<cv::BackgroundSubtractor> CreatePeer(MethodKind kind) {
  if (kind == MethodKind::kMog2) return cv::createBackgroundSubtractorMOG2();
  return cv::createBackgroundSubtractorKNN();
}

class OpenCvMethod final : public BackgroundMethod {
 public:
  OpenCvMethod(MethodKind kind, ImageSize size)
      : kind_(kind), size_(size.width, size.height), peer_(CreatePeer(kind)) {}

  Status Apply(const cv::Mat& bgr, const cv::Mat& /*held*/, cv::Mat& mask,
               int /*threads*/) override {
    if (bgr.type() != CV_8UC3 || bgr.size() != size_) {
      return Fail("background: a frame is {}x{} px of type {}; it must be {}x{} px of CV_8UC3",
                  bgr.cols, bgr.rows, cv::typeToString(bgr.type()), size_.width, size_.height);
    }
    frame_ = bgr.clone();
    background_.release();
    cv::Mat labels;
    // KNN draws from the thread's generator, which others use too: it gets its own.
    std::swap(cv::theRNG().state, random_.state);
    peer_->apply(frame_, labels);
    std::swap(cv::theRNG().state, random_.state);
    mask = labels == 255;  // 127 is shadow
    absorbed_.TakeFrom(frame_, mask);
    return {};
  }
  Status Absorb(const cv::Mat& pixels) override {
    if (pixels.type() != CV_8UC1 || pixels.size() != frame_.size()) {
      return Fail(
          "background: the pixels to absorb are {}x{} px of type {}; they must be of the last "
          "frame's {}x{} px and of CV_8UC1",
          pixels.cols, pixels.rows, cv::typeToString(pixels.type()), frame_.cols, frame_.rows);
    }
    absorbed_.Add(frame_, pixels);
    return {};
  }
  cv::Mat BackgroundImage(const cv::Rect& region) const override {
    if (frame_.empty()) return {};
    // The peer makes all of it each time; it is asked for in many parts.
    if (background_.empty()) peer_->getBackgroundImage(background_);
    return background_(region & cv::Rect({}, size_));
  }
  void Restart() override {
    peer_ = CreatePeer(kind_);
    frame_.release();
    background_.release();
    absorbed_ = {};
  }

 private:
  MethodKind kind_;
  cv::Size size_;
  cv::Ptr<cv::BackgroundSubtractor> peer_;
  cv::RNG random_;
  cv::Mat frame_;               ///< the last; empty before the first
  mutable cv::Mat background_;  ///< made of it; empty before it was asked for
  AbsorbedColors absorbed_;
};

}  // namespace

void AbsorbedColors::Add(const cv::Mat& bgr, const cv::Mat& pixels) {
  if (known_.empty()) {
    colors_ = cv::Mat::zeros(bgr.size(), CV_8UC3);
    known_ = cv::Mat::zeros(bgr.size(), CV_8UC1);
  }
  bgr.copyTo(colors_, pixels);
  known_.setTo(255, pixels);
}

void AbsorbedColors::TakeFrom(const cv::Mat& bgr, cv::Mat& mask) {
  if (known_.empty()) return;
  for (int y = 0; y < mask.rows; ++y) {
    std::uint8_t* known = known_.ptr(y);
    std::uint8_t* foreground = mask.ptr(y);
    const auto* color = bgr.ptr<cv::Vec3b>(y);
    const auto* kept = colors_.ptr<cv::Vec3b>(y);
    for (int x = 0; x < mask.cols; ++x) {
      if (known[x] == 0) continue;
      if (foreground[x] == 0) {
        known[x] = 0;
        continue;
      }
      bool same = true;
      for (int c = 0; c < 3; ++c) same &= std::abs(color[x][c] - kept[x][c]) <= kSameLevels;
      if (same) foreground[x] = 0;
    }
  }
}

Result<std::unique_ptr<BackgroundMethod>> CreateOpenCvMethod(MethodKind kind, ImageSize size) {
  return std::make_unique<OpenCvMethod>(kind, size);
}

}  // namespace vantage
