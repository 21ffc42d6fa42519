// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/video/open.h"
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

/// A flat grey frame whose level is its number, with a coloured spot.
cv::Mat Frame(int number) {
  cv::Mat frame(kHeight, kWidth, CV_8UC3, cv::Scalar::all(number));
  cv::rectangle(frame, {number, 10, 20, 20}, {0, 0, 255}, cv::FILLED);
  return frame;
}
int NumberOf(const cv::Mat& frame) { return frame.at<cv::Vec3b>(kHeight - 4, kWidth - 4)[1]; }

void WriteVideo(const fs::path& path, const cv::Mat& frame) {
  cv::VideoWriter writer(path.string(), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                         10, frame.size());
  for (int i = 0; i < 3; ++i) writer.write(frame);
}

class OpenPicturesTest : public ::testing::Test {
 protected:
  fs::path Write(const std::string& name, const cv::Mat& picture) {
    EXPECT_TRUE(cv::imwrite((folder_ / name).string(), picture));
    return folder_ / name;
  }
  TemporaryFolder folder_;
};

TEST_F(OpenPicturesTest, NumberedFromTheLowestNumber) {
  for (int i = 8; i < 13; ++i) Write(fmt::format("f{:06}.png", i), Frame(i));
  Write("f7.png", Frame(7));  // not a name that %06d makes
  Write("other.png", Frame(1));
  const auto source = OpenPictures(folder_ / "f%06d.png");
  ASSERT_TRUE(source) << MessageOf(source);
  EXPECT_EQ((*source)->info().frame_count, 5);
  cv::Mat frame;
  for (int i = 8; i < 13; ++i) {
    ASSERT_TRUE((*source)->Read(frame).value());
    EXPECT_EQ(cv::norm(frame, Frame(i), cv::NORM_INF), 0) << i;
  }
  EXPECT_FALSE((*source)->Read(frame).value());
}

TEST_F(OpenPicturesTest, PlainNumbersPassTheTens) {
  for (int i = 8; i < 13; ++i) Write(fmt::format("f{}.png", i), Frame(i));
  const auto source = OpenPictures(folder_ / "f%d.png");
  ASSERT_TRUE(source) << MessageOf(source);
  cv::Mat frame;
  EXPECT_EQ((*source)->Skip(3).value(), 3);
  ASSERT_TRUE((*source)->Read(frame).value());
  EXPECT_EQ(NumberOf(frame), 11);
  EXPECT_EQ((*source)->Skip(9).value(), 1);
}

TEST_F(OpenPicturesTest, GapNamesTheMissingFile) {
  for (const int i : {3, 4, 6}) Write(fmt::format("{:03}.png", i), Frame(i));
  const std::string message = MessageOf(OpenPictures(folder_ / "%03d.png"));
  EXPECT_THAT(message, HasSubstr((folder_ / "005.png").string() + ": is missing"));
}

TEST_F(OpenPicturesTest, RefusesOtherPatterns) {
  Write("1.png", Frame(1));
  for (const char* name :
       {"%s.png", "%d%d.png", "%5d.png", "%", "%0d.png", "%099d.png", "%%d.png", "%n"}) {
    EXPECT_THAT(MessageOf(OpenPictures(folder_ / name)), HasSubstr("one %d or %0Nd")) << name;
  }
  EXPECT_THAT(MessageOf(OpenPictures(folder_ / "%04d.png")), HasSubstr("no file has a name"));
  EXPECT_THAT(MessageOf(OpenPictures(folder_ / "none" / "%d.png")), HasSubstr("cannot be read"));
}

TEST_F(OpenPicturesTest, FolderInOrderOfNames) {
  for (const int i : {10, 9, 1, 2}) Write(fmt::format("CaVignal_{}.png", i), Frame(i));
  WriteBytes(folder_ / "readme.txt", "no picture");
  const auto source = OpenInput(folder_.path());
  ASSERT_TRUE(source) << MessageOf(source);
  cv::Mat frame;
  for (const int i : {1, 2, 9, 10}) {
    ASSERT_TRUE((*source)->Read(frame).value());
    EXPECT_EQ(NumberOf(frame), i);
  }
}

TEST_F(OpenPicturesTest, GreyAndSixteenBitsBecomeEightBitColour) {
  cv::Mat grey16(kHeight, kWidth, CV_16UC1, cv::Scalar(200 * 257));
  Write("0.png", grey16);
  Write("1.png", cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(200)));
  Write("2.png", cv::Mat(kHeight, kWidth, CV_8UC4, cv::Scalar(200, 200, 200, 7)));
  Write("3.png", cv::Mat(kHeight, kWidth, CV_16UC3, cv::Scalar::all(200 * 257)));
  const auto source = OpenPictures(folder_ / "%d.png");
  ASSERT_TRUE(source) << MessageOf(source);
  cv::Mat frame;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE((*source)->Read(frame).value()) << i;
    ASSERT_EQ(frame.type(), CV_8UC3);
    const cv::Mat expected(kHeight, kWidth, CV_8UC3, cv::Scalar::all(200));
    EXPECT_EQ(cv::norm(frame, expected, cv::NORM_INF), 0) << i;
  }
}

TEST_F(OpenPicturesTest, SizeChangeNamesTheFile) {
  Write("0.png", Frame(0));
  Write("1.png", cv::Mat(10, 20, CV_8UC3, cv::Scalar::all(0)));
  const auto source = OpenPictures(folder_ / "%d.png");
  const Outcome outcome = ReadAll(**source);
  EXPECT_EQ(outcome.frames, 1);
  EXPECT_THAT(outcome.message, HasSubstr("1.png: frame 1 has 20 x 10 px"));
}

TEST_F(OpenPicturesTest, TruncatedPicturesFail) {
  cv::Mat noise(kHeight, kWidth, CV_8UC3);
  cv::randu(noise, 0, 255);
  for (const char* extension : {".png", ".jpg", ".bmp", ".ppm"}) {
    const fs::path whole = Write(std::string("whole") + extension, noise);
    const std::string bytes = Bytes(whole);
    for (const int tenths : {0, 1, 5, 9}) {
      const fs::path folder = folder_ / fmt::format("cut{}{}", tenths, extension);
      fs::create_directory(folder);
      fs::copy_file(whole, folder / (std::string("0") + extension));
      WriteBytes(folder / (std::string("1") + extension),
                 bytes.substr(0, bytes.size() * tenths / 10));
      const auto source = OpenPictures(folder);
      ASSERT_TRUE(source) << MessageOf(source);
      const Outcome outcome = ReadAll(**source);
      EXPECT_EQ(outcome.frames, 1) << folder;
      EXPECT_THAT(outcome.message, HasSubstr(std::string("1") + extension + ": ")) << folder;
    }
  }
}

TEST_F(OpenPicturesTest, HugeDeclaredSizeIsRefusedBeforeDecoding) {
  std::string png = Bytes(Write("small.png", Frame(0)));
  const auto set = [&](std::size_t at, std::uint32_t value) {
    for (int b = 0; b < 4; ++b) png[at + b] = static_cast<char>(value >> (24 - 8 * b));
  };
  set(16, 30000);
  set(20, 30000);
  WriteBytes(folder_ / "1.png", png);
  EXPECT_THAT(MessageOf(OpenPictures(folder_ / "%d.png")),
              HasSubstr("declares pictures of 30000 x 30000"));
  WriteBytes(folder_ / "1.ppm", "P6 40000 1 255\n");
  EXPECT_THAT(MessageOf(OpenPictures(folder_ / "%d.ppm")), HasSubstr("40000 x 1"));
}

TEST_F(OpenPicturesTest, MasksAreBlackAndWhite) {
  cv::Mat mask(kHeight, kWidth, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(0, 0, 10, 10)) = 255;
  mask(cv::Rect(10, 0, 10, 10)) = 128;
  mask(cv::Rect(20, 0, 10, 10)) = 127;
  Write("0.png", mask);
  cv::Mat color;
  cv::cvtColor(mask, color, cv::COLOR_GRAY2BGR);
  Write("1.png", color);
  Write("2.png", Frame(2));
  const auto source = OpenMasks(folder_ / "%d.png");
  ASSERT_TRUE(source) << MessageOf(source);
  EXPECT_EQ((*source)->info().content, FrameContent::kMask);
  cv::Mat expected(kHeight, kWidth, CV_8UC1, cv::Scalar(0));
  expected(cv::Rect(0, 0, 20, 10)) = 255;
  cv::Mat frame;
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE((*source)->Read(frame).value());
    ASSERT_EQ(frame.type(), CV_8UC1);
    EXPECT_EQ(cv::norm(frame, expected, cv::NORM_INF), 0);
  }
  EXPECT_THAT(MessageOf((*source)->Read(frame)), HasSubstr("frame 2 is a colour picture"));
}

TEST_F(OpenPicturesTest, MasksFromALossyVideo) {
  cv::Mat mask(kHeight, kWidth, CV_8UC3, cv::Scalar::all(0));
  mask(cv::Rect(16, 16, 32, 32)) = cv::Scalar::all(255);
  WriteVideo(folder_ / "m.avi", mask);
  const auto source = OpenMasks(folder_ / "m.avi");
  ASSERT_TRUE(source) << MessageOf(source);
  cv::Mat frame;
  ASSERT_TRUE((*source)->Read(frame).value());
  EXPECT_EQ(cv::countNonZero(frame), 32 * 32);
}

TEST_F(OpenPicturesTest, OpenInputTellsKindsApart) {
  const fs::path picture = Write("000001.png", Frame(1));
  EXPECT_TRUE(OpenInput(folder_ / "%06d.png"));
  EXPECT_TRUE(OpenInput(folder_.path()));
  WriteVideo(folder_ / "v.avi", Frame(1));
  EXPECT_TRUE(OpenInput(folder_ / "v.avi"));
  EXPECT_THAT(MessageOf(OpenInput(picture)), HasSubstr("is one picture"));
  EXPECT_THAT(MessageOf(OpenInput(folder_ / "none")), HasSubstr("no such file or folder"));
  fs::create_directory(folder_ / "empty");
  EXPECT_THAT(MessageOf(OpenInput(folder_ / "empty")), HasSubstr("no picture in this folder"));
}

}  // namespace
}  // namespace vantage
