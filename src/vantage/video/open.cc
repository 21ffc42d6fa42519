// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/open.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <utility>
#include <vector>

#include "vantage/video/container.h"
#include "vantage/video/file_lists.h"
#include "vantage/video/mask_writer.h"
#include "vantage/video/picture.h"
#include "vantage/video/sequence.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

class VideoSource final : public FrameSource {
 public:
  static Result<std::unique_ptr<FrameSource>> Open(const fs::path& path) {
    auto source = std::make_unique<VideoSource>();
    VANTAGE_RETURN_IF_ERROR(source->Start(path));
    return source;
  }

  const SourceInfo& info() const override { return info_; }

  Result<bool> Read(cv::Mat& frame) override {
    if (first_.empty()) return Decode(frame);
    frame = std::exchange(first_, cv::Mat());
    ++next_;
    return true;
  }

  Result<std::int64_t> Skip(std::int64_t count) override {
    std::int64_t skipped = 0;
    if (count > 0 && !first_.empty()) {
      first_.release();
      ++next_;
      ++skipped;
    }
    try {
      for (; skipped < count; ++skipped, ++next_) {
        if (ended_ || !capture_.grab()) {
          VANTAGE_RETURN_IF_ERROR(CheckEnd());
          break;
        }
      }
    } catch (const cv::Exception& error) {
      return Fail("{}: frame {} cannot be decoded: {}", info_.name, next_, error.err);
    }
    return skipped;
  }

 private:
  Status Start(const fs::path& path) {
    info_.name = path.string();
    VANTAGE_ASSIGN_OR_RETURN(facts_, internal::InspectContainer(path));
    try {
      // Absolute: FFmpeg would take "udp:x" for an address.
      if (!capture_.open(fs::absolute(path).string(), cv::CAP_FFMPEG)) {
        return Fail("{}: cannot be decoded as a video{}", info_.name, CutText());
      }
      VANTAGE_RETURN_IF_ERROR(internal::CheckPictureSize(
          info_.name, Property(cv::CAP_PROP_FRAME_WIDTH), Property(cv::CAP_PROP_FRAME_HEIGHT)));
      const double rate = capture_.get(cv::CAP_PROP_FPS);
      if (rate > 0 && rate <= 10'000) info_.frames_per_second = rate;
      promised_ =
          facts_.indexed_frames > 0 ? facts_.indexed_frames : Property(cv::CAP_PROP_FRAME_COUNT);
      if (facts_.frame_count_exact && promised_ > 0) info_.frame_count = promised_;
      if (!capture_.read(first_) || first_.empty()) {
        return Fail("{}: holds no frame that can be decoded{}", info_.name, CutText());
      }
    } catch (const cv::Exception& error) {
      return Fail("{}: cannot be decoded as a video: {}", info_.name, error.err);
    }
    info_.size = {first_.cols, first_.rows};
    VANTAGE_RETURN_IF_ERROR(internal::CheckPictureSize(info_.name, first_.cols, first_.rows));
    return CheckFrame(first_);
  }

  std::int64_t Property(int property) const {
    const double value = capture_.get(property);
    return value > 0 && value < 1e15 ? static_cast<std::int64_t>(value) : 0;
  }

  Result<bool> Decode(cv::Mat& frame) {
    try {
      if (ended_ || !capture_.read(frame)) {
        VANTAGE_RETURN_IF_ERROR(CheckEnd());
        return false;
      }
    } catch (const cv::Exception& error) {
      return Fail("{}: frame {} cannot be decoded: {}", info_.name, next_, error.err);
    }
    VANTAGE_RETURN_IF_ERROR(CheckFrame(frame));
    ++next_;
    return true;
  }

  Status CheckFrame(const cv::Mat& frame) const {
    if (frame.type() != CV_8UC3) {
      return Fail("{}: frame {} is not an 8-bit colour picture", info_.name, next_);
    }
    if (frame.cols != info_.size.width || frame.rows != info_.size.height) {
      return Fail("{}: frame {} has {} x {} px; the frames before have {} x {}", info_.name, next_,
                  frame.cols, frame.rows, info_.size.width, info_.size.height);
    }
    return {};
  }

  /// Tells an honest end from lost frames.
  Status CheckEnd() {
    ended_ = true;
    if (facts_.cut_short()) {
      return Fail("{}: frame {} is missing{}", info_.name, next_, CutText());
    }
    // Decoders of reordered frames may keep back the last ones of a sound file.
    constexpr std::int64_t kKeptBack = 2;
    if (info_.frame_count && next_ + kKeptBack < *info_.frame_count) {
      return Fail("{}: frame {} cannot be decoded; the file promises {} frames and is damaged",
                  info_.name, next_, *info_.frame_count);
    }
    return {};
  }

  std::string CutText() const {
    if (!facts_.cut_short()) return "";
    return fmt::format(": the file is cut short, {} of {} bytes are there", facts_.file_bytes,
                       facts_.needed_bytes) +
           (promised_ > 0 ? fmt::format(" and its header promises {} frames", promised_) : "");
  }

  SourceInfo info_;
  internal::ContainerFacts facts_;
  cv::VideoCapture capture_;
  std::int64_t promised_ = 0;
  std::int64_t next_ = 0;  // number of the frame that the next Read gives
  bool ended_ = false;
  cv::Mat first_;  // decoded on opening, given out by the first Read
};

class PictureSource final : public FrameSource {
 public:
  static Result<std::unique_ptr<FrameSource>> Open(const fs::path& path,
                                                   std::vector<fs::path> files) {
    VANTAGE_ASSIGN_OR_RETURN(const ImageSize size, internal::PictureSize(files.front()));
    SourceInfo info;
    info.name = path.string();
    info.size = size;
    info.frame_count = static_cast<std::int64_t>(files.size());
    return std::make_unique<PictureSource>(std::move(info), std::move(files));
  }
  PictureSource(SourceInfo info, std::vector<fs::path> files)
      : info_(std::move(info)), files_(std::move(files)) {}

  const SourceInfo& info() const override { return info_; }

  Result<bool> Read(cv::Mat& frame) override {
    if (next_ == files_.size()) return false;
    const fs::path& file = files_[next_];
    VANTAGE_ASSIGN_OR_RETURN(frame, internal::ReadPicture(file));
    if (frame.cols != info_.size.width || frame.rows != info_.size.height) {
      return Fail("{}: frame {} has {} x {} px; the first picture has {} x {}", file.string(),
                  next_, frame.cols, frame.rows, info_.size.width, info_.size.height);
    }
    ++next_;
    return true;
  }

  Result<std::int64_t> Skip(std::int64_t count) override {
    const auto left = static_cast<std::int64_t>(files_.size() - next_);
    const std::int64_t skipped = std::clamp<std::int64_t>(count, 0, left);
    next_ += static_cast<std::size_t>(skipped);
    return skipped;
  }

 private:
  SourceInfo info_;
  std::vector<fs::path> files_;
  std::size_t next_ = 0;
};

class MaskSource final : public FrameSource {
 public:
  explicit MaskSource(std::unique_ptr<FrameSource> pictures)
      : pictures_(std::move(pictures)), info_(pictures_->info()) {
    info_.content = FrameContent::kMask;
  }

  const SourceInfo& info() const override { return info_; }

  Result<bool> Read(cv::Mat& frame) override {
    VANTAGE_ASSIGN_OR_RETURN(const bool more, pictures_->Read(picture_));
    if (!more) return false;
    if (internal::LargestChannelDifference(picture_) > internal::kChannelNoise) {
      return Fail("{}: frame {} is a colour picture; a mask is black and white", info_.name, next_);
    }
    cv::extractChannel(picture_, frame, 1);
    cv::threshold(frame, frame, 127, 255, cv::THRESH_BINARY);
    ++next_;
    return true;
  }

  Result<std::int64_t> Skip(std::int64_t count) override {
    VANTAGE_ASSIGN_OR_RETURN(const std::int64_t skipped, pictures_->Skip(count));
    next_ += skipped;
    return skipped;
  }

 private:
  std::unique_ptr<FrameSource> pictures_;
  SourceInfo info_;
  cv::Mat picture_;
  std::int64_t next_ = 0;
};

}  // namespace

Result<std::unique_ptr<FrameSource>> OpenVideo(const fs::path& path) {
  return VideoSource::Open(path);
}

Result<std::unique_ptr<FrameSource>> OpenPictures(const fs::path& path) {
  std::error_code code;
  if (fs::is_directory(path, code)) {
    VANTAGE_ASSIGN_OR_RETURN(std::vector<fs::path> files, internal::ListPictures(path));
    return PictureSource::Open(path, std::move(files));
  }
  VANTAGE_ASSIGN_OR_RETURN(std::vector<fs::path> files, internal::ListNumbered(path));
  return PictureSource::Open(path, std::move(files));
}

Result<std::unique_ptr<FrameSource>> OpenInput(const fs::path& path) {
  std::error_code code;
  if (IsSequenceFolder(path)) return OpenPictures(path / "input");
  if (fs::is_directory(path, code)) return OpenPictures(path);
  if (fs::exists(path, code)) {
    if (internal::HasPictureExtension(path)) {
      return Fail(
          "{}: is one picture; name a video, a folder of pictures, or a pattern such as "
          "frames/%06d.png",
          path.string());
    }
    return OpenVideo(path);
  }
  if (path.filename().string().find('%') != std::string::npos) return OpenPictures(path);
  return Fail("{}: no such file or folder", path.string());
}

Result<std::unique_ptr<FrameSource>> OpenMasks(const fs::path& path) {
  std::error_code code;
  const bool video_inside = fs::exists(path / kMaskVideoName, code);
  VANTAGE_ASSIGN_OR_RETURN(std::unique_ptr<FrameSource> pictures,
                           OpenInput(video_inside ? path / kMaskVideoName : path));
  return std::make_unique<MaskSource>(std::move(pictures));
}

}  // namespace vantage
