// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/metrics/mask_evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "vantage/base/test_support.h"
#include "vantage/video/mask_writer.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::DataFolder;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

constexpr ImageSize kSize{16, 8};

/// Frame k of the truth has k moving pixels, and so has its mask.
class EvaluateMasksTest : public ::testing::Test {
 protected:
  EvaluateMasksTest() {
    fs::create_directories(folder_ / "s/input");
    fs::create_directories(folder_ / "s/groundtruth");
    for (int frame = 0; frame < 10; ++frame) {
      Write(fmt::format("s/input/in{:06}.png", frame + 1), Picture(0));
      Write(fmt::format("s/groundtruth/gt{:06}.png", frame + 1), Picture(frame));
    }
  }
  static cv::Mat Picture(int moving) {
    cv::Mat picture(kSize.height, kSize.width, CV_8UC1, cv::Scalar(0));
    picture(cv::Rect(0, 0, moving, 1)) = 255;
    return picture;
  }
  void Write(const std::string& name, const cv::Mat& picture) {
    ASSERT_TRUE(cv::imwrite((folder_ / name).string(), picture));
  }
  /// Masks of frames [first, last], numbered from `number`.
  fs::path Masks(MaskFormat format, int first, int last, int number = 0) {
    const fs::path path = folder_ / "masks";
    auto writer = MaskWriter::Create(path, format, kSize, 25, true);
    EXPECT_TRUE(writer) << MessageOf(writer);
    for (int frame = first; frame <= last; ++frame) {
      EXPECT_TRUE(writer->Write(number++, Picture(frame)));
    }
    const Status status = writer->Finish();
    EXPECT_TRUE(status) << MessageOf(status);
    return path;
  }
  void Range(const std::string& text) { std::ofstream(folder_ / "s/temporalROI.txt") << text; }
  Result<std::vector<MaskFrameCounts>> Evaluate(const fs::path& masks,
                                                const MaskEvaluationOptions& options = {}) {
    return EvaluateMasks(OpenTruth(folder_ / "s").value(), masks, options);
  }
  static void ExpectPerfect(const Result<std::vector<MaskFrameCounts>>& frames, FrameIndex first,
                            FrameIndex last) {
    ASSERT_TRUE(frames) << MessageOf(frames);
    ASSERT_EQ(std::ssize(*frames), last - first + 1);
    for (const auto& [frame, counts] : *frames) {
      EXPECT_EQ(frame, first++);
      EXPECT_EQ(counts, (MaskCounts{.frames = 1,
                                    .true_positives = frame,
                                    .true_negatives = kSize.width * kSize.height - frame}));
    }
  }
  TemporaryFolder folder_;
};

TEST_F(EvaluateMasksTest, FramesMeetTheirMasks) {
  for (const MaskFormat format : {MaskFormat::kPng, MaskFormat::kVideo}) {
    const fs::path masks = Masks(format, 0, 9);
    ExpectPerfect(Evaluate(masks), 0, 9);
    ExpectPerfect(Evaluate(masks, {.first_frame = 3, .last_frame = 5}), 3, 5);
    ExpectPerfect(Evaluate(masks, {.first_frame = 9, .last_frame = 900}), 9, 9);
    EXPECT_EQ(SumOf(Evaluate(masks).value()).true_positives, 45);
    Range("4 8");
    ExpectPerfect(Evaluate(masks), 3, 7);
    ExpectPerfect(Evaluate(masks, {.first_frame = 5}), 5, 7);
    EXPECT_THAT(MessageOf(Evaluate(masks, {.first_frame = 8})),
                HasSubstr("no truth that counts in frames 8 to"));
    fs::remove(folder_ / "s/temporalROI.txt");
  }
}

TEST_F(EvaluateMasksTest, MasksOfARunBegunLater) {
  ExpectPerfect(Evaluate(Masks(MaskFormat::kPng, 4, 9, 4), {.first_frame = 4}), 4, 9);
  for (const MaskFormat format : {MaskFormat::kPng, MaskFormat::kVideo}) {
    const fs::path masks = Masks(format, 4, 9);
    ExpectPerfect(Evaluate(masks, {.first_frame = 4, .offset_frames = 4}), 4, 9);
    ExpectPerfect(Evaluate(masks, {.first_frame = 6, .offset_frames = 4}), 6, 9);
    EXPECT_THAT(MessageOf(Evaluate(masks, {.offset_frames = 4})),
                HasSubstr("no mask for frame 0, which has truth; the masks are "));
  }
  // Names that count from 1.
  ExpectPerfect(Evaluate(Masks(MaskFormat::kPng, 0, 9, 1), {.offset_frames = -1}), 0, 9);
}

TEST_F(EvaluateMasksTest, MissingMasksAreErrorsThatNameTheFrame) {
  EXPECT_THAT(MessageOf(Evaluate(Masks(MaskFormat::kPng, 0, 6))),
              HasSubstr("no mask for frame 7, which has truth; the masks are of frames 0 to 6"));
  EXPECT_THAT(MessageOf(Evaluate(Masks(MaskFormat::kVideo, 0, 6))),
              HasSubstr("no mask for frame 7, which has truth; the masks are of frames 0 to 6"));
  const fs::path masks = Masks(MaskFormat::kPng, 0, 9);
  fs::remove(masks / "000005.png");
  EXPECT_THAT(MessageOf(Evaluate(masks)), HasSubstr("no mask for frame 5"));
  fs::remove(folder_ / "s/groundtruth/gt000006.png");
  EXPECT_EQ(Evaluate(masks).value().size(), 9u);  // frame 5 has no truth either
}

TEST_F(EvaluateMasksTest, HostileMasksAndTruth) {
  EXPECT_THAT(MessageOf(Evaluate(folder_ / "none")), HasSubstr("none: no such file or folder"));
  const fs::path masks = Masks(MaskFormat::kPng, 0, 9);
  EXPECT_THAT(MessageOf(Evaluate(masks, {.first_frame = 5, .last_frame = 4})),
              HasSubstr("frames that count are 5 to 4"));
  EXPECT_THAT(MessageOf(Evaluate(masks, {.offset_frames = INT64_MIN})), HasSubstr("the offset"));

  Write("masks/000004.png", cv::Mat(8, 16, CV_8UC3, cv::Scalar(0, 0, 255)));
  EXPECT_THAT(MessageOf(Evaluate(masks)), HasSubstr("is a colour picture"));
  Write("masks/000004.png", cv::Mat(9, 16, CV_8UC1, cv::Scalar(0)));
  EXPECT_THAT(MessageOf(Evaluate(masks)), HasSubstr("000004.png: frame 4 has 16 x 9 px"));
  Write("masks/000004.png", Picture(4));
  Write("s/groundtruth/gt000003.png", cv::Mat(8, 16, CV_8UC1, cv::Scalar(7)));
  EXPECT_THAT(MessageOf(Evaluate(masks)), HasSubstr("gt000003.png: pixel (0, 0) has the label 7"));
  Write("s/groundtruth/gt000003.png", cv::Mat(9, 16, CV_8UC1, cv::Scalar(0)));
  EXPECT_THAT(MessageOf(Evaluate(masks)), HasSubstr("gt000003.png: has 16 x 9 px"));

  const fs::path large = folder_ / "large";
  fs::create_directory(large);
  Write("large/000000.png", cv::Mat(32, 64, CV_8UC1, cv::Scalar(0)));
  EXPECT_THAT(MessageOf(Evaluate(large)), HasSubstr("the masks have 64 x 32 px, the truth"));
}

TEST_F(EvaluateMasksTest, RegionIsRespected) {
  cv::Mat roi(kSize.height, kSize.width, CV_8UC1, cv::Scalar(255));
  roi.colRange(0, 4) = 0;
  Write("s/ROI.bmp", roi);
  const auto frames = Evaluate(Masks(MaskFormat::kPng, 0, 9));
  ASSERT_TRUE(frames) << MessageOf(frames);
  EXPECT_EQ(frames->at(3).counts.true_positives, 0);
  EXPECT_EQ(frames->at(9).counts.true_positives, 5);
  EXPECT_EQ(frames->at(9).counts.true_negatives, 12 * 8 - 5);
}

TEST_F(EvaluateMasksTest, Stops) {
  const std::atomic<bool> stop = true;
  const auto frames = EvaluateMasks(OpenTruth(folder_ / "s").value(), Masks(MaskFormat::kPng, 0, 9),
                                    {}, {.progress = {}, .stop = &stop});
  EXPECT_THAT(MessageOf(frames), HasSubstr("interrupted"));
}

TEST(RealSequences, TruthAgainstItselfIsPerfect) {
  if (DataFolder().empty()) GTEST_SKIP() << "no research data";
  // Pixels of the labels that count, found by another program.
  const fs::path folder = DataFolder() / "sbi/IBMtest2";
  const Result<TruthSequence> truth = OpenTruth(folder);
  ASSERT_TRUE(truth) << MessageOf(truth);
  const auto frames = EvaluateMasks(*truth, folder / "groundtruth");
  ASSERT_TRUE(frames) << MessageOf(frames);
  const MaskCounts sum = SumOf(*frames);
  EXPECT_EQ(sum,
            (MaskCounts{.frames = 90, .true_positives = 312'284, .true_negatives = 6'480'594}));
}

}  // namespace
}  // namespace vantage
