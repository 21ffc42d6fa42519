// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/rehearsal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;
using testing::TemporaryFolder;

constexpr PersonOptions kPerson = {.width_m = 0.62, .height_m = 1.6};

/// One camera and its masks of a person who walks through the area again and again.
class OneCamera : public ::testing::Test {
 protected:
  explicit OneCamera(const std::string& person = "") { Write(person); }

  void Write(const std::string& person) const {
    EXPECT_TRUE(WriteTextFile(folder_ / "scene.toml", R"(
name = "one"
frames_per_second = 4.0
[area]
polygon = [[-4.0, -3.0], [4.0, -3.0], [4.0, 3.0], [-4.0, 3.0]]
[grid]
cell = 0.5
)" + person + R"(
[[cameras]]
name = "south"
source = { masks = "south/%06d.png" }
[cameras.calibration.pinhole]
size_px = [640, 480]
focal_px = [480.0, 480.0]
center_px = [319.5, 239.5]
rotation = [[1.0, 0.0, 0.0], [0.0, -0.4472136, -0.8944272], [0.0, 0.8944272, -0.4472136]]
translation_m = [0.0, 0.0, 11.1803399]
)"));
  }

  Scene Load() const { return LoadScene(folder_ / "scene.toml").value(); }

  Result<PersonReport> Person(int threads = 1) const {
    VANTAGE_ASSIGN_OR_RETURN(Rehearsed rehearsed, Rehearse(Load(), {}, threads));
    return std::move(rehearsed.person);
  }

  void Draw(int frames) const {
    const Scene scene = Load();
    std::filesystem::create_directories(folder_ / "south");
    for (int frame = 0; frame < frames; ++frame) {
      cv::Mat mask = cv::Mat::zeros(480, 640, CV_8UC1);
      const double x_m = -3 + 6.0 * (frame % 23) / 22;
      const PixelBox box =
          PersonBox(scene.cameras[0].camera, {x_m, 0.03 * (frame % 17)}, kPerson).value();
      const cv::Rect pixels(
          cv::Point(static_cast<int>(std::ceil(box.min_x)), static_cast<int>(std::ceil(box.min_y))),
          cv::Point(static_cast<int>(std::floor(box.max_x)) + 1,
                    static_cast<int>(std::floor(box.max_y)) + 1));
      mask(pixels) = 255;
      cv::imwrite((folder_ / fmt::format("south/{:06d}.png", frame)).string(), mask);
    }
  }

  TemporaryFolder folder_;
};

TEST_F(OneCamera, SizeIsFoundWhereTheSceneLeavesItOpen) {
  Draw(120);
  const Scene scene = Load();
  const auto report = Person();
  ASSERT_TRUE(report) << MessageOf(report);
  EXPECT_TRUE(report->found);
  // The drawn width and the allowance for cells of 0.5 m, which is larger than that for the spread.
  EXPECT_NEAR(report->used.width_m, 0.62 + 0.25, 0.04);
  EXPECT_NEAR(report->used.height_m, 1.6, 0.05);
  EXPECT_EQ(report->used.shape, PersonOptions().shape);
  ASSERT_TRUE(report->measured);
  EXPECT_EQ(report->measured->frames, 60);  // every half second
  EXPECT_THAT(TextOf(*report), HasSubstr("measured on 60 of 60 figures"));
  const auto json = JsonOf(*report, scene);
  EXPECT_EQ(json["width"], report->used.width_m);
  EXPECT_EQ(json["width_source"], "measured");
  EXPECT_EQ(json["measured"]["cameras"]["south"]["counted"], 60);
  // Threads do not matter.
  const auto parallel = Person(3);
  ASSERT_TRUE(parallel);
  EXPECT_EQ(parallel->used.width_m, report->used.width_m);
  EXPECT_EQ(parallel->used.height_m, report->used.height_m);
}

TEST_F(OneCamera, TheBeginningIsSampled) {
  Draw(300);  // 75 s
  const auto report = Person();
  ASSERT_TRUE(report) << MessageOf(report);
  EXPECT_EQ(report->measured->frames, 80);  // of 60 s every third
  Scene scene = Load();
  scene.frame_count = 90;
  const auto shortened = Rehearse(scene, {}, 1);
  ASSERT_TRUE(shortened) << MessageOf(shortened);
  EXPECT_EQ(shortened->person.measured->frames, 45);
}

TEST_F(OneCamera, GivenLengthsArePreferred) {
  Write("[person]\nheight = 2.0\n");
  Draw(120);
  const Scene scene = Load();
  const auto report = Person();
  ASSERT_TRUE(report) << MessageOf(report);
  EXPECT_NEAR(report->used.width_m, 0.62 + 0.25, 0.04);
  EXPECT_EQ(report->used.height_m, 2.0);
  EXPECT_EQ(JsonOf(*report, scene)["height_source"], "given");
}

TEST_F(OneCamera, NothingIsMeasuredWhenBothAreGiven) {
  Write("[person]\nwidth = 0.7\nheight = 2.0\n");
  Draw(20);
  const auto report = Person();
  ASSERT_TRUE(report) << MessageOf(report);
  EXPECT_EQ(report->used.width_m, 0.7);
  EXPECT_FALSE(report->measured);
  EXPECT_FALSE(report->found);
  EXPECT_EQ(TextOf(*report), "0.70 m wide, 2.00 m high");
}

TEST_F(OneCamera, TooFewFiguresGiveTheDefaultAndSaySo) {
  Write("[person]\nwidth = \"auto\"\nheight = \"auto\"\n");
  Draw(20);
  const Scene scene = Load();
  const auto report = Person();
  ASSERT_TRUE(report) << MessageOf(report);
  EXPECT_FALSE(report->found);
  EXPECT_EQ(report->used.width_m, PersonOptions().width_m + CellAllowance_m(0.5));
  EXPECT_EQ(report->used.height_m, PersonOptions().height_m);
  EXPECT_THAT(TextOf(*report), HasSubstr("default: 10 figures"));
  EXPECT_EQ(JsonOf(*report, scene)["width_source"], "default");
}

/// The same camera delivers pictures; somebody stands in the middle at first.
class ColorCamera : public OneCamera {
 protected:
  static constexpr int kFrames = 80;
  static constexpr int kStays = 24;

  ColorCamera() {
    std::filesystem::create_directories(folder_ / "south");
    for (int frame = 0; frame < kFrames; ++frame) {
      cv::Mat picture(480, 640, CV_8UC3, cv::Scalar(90, 90, 90));
      if (frame < kStays) picture(kSomebody) = cv::Scalar(20, 20, 200);
      picture(cv::Rect(0, 0, 8, 8)) = cv::Scalar::all(frame);  // which frame it is
      cv::imwrite((folder_ / fmt::format("south/{:06d}.png", frame)).string(), picture);
    }
    std::string text = ReadTextFile(folder_ / "scene.toml").value();
    text.replace(text.find("masks ="), 7, "pictures =");
    EXPECT_TRUE(WriteTextFile(folder_ / "scene.toml", text));
  }

  /// The first frame that follows, and its mask.
  static cv::Mat FirstMask(Rehearsed& rehearsed) {
    cv::Mat picture, mask;
    EXPECT_TRUE(rehearsed.stream.Read(0, 0, picture).value());
    EXPECT_EQ(picture.at<cv::Vec3b>(0, 0)[0], 0) << "the recording begins again";
    EXPECT_TRUE(rehearsed.stream.Subtract(0, picture, {}, mask));
    return mask;
  }

  const cv::Rect kSomebody{300, 200, 40, 90};
};

TEST_F(ColorCamera, LearnsTheBackgroundAhead) {
  for (const int threads : {1, 3}) {
    BackgroundOptions options;
    options.rehearsal.rehearsal_secs = 2 * kFrames / Load().frames_per_second;
    auto rehearsed = Rehearse(Load(), options, threads);
    ASSERT_TRUE(rehearsed) << MessageOf(rehearsed);
    EXPECT_EQ(rehearsed->stream.subtractors()[0]->report().rehearsed, kFrames / 2);
    EXPECT_EQ(rehearsed->person.measured->frames, 30);
    EXPECT_NEAR(cv::countNonZero(FirstMask(*rehearsed)(kSomebody)), kSomebody.area(), 40);
  }
}

TEST_F(ColorCamera, ForgetsWhatItLearntWhereThereIsNoRehearsal) {
  auto measured = Rehearse(Load(), {}, 2);  // too short
  ASSERT_TRUE(measured) << MessageOf(measured);
  EXPECT_EQ(measured->stream.subtractors()[0]->report().rehearsed, 0);
  EXPECT_EQ(measured->person.measured->frames, 30);
  EXPECT_EQ(cv::countNonZero(FirstMask(*measured)), 0);
}

TEST_F(OneCamera, ErrorsOfTheSourcesAndCtrlCAreReported) {
  EXPECT_THAT(MessageOf(Person()), HasSubstr("camera south"));
  Draw(3);
  const std::atomic<bool> stop{true};
  EXPECT_THAT(MessageOf(Rehearse(Load(), {}, 1, {.progress = {}, .stop = &stop})),
              HasSubstr("interrupted"));
}

}  // namespace
}  // namespace vantage
