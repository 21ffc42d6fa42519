// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
// `vantage background` on sequences and `vantage evaluate masks`, as a user runs them.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "test_program.h"
#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/video/open.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::DataFolder;
using testing::Entries;
using testing::ExpectOneLine;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::RunProgram;
using testing::TemporaryFolder;

constexpr int kFrames = 40;

/// A root with the sequences "a" and "b": a bright block crosses a dark picture. Truth is exact, so
/// the block is drawn into good masks by hand.
struct TwoSequences {
  TemporaryFolder folder;

  TwoSequences() {
    for (const char* name : {"a", "b"}) {
      fs::create_directories(folder / "truth" / name / "input");
      fs::create_directories(folder / "truth" / name / "groundtruth");
      fs::create_directories(folder / "masks" / name);
      for (int frame = 0; frame < kFrames; ++frame) {
        const cv::Mat mask = Block(frame, 8);
        Write(fmt::format("truth/{}/groundtruth/gt{:06}.png", name, frame + 1), mask);
        Write(fmt::format("truth/{}/input/in{:06}.png", name, frame + 1), 20 + 0.6 * mask);
        // Those of "b" are too wide: precision is one half.
        const int width = name == std::string("a") ? 8 : 16;
        Write(fmt::format("masks/{}/{:06}.png", name, frame), Block(frame, width));
      }
    }
  }
  static cv::Mat Block(int frame, int width) {
    cv::Mat mask(48, 64, CV_8UC1, cv::Scalar(0));
    mask(cv::Rect(frame, 20, width, 10)) = 255;
    return mask;
  }
  void Write(const std::string& name, const cv::Mat& picture) const {
    EXPECT_TRUE(cv::imwrite((folder / name).string(), picture));
  }
  std::string Truth(const std::string& name = "") const {
    return (folder.path() / "truth" / name).string();
  }
  std::string Masks(const std::string& name = "") const {
    return (folder.path() / "masks" / name).string();
  }
};

nlohmann::json Json(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

Outcome Evaluate(const std::string& truth, const std::string& masks, const std::string& more = "") {
  return RunProgram(fmt::format("evaluate masks --truth '{}' '{}' --quiet {}", truth, masks, more));
}

TEST(EvaluateMasksProgram, OneSequence) {
  const TwoSequences sequences;
  const Outcome table = Evaluate(sequences.Truth("b"), sequences.Masks("b"));
  ASSERT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("precision         0.5000  TP / (TP + FP)"));
  EXPECT_THAT(table.out, HasSubstr("frames                40  that count, from 0 to 39"));
  EXPECT_THAT(table.out, HasSubstr("shadow_fpr             -"));

  const auto json = Json(Evaluate(sequences.Truth("b"), sequences.Masks("b"), "--json"));
  const auto& one = json["sequences"][0];
  EXPECT_EQ(one["name"], "b");
  EXPECT_EQ(one["frames"], kFrames);
  EXPECT_EQ(one["tp"], kFrames * 80);
  EXPECT_EQ(one["fp"], kFrames * 80);
  EXPECT_EQ(one["fn"], 0);
  EXPECT_EQ(one["tn"], kFrames * (64 * 48 - 160));
  EXPECT_EQ(one["recall"], 1.0);
  EXPECT_DOUBLE_EQ(one["f1"], 2.0 / 3);
  EXPECT_TRUE(one["shadow_fpr"].is_null());
  EXPECT_EQ(json["mean"]["f1"], one["f1"]);
  EXPECT_EQ(json["sum"]["tp"], one["tp"]);
}

TEST(EvaluateMasksProgram, SeveralSequencesByRootOrByPairs) {
  const TwoSequences sequences;
  std::ofstream(sequences.folder / "truth/b/temporalROI.txt") << "11 20";
  const Outcome table = Evaluate(sequences.Truth(), sequences.Masks());
  ASSERT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("mean: of the sequences' measures"));

  const auto json = Json(Evaluate(sequences.Truth(), sequences.Masks(), "--json"));
  ASSERT_EQ(json["sequences"].size(), 2u);
  EXPECT_EQ(json["sequences"][0]["name"], "a");
  EXPECT_EQ(json["sequences"][0]["precision"], 1.0);
  EXPECT_EQ(json["sequences"][1]["frames"], 10);
  EXPECT_EQ(json["sequences"][1]["first_frame"], 10);
  EXPECT_EQ(json["sequences"][1]["precision"], 0.5);
  EXPECT_EQ(json["mean"]["precision"], 0.75);
  EXPECT_DOUBLE_EQ(json["sum"]["precision"], 50.0 / 60);  // 50 frames of truth, 10 of errors
  EXPECT_EQ(json["sum"]["frames"], 50);

  const Outcome pairs = RunProgram(fmt::format(
      "evaluate masks --json --quiet --truth '{}' '{}' --truth '{}' '{}'", sequences.Truth("a"),
      sequences.Masks("a"), sequences.Truth("b"), sequences.Masks("b")));
  EXPECT_EQ(Json(pairs)["sum"], json["sum"]);
  EXPECT_EQ(Json(pairs)["mean"], json["mean"]);
}

TEST(EvaluateMasksProgram, FramesOffsetAndCounts) {
  const TwoSequences sequences;
  const std::string counts = (sequences.folder / "counts.csv").string();
  const auto json = Json(Evaluate(sequences.Truth("b"), sequences.Masks("b"),
                                  "--json --frames 3:5 --save-counts '" + counts + "'"));
  EXPECT_EQ(json["sequences"][0]["frames"], 3);
  EXPECT_EQ(ReadTextFile(counts).value_or(""),
            "sequence,frame,tp,fp,fn,tn,shadow_px,shadow_fp\n"
            "b,3,80,80,0,2912,0,0\nb,4,80,80,0,2912,0,0\nb,5,80,80,0,2912,0,0\n");
  // Moved by two pixels, 60 of 80 are still met.
  const auto moved =
      Json(Evaluate(sequences.Truth("a"), sequences.Masks("a"), "--json --frames 2:39 --offset 2"));
  EXPECT_EQ(moved["sequences"][0]["recall"], 0.75);
}

TEST(EvaluateMasksProgram, WrongUse) {
  const TwoSequences sequences;
  const std::string truth = sequences.Truth("a");
  const std::string masks = sequences.Masks("a");
  ExpectOneLine(RunProgram("evaluate masks"), 2, "--truth");
  ExpectOneLine(RunProgram("evaluate"), 2, "subcommand");
  ExpectOneLine(RunProgram("evaluate masks --truth '" + truth + "'"), 2, "required");
  for (const char* frames : {"5", "5:3", "-1:3", "a:b", "1:2:3", ":", "1:"}) {
    ExpectOneLine(Evaluate(truth, masks, fmt::format("--frames={}", frames)), 1, "FIRST:LAST");
  }
  ExpectOneLine(Evaluate(truth, masks, "--frames 40:50"), 1, "no truth that counts");
  ExpectOneLine(Evaluate(truth, masks, "--offset 1"), 1, "no mask for frame 0");
  ExpectOneLine(Evaluate(truth, masks, "'" + masks + "'"), 1, "1 times for 2 folders");
  ExpectOneLine(Evaluate((sequences.folder / "none").string(), masks), 1, "none: no such folder");
  ExpectOneLine(Evaluate(truth, (sequences.folder / "none").string()), 1,
                "none: no such file or folder");
  ExpectOneLine(Evaluate(truth, truth), 1, "pictures and their truth");
  fs::remove_all(sequences.folder / "masks/b");
  ExpectOneLine(Evaluate(sequences.Truth(), sequences.Masks()), 1, "each of the 2 sequences in");
  std::ofstream(sequences.folder / "truth/a/temporalROI.txt") << "from here to there";
  ExpectOneLine(Evaluate(truth, masks), 1, "temporalROI.txt: must hold two numbers");
}

std::vector<cv::Mat> ReadMasks(const fs::path& path) {
  std::vector<cv::Mat> masks;
  auto source = OpenMasks(path);
  EXPECT_TRUE(source) << testing::MessageOf(source);
  cv::Mat mask;
  while (source && (*source)->Read(mask).value_or(false)) masks.push_back(mask.clone());
  return masks;
}

TEST(BackgroundProgram, WritesTheSameMasksAsPicturesAndAsVideo) {
  const TwoSequences sequences;
  const std::string base = sequences.folder.path().string();
  for (const char* format : {"png", "video"}) {
    const Outcome outcome = RunProgram(fmt::format("background '{}' -o '{}/{}' --quiet --format {}",
                                                   sequences.Truth("a"), base, format, format));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  EXPECT_EQ(Entries(base + "/video"), std::vector<std::string>{"masks.mkv"});
  EXPECT_EQ(Entries(base + "/png").size(), std::size_t{kFrames});
  const std::vector<cv::Mat> pictures = ReadMasks(base + "/png");
  const std::vector<cv::Mat> video = ReadMasks(base + "/video");
  ASSERT_EQ(pictures.size(), video.size());
  int foreground_px = 0;
  for (std::size_t frame = 0; frame < pictures.size(); ++frame) {
    EXPECT_EQ(cv::norm(pictures[frame], video[frame], cv::NORM_INF), 0) << frame;
    foreground_px += cv::countNonZero(pictures[frame]);
  }
  EXPECT_GT(foreground_px, 1000);
  const auto by_picture = Json(Evaluate(sequences.Truth("a"), base + "/png", "--json"));
  const auto by_video = Json(Evaluate(sequences.Truth("a"), base + "/video/masks.mkv", "--json"));
  EXPECT_EQ(by_picture["sum"], by_video["sum"]);
  EXPECT_GT(by_picture["sum"]["recall"], 0.5);
}

TEST(BackgroundProgram, StartAndFramesCutTheInput) {
  const TwoSequences sequences;
  const std::string base = sequences.folder.path().string();
  const auto run = [&](const std::string& name, const std::string& more) {
    return RunProgram(fmt::format("background '{}' -o '{}/{}' --quiet {}", sequences.Truth("a"),
                                  base, name, more));
  };
  ASSERT_EQ(run("cut", "--start 10 --frames 5").status, 0);
  EXPECT_EQ(Entries(base + "/cut"),
            (std::vector<std::string>{"000010.png", "000011.png", "000012.png", "000013.png",
                                      "000014.png"}));
  // Begun at frame 10, the model knows nothing of the frames before: as if they did not exist.
  for (int frame = 0; frame < 10; ++frame) {
    fs::remove(sequences.folder.path() / fmt::format("truth/a/input/in{:06}.png", frame + 1));
    fs::remove(sequences.folder.path() / fmt::format("truth/a/groundtruth/gt{:06}.png", frame + 1));
  }
  ASSERT_EQ(run("rest", "--frames 5").status, 0);
  const std::vector<cv::Mat> cut = ReadMasks(base + "/cut");
  const std::vector<cv::Mat> rest = ReadMasks(base + "/rest");
  ASSERT_EQ(cut.size(), 5u);
  ASSERT_EQ(rest.size(), 5u);
  for (std::size_t frame = 0; frame < 5; ++frame) {
    EXPECT_EQ(cv::norm(cut[frame], rest[frame], cv::NORM_INF), 0) << frame;
  }
  ASSERT_EQ(run("video", "--format video --start 5 --frames 900").status, 0);
  EXPECT_EQ(ReadMasks(base + "/video").size(), 25u);

  ExpectOneLine(run("none", "--start 31"), 1, "holds 30 frames; --start must be below that");
  ExpectOneLine(run("none", "--start 30"), 1, "holds no frame from 30 on");
  ExpectOneLine(run("none", "--start -1"), 2, "--start");
  ExpectOneLine(run("none", "--frames 0"), 2, "--frames");
  ExpectOneLine(run("none", "--format avi"), 2, "--format");
  EXPECT_FALSE(fs::exists(base + "/none"));
}

TEST(BackgroundProgram, OutputMayLieBesideTheInputButNotAroundIt) {
  const TwoSequences sequences;
  const std::string truth = sequences.Truth("a");
  fs::create_directory(sequences.folder / "truth/a/out");
  const auto run = [&](const std::string& output) {
    return RunProgram(fmt::format("background '{}/input' -o '{}' --quiet --force", truth, output));
  };
  EXPECT_EQ(run(truth + "/out").status, 0);
  EXPECT_EQ(run(truth + "/out/").status, 0);
  for (const std::string& output : {truth, truth + "/", truth + "/input", truth + "/input/"}) {
    ExpectOneLine(run(output), 1, "would replace the input");
  }
}

TEST(BackgroundProgram, OddSidesAreRefusedBeforeTheWork) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "in");
  EXPECT_TRUE(cv::imwrite((folder / "in/0.png").string(), cv::Mat::zeros(31, 20, CV_8UC3)));
  ExpectOneLine(RunProgram(fmt::format("background '{0}/in' -o '{0}/out' --format video --quiet",
                                       folder.path().string())),
                1, "20 x 31 px do not fit in a lossless video");
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(RealSequences, BackgroundAndItsMeasures) {
  if (DataFolder().empty()) GTEST_SKIP() << "no research data";
  const TemporaryFolder folder;
  for (const char* name : {"IBMtest2", "CaVignal"}) {
    const Outcome outcome =
        RunProgram(fmt::format("background '{}/sbi/{}' -o '{}/{}' --quiet --format video",
                               DataFolder().string(), name, folder.path().string(), name));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  const auto json =
      Json(Evaluate((DataFolder() / "sbi").string(), folder.path().string(), "--json"));
  ASSERT_EQ(json["sequences"].size(), 2u);
  EXPECT_EQ(json["sequences"][0]["frames"], 258);
  EXPECT_EQ(json["sequences"][1]["frames"], 90);
  EXPECT_GT(json["sequences"][1]["f1"], 0.8);

  // CDnet's truth against itself, with its region and its range, shadow apart.
  const fs::path traffic = DataFolder() / "cdnet/traffic";
  const auto self = Json(Evaluate(traffic.string(), (traffic / "groundtruth").string(),
                                  "--json --offset -1 --frames 1000:1019"));
  EXPECT_EQ(self["sum"]["frames"], 20);
  EXPECT_EQ(self["sum"]["f1"], 1.0);
  EXPECT_EQ(self["sequences"][0]["notes"].size(), 2u);
}

}  // namespace
}  // namespace vantage
