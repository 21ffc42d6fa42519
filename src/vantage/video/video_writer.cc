// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/video_writer.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <utility>

#include "vantage/base/file.h"
#include "vantage/video/container.h"

namespace vantage {

struct VideoWriter::State {
  State(StagedFile staged, ImageSize frame_size, FrameContent frame_content)
      : file(std::move(staged)), size(frame_size), content(frame_content) {}

  StagedFile file;
  ImageSize size;
  FrameContent content;
  cv::VideoWriter encoder;
  cv::Mat last;  // as encoded
  std::int64_t frames = 0;

  std::string Name() const { return file.final_path().string(); }
};

namespace {

/// Decodes the last frame of a finished file.
Status CheckWritten(const std::string& name, const std::filesystem::path& path, std::int64_t frames,
                    const cv::Mat& last_written, bool lossless) {
  const auto incomplete = [&] {
    return Fail("{}: the video could not be written completely; is the disk full?", name);
  };
  const auto facts = internal::InspectContainer(path);
  if (!facts || facts->cut_short()) return incomplete();
  // Matroska has no count of frames; its size is filled in last.
  if (lossless ? facts->needed_bytes == 0 : !facts->frame_count_exact) return incomplete();
  cv::VideoCapture video;
  if (!video.open(std::filesystem::absolute(path).string(), cv::CAP_FFMPEG)) return incomplete();
  if (video.get(cv::CAP_PROP_FRAME_COUNT) != static_cast<double>(frames)) return incomplete();
  cv::Mat last;
  video.set(cv::CAP_PROP_POS_FRAMES, static_cast<double>(frames - 1));
  if (!video.read(last) || last.empty()) return incomplete();
  if (lossless) {
    cv::Mat grey;
    cv::extractChannel(last, grey, 1);
    if (grey.size() != last_written.size() || cv::norm(grey, last_written, cv::NORM_INF) > 0) {
      return Fail("{}: this build of FFmpeg does not give masks back unchanged; write pictures",
                  name);
    }
  }
  return {};
}

}  // namespace

VideoWriter::VideoWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;
VideoWriter::~VideoWriter() = default;

Result<VideoWriter> VideoWriter::Create(const std::filesystem::path& path, ImageSize size,
                                        double frames_per_second) {
  if (path.extension() != ".mp4")
    return Fail("{}: the name of a video to write ends in .mp4", path.string());
  return Open(path, size, frames_per_second, FrameContent::kColor);
}

Result<VideoWriter> VideoWriter::CreateForMasks(const std::filesystem::path& path, ImageSize size,
                                                double frames_per_second) {
  if (path.extension() != ".mkv")
    return Fail("{}: the name of a lossless video to write ends in .mkv", path.string());
  if (size.width % 2 != 0 || size.height % 2 != 0) {
    return Fail(
        "{}: masks of {} x {} px do not fit in a lossless video, whose sides are even; write "
        "pictures (PNG)",
        path.string(), size.width, size.height);
  }
  return Open(path, size, frames_per_second, FrameContent::kMask);
}

Result<VideoWriter> VideoWriter::Open(const std::filesystem::path& path, ImageSize size,
                                      double frames_per_second, FrameContent content) {
  constexpr int kMaxSide = 8192;
  if (size.width < 1 || size.height < 1 || size.width > kMaxSide || size.height > kMaxSide) {
    return Fail("{}: the video would have {} x {} px; each side must be 1 to {}", path.string(),
                size.width, size.height, kMaxSide);
  }
  if (!(frames_per_second > 0 && frames_per_second <= 1000)) {
    return Fail("{}: frames per second is {}; it must be above 0 and at most 1000", path.string(),
                frames_per_second);
  }
  VANTAGE_ASSIGN_OR_RETURN(StagedFile file, StagedFile::Create(path));
  auto state = std::make_unique<State>(std::move(file), size, content);
  const bool color = content == FrameContent::kColor;
  const cv::Size even(size.width + size.width % 2, size.height + size.height % 2);
  try {
    // "avc1" is H.264; OpenCV chooses 4:2:0 and constant quality for it.
    const int codec = color ? cv::VideoWriter::fourcc('a', 'v', 'c', '1')
                            : cv::VideoWriter::fourcc('F', 'F', 'V', '1');
    if (!state->encoder.open(std::filesystem::absolute(state->file.temporary()).string(),
                             cv::CAP_FFMPEG, codec, frames_per_second, even, color)) {
      return Fail(
          "{}: the video cannot be written: this build of FFmpeg has no {} encoder, or the place "
          "is not writable",
          path.string(), color ? "H.264" : "FFV1");
    }
  } catch (const cv::Exception& error) {
    return Fail("{}: the video cannot be written: {}", path.string(), error.err);
  }
  return VideoWriter(std::move(state));
}

Status VideoWriter::Write(const cv::Mat& frame) {
  const bool color = state_->content == FrameContent::kColor;
  if (frame.type() != (color ? CV_8UC3 : CV_8UC1) || frame.cols != state_->size.width ||
      frame.rows != state_->size.height) {
    return Fail("{}: frame {} is not an 8-bit {} of {} x {} px", state_->Name(), state_->frames,
                color ? "colour picture" : "mask", state_->size.width, state_->size.height);
  }
  try {
    cv::copyMakeBorder(frame, state_->last, 0, frame.rows % 2, 0, frame.cols % 2,
                       cv::BORDER_REPLICATE);
    state_->encoder.write(state_->last);
  } catch (const cv::Exception& error) {
    return Fail("{}: frame {} cannot be written: {}", state_->Name(), state_->frames, error.err);
  }
  ++state_->frames;
  return {};
}

Status VideoWriter::Finish() {
  if (state_->frames == 0)
    return Fail("{}: no frame was written; a video needs one", state_->Name());
  try {
    state_->encoder.release();
    VANTAGE_RETURN_IF_ERROR(CheckWritten(state_->Name(), state_->file.temporary(), state_->frames,
                                         state_->last, state_->content == FrameContent::kMask));
  } catch (const cv::Exception& error) {
    return Fail("{}: the video cannot be written: {}", state_->Name(), error.err);
  }
  return state_->file.Commit();
}

}  // namespace vantage
