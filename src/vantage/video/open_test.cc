// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/open.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/video/test_sources.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::Bytes;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::Outcome;
using testing::ReadAll;
using testing::TemporaryFolder;
using testing::WriteBytes;

constexpr int kWidth = 96;
constexpr int kHeight = 64;

/// A flat grey frame whose level tells its number, with some texture.
cv::Mat Frame(int number) {
  cv::Mat frame(kHeight, kWidth, CV_8UC3, cv::Scalar::all(20 + 4 * number));
  cv::rectangle(frame, {number, 10, 20, 20}, {0, 0, 255}, cv::FILLED);
  return frame;
}
int NumberOf(const cv::Mat& frame) {
  return (frame.at<cv::Vec3b>(kHeight - 4, kWidth - 4)[1] - 20 + 2) / 4;
}

/// Writes a video of 40 frames.
fs::path WriteVideo(const fs::path& path, const std::string& codec) {
  cv::VideoWriter writer(path.string(), cv::CAP_FFMPEG,
                         cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]), 10,
                         {kWidth, kHeight});
  EXPECT_TRUE(writer.isOpened()) << path;
  for (int i = 0; i < 40; ++i) writer.write(Frame(i));
  return path;
}

void PutUint32(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (8 * i));
}

/// Moves an MP4's index (moov) in front of its pictures (mdat), as for streaming: only such a file
/// can be opened at all once its tail is lost.
std::string IndexFirst(const std::string& bytes) {
  const auto big = [](const std::string& text, std::size_t at) {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(text[at + i]);
    return value;
  };
  const std::size_t ftyp_end = big(bytes, 0);
  const std::size_t moov_at = bytes.find("moov") - 4;
  std::string moov = bytes.substr(moov_at);
  const auto shift = static_cast<std::uint32_t>(moov.size());
  const std::size_t stco = moov.find("stco");
  const std::uint32_t chunks = big(moov, stco + 8);
  for (std::uint32_t i = 0; i < chunks; ++i) {
    const std::size_t at = stco + 12 + 4 * i;
    const std::uint32_t offset = big(moov, at) + shift;
    for (int b = 0; b < 4; ++b) moov[at + b] = static_cast<char>(offset >> (24 - 8 * b));
  }
  return bytes.substr(0, ftyp_end) + moov + bytes.substr(ftyp_end, moov_at - ftyp_end);
}

class OpenVideoTest : public ::testing::TestWithParam<std::pair<const char*, const char*>> {
 protected:
  TemporaryFolder folder_;
  fs::path Video() {
    return WriteVideo(folder_ / (std::string("v") + GetParam().first), GetParam().second);
  }
};
INSTANTIATE_TEST_SUITE_P(Containers, OpenVideoTest,
                         ::testing::Values(std::pair(".avi", "MJPG"), std::pair(".avi", "XVID"),
                                           std::pair(".mp4", "avc1"), std::pair(".mkv", "MJPG")));

TEST_P(OpenVideoTest, ReadsEveryFrameInOrder) {
  const auto source = OpenVideo(Video());
  ASSERT_TRUE(source) << MessageOf(source);
  EXPECT_EQ((*source)->info().size, (ImageSize{kWidth, kHeight}));
  EXPECT_EQ((*source)->info().content, FrameContent::kColor);
  EXPECT_NEAR((*source)->info().frames_per_second.value(), 10, 1e-6);
  cv::Mat frame;
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE((*source)->Read(frame).value()) << i;
    ASSERT_EQ(frame.type(), CV_8UC3);
    EXPECT_EQ(NumberOf(frame), i);
  }
  EXPECT_FALSE((*source)->Read(frame).value());
  EXPECT_FALSE((*source)->Read(frame).value());
}

TEST_P(OpenVideoTest, SkipsFrames) {
  const auto source = OpenVideo(Video());
  ASSERT_TRUE(source) << MessageOf(source);
  cv::Mat frame;
  EXPECT_EQ((*source)->Skip(0).value(), 0);
  EXPECT_EQ((*source)->Skip(7).value(), 7);
  ASSERT_TRUE((*source)->Read(frame).value());
  EXPECT_EQ(NumberOf(frame), 7);
  EXPECT_EQ((*source)->Skip(3).value(), 3);
  ASSERT_TRUE((*source)->Read(frame).value());
  EXPECT_EQ(NumberOf(frame), 11);
  EXPECT_EQ((*source)->Skip(100).value(), 28);
  EXPECT_FALSE((*source)->Read(frame).value());
}

TEST_P(OpenVideoTest, TruncatedFileFailsAtTheFirstMissingFrame) {
  std::string bytes = Bytes(Video());
  if (GetParam().first == std::string(".mp4")) bytes = IndexFirst(bytes);
  const fs::path cut = folder_ / (std::string("cut") + GetParam().first);
  WriteBytes(cut, bytes);
  {
    const auto whole = OpenVideo(cut);
    ASSERT_TRUE(whole) << MessageOf(whole);
    const Outcome outcome = ReadAll(**whole);
    EXPECT_EQ(outcome.frames, 40);
    EXPECT_EQ(outcome.message, "");
  }
  WriteBytes(cut, bytes.substr(0, bytes.size() * 7 / 10));
  const auto source = OpenVideo(cut);
  ASSERT_TRUE(source) << MessageOf(source);
  const Outcome outcome = ReadAll(**source);
  EXPECT_GT(outcome.frames, 0);
  EXPECT_LT(outcome.frames, 40);
  EXPECT_THAT(outcome.message, HasSubstr(cut.string()));
  EXPECT_THAT(outcome.message, HasSubstr(fmt::format("frame {} is missing", outcome.frames)));
  EXPECT_THAT(outcome.message, HasSubstr("cut short"));
}

TEST_P(OpenVideoTest, CutAnywhereNeverPassesForWhole) {
  const std::string bytes = Bytes(Video());
  const fs::path cut = folder_ / (std::string("cut") + GetParam().first);
  for (std::size_t size = 1; size < bytes.size(); size = size * 3 / 2 + 1) {
    WriteBytes(cut, std::string_view(bytes).substr(0, size));
    const auto source = OpenVideo(cut);
    if (source) {
      EXPECT_NE(ReadAll(**source).message, "") << size << " of " << bytes.size();
    } else {
      EXPECT_THAT(MessageOf(source), HasSubstr(cut.string()));
    }
  }
}

TEST(OpenVideo, CountIsKnownWhereTheStructureVouchesForIt) {
  TemporaryFolder folder;
  EXPECT_EQ(OpenVideo(WriteVideo(folder / "a.avi", "MJPG")).value()->info().frame_count, 40);
  EXPECT_EQ(OpenVideo(WriteVideo(folder / "a.mp4", "avc1")).value()->info().frame_count, 40);
  EXPECT_EQ(OpenVideo(WriteVideo(folder / "a.mkv", "MJPG")).value()->info().frame_count,
            std::nullopt);
}

TEST(OpenVideo, DroppedFramesOfAnAviAreNotMissed) {
  // An AVI marks a dropped frame by a chunk of no bytes: the header counts it, nobody can decode
  // it.
  TemporaryFolder folder;
  std::string bytes = Bytes(WriteVideo(folder / "a.avi", "MJPG"));
  const std::size_t index = bytes.rfind("idx1");
  ASSERT_NE(index, std::string::npos);
  for (int frame = 30; frame < 40; ++frame) PutUint32(bytes, index + 8 + 16 * frame + 12, 0);
  WriteBytes(folder / "dropped.avi", bytes);
  EXPECT_EQ(OpenVideo(folder / "dropped.avi").value()->info().frame_count, 30);
}

TEST(OpenVideo, PaddingAfterTheVideoIsNoTruncation) {
  TemporaryFolder folder;
  for (const auto& [name, codec] : {std::pair("a.avi", "MJPG"), std::pair("a.mp4", "avc1")}) {
    const std::string bytes = Bytes(WriteVideo(folder / name, codec));
    for (const std::string& padding :
         {std::string(3, 'x'), std::string(100, '\0'), std::string(100, '\xff')}) {
      WriteBytes(folder / name, bytes + padding);
      const auto source = OpenVideo(folder / name);
      ASSERT_TRUE(source) << MessageOf(source);
      const Outcome outcome = ReadAll(**source);
      EXPECT_EQ(outcome.frames, 40) << name;
      EXPECT_EQ(outcome.message, "") << name;
    }
  }
  // A writer that was stopped before it filled in the size: the end cannot be judged.
  std::string bytes = Bytes(WriteVideo(folder / "a.avi", "MJPG"));
  PutUint32(bytes, 4, 0);
  WriteBytes(folder / "a.avi", bytes);
  const auto source = OpenVideo(folder / "a.avi");
  ASSERT_TRUE(source) << MessageOf(source);
  EXPECT_EQ((*source)->info().frame_count, std::nullopt);
  EXPECT_EQ(ReadAll(**source).frames, 40);
}

TEST(OpenVideo, RefusesWhatIsNoVideo) {
  TemporaryFolder folder;
  EXPECT_THAT(MessageOf(OpenVideo(folder / "none.mp4")), HasSubstr("none.mp4: no such file"));
  EXPECT_THAT(MessageOf(OpenVideo(folder.path())), HasSubstr("is not a file"));
  WriteBytes(folder / "zero.mp4", "");
  EXPECT_THAT(MessageOf(OpenVideo(folder / "zero.mp4")), HasSubstr("zero.mp4: is empty"));
  for (const char* name : {"text.mp4", "text.avi", "text.txt"}) {
    WriteBytes(folder / name, "This is no video.\nIt is a text.\n");
    EXPECT_THAT(MessageOf(OpenVideo(folder / name)), HasSubstr("is a text file"));
  }
  WriteBytes(folder / "list.mp4", "#EXTM3U\nhttp://127.0.0.1:1/x.ts\n");
  EXPECT_THAT(MessageOf(OpenVideo(folder / "list.mp4")), HasSubstr("is a text file"));
  WriteBytes(folder / "noise.avi", std::string("RIFF\xff\xff\xff\xff"
                                               "AVI LIST\x01\x02\x03",
                                               19));
  EXPECT_THAT(MessageOf(OpenVideo(folder / "noise.avi")),
              HasSubstr("cannot be decoded as a video"));
}

TEST(OpenVideo, RefusesAnAviWithoutFrames) {
  TemporaryFolder folder;
  {
    cv::VideoWriter writer((folder / "e.avi").string(), cv::CAP_FFMPEG,
                           cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10, {kWidth, kHeight});
  }
  EXPECT_THAT(MessageOf(OpenVideo(folder / "e.avi")), HasSubstr("e.avi: "));
}

TEST(OpenVideo, ReadsTheRecordingOfOpencvDoc) {
  const fs::path path = "/usr/share/doc/opencv-doc/examples/data/vtest.avi";
  if (!fs::exists(path)) GTEST_SKIP() << "package opencv-doc is not installed";
  const auto source = OpenVideo(path);
  ASSERT_TRUE(source) << MessageOf(source);
  EXPECT_EQ((*source)->info().frame_count, 795);
  EXPECT_EQ((*source)->info().size, (ImageSize{768, 576}));
  EXPECT_EQ((*source)->Skip(10'000).value(), 795);
}

}  // namespace
}  // namespace vantage
