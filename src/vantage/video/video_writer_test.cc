// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/video_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/video/mask_writer.h"
#include "vantage/video/open.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

cv::Mat Frame(ImageSize size, int level) {
  return cv::Mat(size.height, size.width, CV_8UC3, cv::Scalar(level, 255 - level, level / 2));
}
cv::Mat Noise(ImageSize size, int seed) {
  cv::Mat frame(size.height, size.width, CV_8UC3);
  cv::RNG rng(static_cast<std::uint64_t>(seed) + 1);
  rng.fill(frame, cv::RNG::UNIFORM, 0, 256);
  return frame;
}

/// Lets files of this process grow to `bytes` only: writes beyond fail as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_ = {};
  void (*handler_)(int) = SIG_DFL;
};

std::size_t FilesIn(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(VideoWriter, WritesWhatBrowsersPlay) {
  TemporaryFolder folder;
  for (const ImageSize size : {ImageSize{64, 48}, ImageSize{63, 47}}) {
    const fs::path path = folder / fmt::format("{}.mp4", size.width);
    auto writer = VideoWriter::Create(path, size, 12.5);
    ASSERT_TRUE(writer) << MessageOf(writer);
    for (int i = 0; i < 30; ++i) ASSERT_TRUE(writer->Write(Frame(size, 8 * i)));
    EXPECT_FALSE(fs::exists(path));
    const Status finished = writer->Finish();
    ASSERT_TRUE(finished) << MessageOf(finished);

    const auto source = OpenVideo(path);
    ASSERT_TRUE(source) << MessageOf(source);
    EXPECT_EQ((*source)->info().size, (ImageSize{64, 48}));
    EXPECT_EQ((*source)->info().frame_count, 30);
    EXPECT_NEAR((*source)->info().frames_per_second.value(), 12.5, 1e-6);
    cv::Mat frame;
    for (int i = 0; i < 30; ++i) {
      ASSERT_TRUE((*source)->Read(frame).value());
      const cv::Scalar mean = cv::mean(frame);
      EXPECT_NEAR(mean[0], 8 * i, 6);
      EXPECT_NEAR(mean[1], 255 - 8 * i, 6);
    }
    cv::VideoCapture video(path.string(), cv::CAP_FFMPEG);
    EXPECT_EQ(static_cast<int>(video.get(cv::CAP_PROP_FOURCC)),
              cv::VideoWriter::fourcc('a', 'v', 'c', '1'));
    const auto format = static_cast<int>(video.get(cv::CAP_PROP_CODEC_PIXEL_FORMAT));
    EXPECT_EQ(format, cv::VideoWriter::fourcc('I', '4', '2', '0'));
  }
  EXPECT_EQ(FilesIn(folder.path()), 2u);
}

TEST(VideoWriter, OneFrameIsAVideo) {
  TemporaryFolder folder;
  auto writer = VideoWriter::Create(folder / "one.mp4", {1, 1}, 25);
  ASSERT_TRUE(writer) << MessageOf(writer);
  ASSERT_TRUE(writer->Write(Frame({1, 1}, 7)));
  const Status finished = writer->Finish();
  ASSERT_TRUE(finished) << MessageOf(finished);
  EXPECT_EQ(OpenVideo(folder / "one.mp4").value()->info().frame_count, 1);
}

TEST(VideoWriter, LeavesNothingWithoutFinish) {
  TemporaryFolder folder;
  {
    auto writer = VideoWriter::Create(folder / "v.mp4", {64, 48}, 10);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->Write(Frame({64, 48}, 1)));
  }
  EXPECT_EQ(FilesIn(folder.path()), 0u);
}

TEST(VideoWriter, FullDiskIsAnErrorAndLeavesNothing) {
  TemporaryFolder folder;
  for (const rlim_t limit : {0, 100, 5'000, 40'000, 200'000}) {
    const FileSizeLimit full(limit);
    auto writer = VideoWriter::Create(folder / "v.mp4", {160, 120}, 10);
    if (writer) {
      Status status;
      for (int i = 0; i < 60 && status; ++i) status = writer->Write(Noise({160, 120}, i));
      if (status) status = writer->Finish();
      EXPECT_THAT(MessageOf(status), HasSubstr("v.mp4: ")) << limit;
    } else {
      EXPECT_THAT(MessageOf(writer), HasSubstr("v.mp4: ")) << limit;
    }
  }
  EXPECT_EQ(FilesIn(folder.path()), 0u);
}

TEST(VideoWriter, RefusesWrongUse) {
  TemporaryFolder folder;
  EXPECT_THAT(MessageOf(VideoWriter::Create(folder / "v.avi", {64, 48}, 10)),
              HasSubstr("ends in .mp4"));
  EXPECT_THAT(MessageOf(VideoWriter::Create(folder / "v.mp4", {0, 48}, 10)), HasSubstr("0 x 48"));
  EXPECT_THAT(MessageOf(VideoWriter::Create(folder / "v.mp4", {64, 9000}, 10)),
              HasSubstr("64 x 9000"));
  for (const double rate : {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(MessageOf(VideoWriter::Create(folder / "v.mp4", {64, 48}, rate)),
                HasSubstr("frames per second"));
  }
  EXPECT_THAT(MessageOf(VideoWriter::Create("/proc/none/v.mp4", {64, 48}, 10)),
              HasSubstr("/proc/none"));
  auto writer = VideoWriter::Create(folder / "v.mp4", {64, 48}, 10);
  ASSERT_TRUE(writer);
  EXPECT_THAT(MessageOf(writer->Write(Frame({48, 64}, 1))), HasSubstr("frame 0 is not"));
  EXPECT_THAT(MessageOf(writer->Write(cv::Mat(48, 64, CV_8UC1))), HasSubstr("frame 0 is not"));
  EXPECT_THAT(MessageOf(writer->Finish()), HasSubstr("no frame was written"));
}

cv::Mat NoiseMask(ImageSize size, int seed) {
  cv::Mat grey;
  cv::extractChannel(Noise(size, seed), grey, 0);
  return grey >= 128;
}

TEST(MaskVideo, IsReadBackBitForBit) {
  TemporaryFolder folder;
  // Rates that are no whole number of Matroska's milliseconds, and the ends of what is allowed.
  for (const double rate : {0.5, 7.0, 25.0, 29.97, 60.0, 200.0}) {
    for (const ImageSize size : {ImageSize{2, 2}, ImageSize{62, 34}, ImageSize{320, 240}}) {
      SCOPED_TRACE(fmt::format("{} x {} px at {}", size.width, size.height, rate));
      const fs::path path = folder / fmt::format("{}-{}.mkv", size.width, rate);
      auto writer = VideoWriter::CreateForMasks(path, size, rate);
      ASSERT_TRUE(writer) << MessageOf(writer);
      std::vector<cv::Mat> masks;
      for (int i = 0; i < 40; ++i) {
        masks.push_back(i % 7 == 0 ? cv::Mat(size.height, size.width, CV_8UC1, cv::Scalar(0))
                                   : NoiseMask(size, i));
        const Status written = writer->Write(masks.back());
        ASSERT_TRUE(written) << MessageOf(written);
      }
      const Status finished = writer->Finish();
      ASSERT_TRUE(finished) << MessageOf(finished);

      const auto source = OpenMasks(path);
      ASSERT_TRUE(source) << MessageOf(source);
      EXPECT_EQ((*source)->info().size, size);
      cv::Mat read;
      for (const cv::Mat& mask : masks) {
        ASSERT_TRUE((*source)->Read(read).value());
        EXPECT_EQ(cv::norm(read, mask, cv::NORM_INF), 0);
      }
      EXPECT_FALSE((*source)->Read(read).value());
    }
  }
}

TEST(MaskVideo, RefusesWrongUse) {
  TemporaryFolder folder;
  EXPECT_THAT(MessageOf(VideoWriter::CreateForMasks(folder / "m.mp4", {64, 48}, 25)),
              HasSubstr("ends in .mkv"));
  EXPECT_THAT(MessageOf(VideoWriter::CreateForMasks(folder / "m.mkv", {63, 48}, 25)),
              HasSubstr("63 x 48 px do not fit in a lossless video, whose sides are even"));
  auto writer = VideoWriter::CreateForMasks(folder / "m.mkv", {64, 48}, 25);
  ASSERT_TRUE(writer) << MessageOf(writer);
  EXPECT_THAT(MessageOf(writer->Write(Frame({64, 48}, 1))), HasSubstr("not an 8-bit mask"));
}

TEST(MaskVideo, FullDiskIsAnErrorAndLeavesNothing) {
  TemporaryFolder folder;
  for (const rlim_t limit : {0, 100, 3'000, 40'000, 90'000}) {
    const FileSizeLimit full(limit);
    auto writer = VideoWriter::CreateForMasks(folder / "m.mkv", {160, 120}, 10);
    Status status;
    if (!writer) status = tl::unexpected(writer.error());
    for (int i = 0; i < 60 && status; ++i) status = writer->Write(NoiseMask({160, 120}, i));
    if (status) status = writer->Finish();
    EXPECT_THAT(MessageOf(status), HasSubstr("m.mkv: ")) << limit;
  }
  EXPECT_EQ(FilesIn(folder.path()), 0u);
}

TEST(MaskVideo, CutShortIsAnError) {
  TemporaryFolder folder;
  const fs::path path = folder / "m.mkv";
  auto writer = VideoWriter::CreateForMasks(path, {160, 120}, 10);
  ASSERT_TRUE(writer) << MessageOf(writer);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(writer->Write(NoiseMask({160, 120}, i)));
  ASSERT_TRUE(writer->Finish());
  fs::resize_file(path, fs::file_size(path) / 2);
  const auto source = OpenMasks(path);
  ASSERT_TRUE(source) << MessageOf(source);
  cv::Mat mask;
  Result<bool> more = true;
  for (int i = 0; i < 20 && more && *more; ++i) more = (*source)->Read(mask);
  EXPECT_THAT(MessageOf(more), HasSubstr("cut short"));
}

TEST(MaskWriter, FolderAppearsWholeInEitherFormat) {
  TemporaryFolder folder;
  for (const MaskFormat format : {MaskFormat::kPng, MaskFormat::kVideo}) {
    const fs::path out = folder / (format == MaskFormat::kPng ? "png" : "video");
    {
      auto dropped = MaskWriter::Create(out, format, {64, 48}, 25, false);
      ASSERT_TRUE(dropped) << MessageOf(dropped);
      ASSERT_TRUE(dropped->Write(0, NoiseMask({64, 48}, 0)));
    }
    EXPECT_FALSE(fs::exists(out));
    auto writer = MaskWriter::Create(out, format, {64, 48}, 25, false);
    ASSERT_TRUE(writer) << MessageOf(writer);
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(writer->Write(i, NoiseMask({64, 48}, i)));
    EXPECT_FALSE(fs::exists(out));
    const Status finished = writer->Finish();
    ASSERT_TRUE(finished) << MessageOf(finished);
    EXPECT_EQ(FilesIn(out), format == MaskFormat::kPng ? 5u : 1u);
    const auto source = OpenMasks(out);
    ASSERT_TRUE(source) << MessageOf(source);
    cv::Mat read;
    for (int i = 0; i < 5; ++i) {
      ASSERT_TRUE((*source)->Read(read).value());
      EXPECT_EQ(cv::norm(read, NoiseMask({64, 48}, i), cv::NORM_INF), 0);
    }
    EXPECT_THAT(MessageOf(MaskWriter::Create(out, format, {64, 48}, 25, false)),
                HasSubstr(out.string()));
  }
  EXPECT_EQ(FilesIn(folder.path()), 2u);
  EXPECT_THAT(
      MessageOf(MaskWriter::Create(folder / "odd", MaskFormat::kVideo, {63, 48}, 25, false)),
      HasSubstr("write pictures (PNG)"));
}

TEST(WriteMask, IsReadBackByOpenMasks) {
  TemporaryFolder folder;
  cv::Mat mask(20, 30, CV_8UC1, cv::Scalar(0));
  for (int frame = 5; frame < 8; ++frame) {
    mask(cv::Rect(frame, 3, 4, 5)) = 255;
    ASSERT_TRUE(WriteMask(folder.path(), frame, mask));
  }
  EXPECT_TRUE(fs::exists(folder / "000007.png"));
  const auto source = OpenMasks(folder / "%06d.png");
  ASSERT_TRUE(source) << MessageOf(source);
  EXPECT_EQ((*source)->info().frame_count, 3);
  EXPECT_EQ((*source)->Skip(2).value(), 2);
  cv::Mat read;
  ASSERT_TRUE((*source)->Read(read).value());
  EXPECT_EQ(cv::norm(read, mask, cv::NORM_INF), 0);
}

TEST(WriteMask, ReportsWhatCannotBeWritten) {
  TemporaryFolder folder;
  const cv::Mat mask(20, 30, CV_8UC1, cv::Scalar(0));
  EXPECT_THAT(MessageOf(WriteMask(folder / "none", 3, mask)),
              HasSubstr("000003.png: cannot be written"));
  EXPECT_THAT(MessageOf(WriteMask(folder.path(), -1, mask)), HasSubstr("at least 0"));
  EXPECT_THAT(MessageOf(WriteMask(folder.path(), 0, cv::Mat())), HasSubstr("not a mask"));
  EXPECT_THAT(MessageOf(WriteMask(folder.path(), 0, cv::Mat(3, 3, CV_8UC3))),
              HasSubstr("not a mask"));
  const FileSizeLimit full(10);
  EXPECT_THAT(MessageOf(WriteMask(folder.path(), 4, mask)),
              HasSubstr("000004.png: cannot be written"));
}

}  // namespace
}  // namespace vantage
