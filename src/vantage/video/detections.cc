// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/detections.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/base/text.h"
#include "vantage/video/picture.h"

namespace vantage {
namespace {

constexpr std::int64_t kMaxFrames = 10'000'000;

/// One row; `where` is "file:line".
Status ReadRow(const std::string& where, std::string_view line, std::size_t columns, ImageSize size,
               Detections& detections) {
  const std::vector<std::string_view> fields = Fields(line);
  if (fields.size() != columns) {
    return Fail("{}: has {} fields; the header names {}", where, fields.size(), columns);
  }
  std::int64_t frame = 0;
  if (!ParseNumber(fields[0], frame) || frame < 0 || frame >= kMaxFrames) {
    return Fail("{}: frame is '{}'; it must be a whole number from 0 to {}", where, fields[0],
                kMaxFrames - 1);
  }
  constexpr const char* kNames[] = {"xmin", "ymin", "xmax", "ymax", "score"};
  double numbers[5] = {0, 0, 0, 0, 1};
  for (std::size_t i = 1; i < columns; ++i) {
    if (!ParseNumber(fields[i], numbers[i - 1]) || !std::isfinite(numbers[i - 1])) {
      return Fail("{}: {} is '{}'; it must be a finite number", where, kNames[i - 1], fields[i]);
    }
  }
  const auto [xmin, ymin, xmax, ymax, score] = numbers;
  if (xmax < xmin) return Fail("{}: xmax {} is less than xmin {}", where, xmax, xmin);
  if (ymax < ymin) return Fail("{}: ymax {} is less than ymin {}", where, ymax, ymin);
  if (detections.size() <= static_cast<std::size_t>(frame)) {
    detections.resize(static_cast<std::size_t>(frame) + 1);
  }
  // From the file's corner of the first pixel to its centre.
  const PixelBox box = {std::clamp<double>(xmin, 0, size.width) - 0.5,
                        std::clamp<double>(ymin, 0, size.height) - 0.5,
                        std::clamp<double>(xmax, 0, size.width) - 0.5,
                        std::clamp<double>(ymax, 0, size.height) - 0.5};
  if (box.width() > 0 && box.height() > 0) {
    detections[static_cast<std::size_t>(frame)].push_back({box, score});
  }
  return {};
}

class DetectionSource final : public FrameSource {
 public:
  DetectionSource(SourceInfo info, Detections detections, double min_score)
      : info_(std::move(info)), detections_(std::move(detections)), min_score_(min_score) {}

  const SourceInfo& info() const override { return info_; }

  Result<bool> Read(cv::Mat& frame) override {
    if (next_ == detections_.size()) return false;
    frame = DrawDetections(detections_[next_++], info_.size, min_score_);
    return true;
  }

  Result<std::int64_t> Skip(std::int64_t count) override {
    const auto left = static_cast<std::int64_t>(detections_.size() - next_);
    const std::int64_t skipped = std::clamp<std::int64_t>(count, 0, left);
    next_ += static_cast<std::size_t>(skipped);
    return skipped;
  }

 private:
  SourceInfo info_;
  Detections detections_;
  double min_score_;
  std::size_t next_ = 0;
};

}  // namespace

Result<Detections> ReadDetections(const std::filesystem::path& path, ImageSize size) {
  VANTAGE_RETURN_IF_ERROR(internal::CheckPictureSize(path.string(), size.width, size.height));
  VANTAGE_ASSIGN_OR_RETURN(const std::string text, ReadTextFile(path));
  Detections detections;
  std::size_t columns = 0;
  VANTAGE_RETURN_IF_ERROR(
      ForEachLine(text, [&](std::string_view line, std::size_t number) -> Status {
        if (columns == 0) {
          if (line != "frame,xmin,ymin,xmax,ymax,score" && line != "frame,xmin,ymin,xmax,ymax") {
            return Fail(
                "{}:1: the header must be frame,xmin,ymin,xmax,ymax,score (score may be left out)",
                path.string());
          }
          columns = line.ends_with("score") ? 6 : 5;
          return {};
        }
        if (line.empty()) return {};
        return ReadRow(fmt::format("{}:{}", path.string(), number), line, columns, size,
                       detections);
      }));
  if (detections.empty()) return Fail("{}: holds no detections", path.string());
  return detections;
}

cv::Mat DrawDetections(const std::vector<Detection>& detections, ImageSize size, double min_score) {
  cv::Mat mask(size.height, size.width, CV_8UC1, cv::Scalar(0));
  const cv::Rect picture(0, 0, size.width, size.height);
  for (const Detection& detection : detections) {
    if (detection.score < min_score) continue;
    const auto first = [](double edge) { return static_cast<int>(std::ceil(edge)); };
    const cv::Point top_left(first(detection.box.min_x), first(detection.box.min_y));
    const cv::Point end(first(detection.box.max_x), first(detection.box.max_y));
    mask(cv::Rect(top_left, end) & picture).setTo(255);
  }
  return mask;
}

Result<std::unique_ptr<FrameSource>> OpenDetections(const std::filesystem::path& path,
                                                    ImageSize size, double min_score) {
  if (!std::isfinite(min_score)) {
    return Fail("{}: min_score is {}; it must be a finite number", path.string(), min_score);
  }
  VANTAGE_ASSIGN_OR_RETURN(Detections detections, ReadDetections(path, size));
  SourceInfo info;
  info.name = path.string();
  info.size = size;
  info.content = FrameContent::kMask;
  info.frame_count = static_cast<std::int64_t>(detections.size());
  return std::make_unique<DetectionSource>(std::move(info), std::move(detections), min_score);
}

}  // namespace vantage
