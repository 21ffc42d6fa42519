// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/video/sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "vantage/base/test_support.h"
#include "vantage/video/mask_writer.h"
#include "vantage/video/open.h"
#include "vantage/video/test_sources.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::DataFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::MessageOf;
using testing::TemporaryFolder;
using testing::WriteBytes;

constexpr int kWidth = 8;
constexpr int kHeight = 6;

cv::Mat Grey(int level, int width = kWidth, int height = kHeight) {
  return cv::Mat(height, width, CV_8UC1, cv::Scalar(level));
}

/// Six pictures, numbered 1 to 6 as CDnet's, with truth for each.
class SequenceTest : public ::testing::Test {
 protected:
  SequenceTest() {
    fs::create_directories(folder_ / "s/input");
    fs::create_directories(folder_ / "s/groundtruth");
    for (int number = 1; number <= 6; ++number) {
      Write(fmt::format("input/in{:06}.jpg", number), Grey(number));
      Write(Truth(number), Grey(TruthLabel::kStatic));
    }
  }
  static std::string Truth(int number) { return fmt::format("groundtruth/gt{:06}.png", number); }
  void Write(const std::string& name, const cv::Mat& picture) {
    ASSERT_TRUE(cv::imwrite((sequence() / name).string(), picture));
  }
  void Range(std::string_view text) { WriteBytes(sequence() / "temporalROI.txt", text); }
  fs::path sequence() const { return folder_ / "s"; }
  Result<TruthSequence> Open() const { return OpenTruth(sequence()); }
  std::vector<FrameIndex> Frames() const {
    const Result<TruthSequence> truth = Open();
    EXPECT_TRUE(truth) << MessageOf(truth);
    std::vector<FrameIndex> frames;
    if (truth) {
      for (const auto& [frame, path] : truth->masks) frames.push_back(frame);
    }
    return frames;
  }

  TemporaryFolder folder_;
};

TEST_F(SequenceTest, TruthBelongsToThePictureWithTheSameNumber) {
  const Result<TruthSequence> truth = Open();
  ASSERT_TRUE(truth) << MessageOf(truth);
  EXPECT_EQ(truth->masks.size(), 6u);
  EXPECT_EQ(truth->masks.at(0).filename(), "gt000001.png");
  EXPECT_EQ(truth->input, sequence() / "input");
  EXPECT_EQ(truth->size, (ImageSize{kWidth, kHeight}));
  EXPECT_TRUE(truth->roi.empty());
  EXPECT_EQ(truth->frames_without_truth, 0);
  EXPECT_THAT(truth->notes, IsEmpty());
}

TEST_F(SequenceTest, InputIsThePictures) {
  Write("ROI.bmp", Grey(255));
  const auto source = OpenInput(sequence());
  ASSERT_TRUE(source) << MessageOf(source);
  EXPECT_EQ((*source)->info().frame_count, 6);
}

TEST_F(SequenceTest, OtherNamesAndNumbersFromZero) {
  fs::remove_all(sequence());
  fs::create_directories(sequence() / "input");
  fs::create_directories(sequence() / "groundtruth");
  for (int number = 0; number < 12; ++number) {
    Write(fmt::format("input/Ca2Vignal_{}.png", number), Grey(number));
    if (number % 5 == 0) Write(Truth(number), Grey(0));
  }
  EXPECT_THAT(Frames(), ElementsAre(0, 5, 10));
  EXPECT_EQ(Open()->frames_without_truth, 9);
}

TEST_F(SequenceTest, TemporalRangeCountsByTheNumbersOfThePictures) {
  Range("3 5");
  EXPECT_THAT(Frames(), ElementsAre(2, 3, 4));
  Range("\t2\r\n4 \n");
  EXPECT_THAT(Frames(), ElementsAre(1, 2, 3));
  Range("0 900");
  EXPECT_THAT(Frames(), ElementsAre(0, 1, 2, 3, 4, 5));
  fs::remove(sequence() / Truth(4));
  Range("3 5");
  EXPECT_THAT(Frames(), ElementsAre(2, 4));
  EXPECT_EQ(Open()->frames_without_truth, 1);
}

TEST_F(SequenceTest, GarbageForATemporalRange) {
  for (const char* text : {"", "3", "5 3", "-1 4", "1 2 3", "one two", "1.5 3", "nan nan",
                           "1 99999999999999999999999", "\x01\x02"}) {
    Range(text);
    EXPECT_THAT(MessageOf(Open()), HasSubstr("temporalROI.txt: must hold two numbers")) << text;
  }
  Range(std::string(10'000, '1'));
  EXPECT_THAT(MessageOf(Open()), HasSubstr("temporalROI.txt: "));
  Range("7 9");
  EXPECT_THAT(MessageOf(Open()), HasSubstr("no picture from 7 to 9 has truth"));
}

TEST_F(SequenceTest, RegionIsTheFirstGreyPictureThatFits) {
  cv::Mat half = Grey(0);
  half.colRange(0, 4) = 200;
  Write("ROI.bmp", Grey(255, 10, kHeight));
  Write("ROI.jpg", half);
  const Result<TruthSequence> truth = Open();
  ASSERT_TRUE(truth) << MessageOf(truth);
  EXPECT_THAT(truth->notes, IsEmpty());
  cv::Mat expected = Grey(0);
  expected.colRange(0, 4) = 255;
  ASSERT_EQ(truth->roi.size(), expected.size());
  EXPECT_EQ(cv::norm(truth->roi, expected, cv::NORM_INF), 0);

  Write("ROI.bmp", Grey(255));
  EXPECT_EQ(cv::countNonZero(Open()->roi), kWidth * kHeight);
}

TEST_F(SequenceTest, RegionsThatDoNotFitAreNotedAndPassedOver) {
  Write("ROI.bmp", Grey(255, kWidth, 10));
  Write("ROI.jpg", cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar(20, 30, 200)));  // a tint
  const Result<TruthSequence> truth = Open();
  ASSERT_TRUE(truth) << MessageOf(truth);
  EXPECT_TRUE(truth->roi.empty());
  EXPECT_THAT(truth->notes,
              ElementsAre(HasSubstr("ROI.bmp is not used: it has 8 x 10 px, the truth 8 x 6"),
                          HasSubstr("ROI.jpg is not used: it is a coloured picture")));
}

TEST_F(SequenceTest, HostileRegions) {
  Write("ROI.bmp", Grey(0));
  EXPECT_THAT(MessageOf(Open()), HasSubstr("ROI.bmp: is black"));
  WriteBytes(sequence() / "ROI.bmp", "BMP?");
  EXPECT_THAT(MessageOf(Open()), HasSubstr("ROI.bmp: "));
}

TEST_F(SequenceTest, HostileFolders) {
  EXPECT_THAT(MessageOf(OpenTruth(folder_ / "none")), HasSubstr("none: no such folder"));
  fs::create_directory(folder_ / "empty");
  EXPECT_THAT(MessageOf(OpenTruth(folder_ / "empty")), HasSubstr("no picture in this folder"));

  Write(Truth(7), Grey(0));
  EXPECT_THAT(MessageOf(Open()), HasSubstr("gt000007.png: belongs to no picture"));
  fs::remove(sequence() / Truth(7));
  Write("groundtruth/mask.png", Grey(0));
  EXPECT_THAT(MessageOf(Open()), HasSubstr("mask.png: has no frame number"));
  fs::remove(sequence() / "groundtruth/mask.png");
  Write("groundtruth/other3.png", Grey(0));
  EXPECT_THAT(MessageOf(Open()), HasSubstr("other3.png: has the same number as gt000003.png"));
  fs::remove(sequence() / "groundtruth/other3.png");
  WriteBytes(sequence() / Truth(1), "no picture");
  EXPECT_THAT(MessageOf(Open()), HasSubstr("gt000001.png: "));

  fs::remove_all(sequence() / "input");
  EXPECT_THAT(MessageOf(Open()), HasSubstr("input: no such folder; without the pictures name"));
}

TEST_F(SequenceTest, PlainFolderCountsByTheNumbersInTheNames) {
  const Result<TruthSequence> truth = OpenTruth(sequence() / "groundtruth");
  ASSERT_TRUE(truth) << MessageOf(truth);
  EXPECT_EQ(truth->masks.begin()->first, 1);
  EXPECT_EQ(truth->masks.rbegin()->first, 6);
  EXPECT_TRUE(truth->input.empty());
}

TEST_F(SequenceTest, FindsSequencesInFolders) {
  for (const char* name : {"root/b/one", "root/a", "root/c/d/two", "root/c/d/e/too_deep"}) {
    fs::create_directories(folder_ / name / "input");
    fs::create_directories(folder_ / name / "groundtruth");
  }
  const fs::path root = folder_ / "root";
  EXPECT_THAT(FindSequences(root), ElementsAre(root / "a", root / "b/one", root / "c/d/two"));
  EXPECT_THAT(FindSequences(sequence()), ElementsAre(sequence()));
  EXPECT_THAT(FindSequences(folder_ / "none"), IsEmpty());
  EXPECT_THAT(FindSequences(sequence() / "input"), IsEmpty());
}

TEST_F(SequenceTest, TruthMasksAreGreyAndOfOneSize) {
  const fs::path path = folder_ / "t.png";
  const auto read = [&](const cv::Mat& picture) {
    EXPECT_TRUE(cv::imwrite(path.string(), picture));
    return ReadTruthMask(path, {kWidth, kHeight});
  };
  const Result<cv::Mat> grey = read(Grey(170));
  ASSERT_TRUE(grey) << MessageOf(grey);
  EXPECT_EQ(grey->type(), CV_8UC1);
  EXPECT_EQ(cv::norm(*grey, Grey(170), cv::NORM_INF), 0);
  const Result<cv::Mat> spread =
      read(cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar::all(TruthLabel::kUnknown)));
  ASSERT_TRUE(spread) << MessageOf(spread);
  EXPECT_EQ(cv::norm(*spread, Grey(170), cv::NORM_INF), 0);
  EXPECT_THAT(MessageOf(read(cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar(0, 0, 1)))),
              HasSubstr("t.png: is a colour picture"));
  EXPECT_THAT(MessageOf(read(Grey(0, 5))), HasSubstr("5 x 6 px; the first truth mask has 8 x 6"));
}

TEST_F(SequenceTest, NumberedMasks) {
  fs::create_directory(folder_ / "m");
  const cv::Mat mask = Grey(255);
  for (const int frame : {9, 10, 12}) ASSERT_TRUE(WriteMask(folder_ / "m", frame, mask));
  const Result<NumberedMasks> masks = OpenNumberedMasks(folder_ / "m");
  ASSERT_TRUE(masks) << MessageOf(masks);
  EXPECT_THAT(masks->numbers, ElementsAre(9, 10, 12));

  ASSERT_TRUE(cv::imwrite((folder_ / "m/zz3.png").string(), mask));
  EXPECT_THAT(MessageOf(OpenNumberedMasks(folder_ / "m")),
              HasSubstr("zz3.png: its number is below"));
  EXPECT_THAT(MessageOf(OpenNumberedMasks(sequence())), HasSubstr("pictures and their truth"));
}

// --- The published sequences

TEST(RealSequences, AreUnderstood) {
  if (DataFolder().empty()) GTEST_SKIP() << "no research data";
  struct Expected {
    const char* folder;
    FrameIndex first, last;
    bool has_region;
    std::size_t notes;
  };
  for (const Expected& expected :
       {Expected{"cdnet/office", 569, 2049, true, 0},
        Expected{"cdnet/traffic", 899, 1569, false, 2}, Expected{"sbi/CaVignal", 0, 257, false, 0},
        Expected{"sbi/IBMtest2", 0, 89, true, 0}}) {
    SCOPED_TRACE(expected.folder);
    const Result<TruthSequence> truth = OpenTruth(DataFolder() / expected.folder);
    ASSERT_TRUE(truth) << MessageOf(truth);
    EXPECT_EQ(truth->masks.begin()->first, expected.first);
    EXPECT_EQ(truth->masks.rbegin()->first, expected.last);
    EXPECT_EQ(truth->masks.size(), static_cast<std::size_t>(expected.last - expected.first + 1));
    EXPECT_EQ(truth->frames_without_truth, 0);
    EXPECT_EQ(!truth->roi.empty(), expected.has_region);
    EXPECT_EQ(truth->notes.size(), expected.notes);
    const auto source = OpenInput(DataFolder() / expected.folder);
    ASSERT_TRUE(source) << MessageOf(source);
    EXPECT_GT((*source)->info().frame_count.value(), expected.last);
    EXPECT_EQ((*source)->info().size, truth->size);
  }
}

}  // namespace
}  // namespace vantage
