// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <opencv2/imgproc.hpp>

#include "vantage/background/subtractor.h"
#include "vantage/video/open.h"

using namespace vantage;
// A background method of one's own, a running mean, inside Vantage's ghost detection.
class RunningMean : public BackgroundMethod {
  Status Apply(const cv::Mat& bgr, const cv::Mat&, cv::Mat& mask, int) override {
    bgr.convertTo(frame_, CV_32F);
    if (mean_.empty()) mean_ = frame_.clone();
    cv::accumulateWeighted(frame_, mean_, 0.002);
    cv::cvtColor(cv::abs(frame_ - mean_), mask, cv::COLOR_BGR2GRAY);
    mask = mask > 15;  // levels
    return {};
  }
  Status Absorb(const cv::Mat& pixels) override { return frame_.copyTo(mean_, pixels), Status(); }
  cv::Mat BackgroundImage(const cv::Rect& r) const override { return cv::Mat3b(mean_(r)); }
  cv::Mat frame_, mean_;  // CV_32FC3
};

Status Run(const char* input, std::unique_ptr<BackgroundMethod> own) {
  VANTAGE_ASSIGN_OR_RETURN(const auto source, OpenInput(input));  // a video or a folder
  VANTAGE_ASSIGN_OR_RETURN(auto subtractor,
                           BackgroundSubtractor::Create(source->info().size, std::move(own), {}));
  for (cv::Mat frame, mask;;) {
    VANTAGE_ASSIGN_OR_RETURN(const bool more, source->Read(frame));
    if (!more) return {};
    VANTAGE_RETURN_IF_ERROR(subtractor.Apply(frame, mask, 1));
    fmt::print("{} {}\n", cv::countNonZero(mask), subtractor.verdict().ghosts_px);
  }
}

int main(int argc, char** argv) {
  const auto done = Run(argc == 2 ? argv[1] : "", std::make_unique<RunningMean>());
  return done ? 0 : (fmt::print(stderr, "{}\n", done.error().message), 1);
}
