// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/scene/blind_pixels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "vantage/base/test_support.h"
#include "vantage/scene/scene.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MessageOf;

/// A camera of 64 x 48 px, 10 m high, that looks down by the angle of 3-4-5.
constexpr char kScene[] = R"(name = "Square"
frames_per_second = 25
[area]
polygon = [[0, 0], [6, 0], [6, 4.5], [0, 4.5]]
[[cameras]]
name = "left"
source = { video = "left.avi" }
blind = BLIND
[cameras.calibration.pinhole]
size_px = [64, 48]
focal_px = [50, 51]
center_px = [31.5, 23.5]
rotation = [[1, 0, 0], [0, -0.6, -0.8], [0, 0.8, -0.6]]
translation_m = [0, 2, 14]
)";

class BlindPixelsTest : public ::testing::Test {
 protected:
  Result<Scene> Load(const std::string& blind) {
    std::string text = kScene;
    text.replace(text.find("BLIND"), 5, blind);
    std::ofstream(folder_ / "scene.toml") << text;
    return LoadScene(folder_ / "scene.toml");
  }
  cv::Mat BlindOf(const std::string& blind) {
    const Result<Scene> scene = Load(blind);
    EXPECT_EQ(MessageOf(scene), "");
    return scene ? scene->cameras.at(0).blind : cv::Mat();
  }
  std::string ErrorOf(const std::string& blind) {
    const std::string message = MessageOf(Load(blind));
    EXPECT_THAT(message, HasSubstr("scene.toml:8: cameras[0].blind: ")) << blind;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message;
  }
  testing::TemporaryFolder folder_;
};

/// A picture with one rectangle that is not 0.
cv::Mat Drawn(ImageSize size, const cv::Rect& rectangle, const cv::Scalar& value) {
  cv::Mat picture = cv::Mat::zeros(size.height, size.width, CV_8UC3);
  picture(rectangle) = value;
  return picture;
}

TEST_F(BlindPixelsTest, PolygonsCoverThePixelsThatTheyTouch) {
  const cv::Mat blind = BlindOf(
      "[[[10, 5], [20, 5], [20, 30], [10, 30]], "
      "[[15, 25], [40, 25], [40, 28], [15, 28]]]");
  ASSERT_EQ(blind.type(), CV_8UC1);
  cv::Mat expected = cv::Mat::zeros(48, 64, CV_8UC1);
  expected(cv::Rect(10, 5, 11, 26)) = 255;
  expected(cv::Rect(15, 25, 26, 4)) = 255;
  EXPECT_EQ(cv::norm(blind, expected, cv::NORM_L1), 0);
}

TEST_F(BlindPixelsTest, APolygonMayLeaveThePicture) {
  const cv::Mat blind = BlindOf("[[[-1000, -20.5], [7.2, -20.5], [7.2, 500], [-1000, 500]]]");
  ASSERT_FALSE(blind.empty());
  EXPECT_EQ(cv::countNonZero(blind), 8 * 48);
  EXPECT_EQ(cv::countNonZero(blind.colRange(0, 8)), 8 * 48);
}

TEST_F(BlindPixelsTest, APictureIsBlindWhereItIsNotBlack) {
  cv::imwrite(folder_ / "blind.png", Drawn({64, 48}, {30, 20, 5, 6}, {0, 0, 1}));
  const Result<Scene> scene = Load("\"blind.png\"");
  ASSERT_EQ(MessageOf(scene), "");
  EXPECT_THAT(scene->inputs, ElementsAre(folder_ / "scene.toml", folder_ / "blind.png"));
  const cv::Mat& blind = scene->cameras[0].blind;
  EXPECT_EQ(cv::countNonZero(blind), 30);
  EXPECT_EQ(cv::countNonZero(blind(cv::Rect(30, 20, 5, 6))), 30);
}

TEST_F(BlindPixelsTest, NoBlindPixelsAreAnEmptyMask) {
  EXPECT_TRUE(BlindOf("[]").empty());
  cv::imwrite(folder_ / "black.png", cv::Mat::zeros(48, 64, CV_8UC1));
  EXPECT_TRUE(BlindOf("\"black.png\"").empty());
}

TEST_F(BlindPixelsTest, ErrorsSayWhatIsWrong) {
  EXPECT_THAT(ErrorOf("3"), HasSubstr("is 3; it must be an array of arrays"));
  EXPECT_THAT(ErrorOf("\"\""), HasSubstr("must be a text in quotes that is not empty"));
  EXPECT_THAT(ErrorOf("[[[1, 1], [5, 1], [5, 5]], [[1, 1], [5, 5]]]"),
              HasSubstr("polygon 2 has 2 corners; it must have 3 to 1000"));
  EXPECT_THAT(ErrorOf("[[[1, 1], [5, nan], [5, 5]]]"), HasSubstr("holds nan"));
  EXPECT_THAT(ErrorOf("[[[1, 1], [5, 1, 2], [5, 5]]]"), HasSubstr("row 2 has 3 numbers"));
  EXPECT_THAT(ErrorOf("[[[1, 1], [1e9, 1], [5, 5]]]"), HasSubstr("polygon 1 holds 1000000000"));
  EXPECT_THAT(ErrorOf("[[[70, 1], [80, 1], [80, 5]]]"),
              HasSubstr("polygon 1 lies outside the 64 x 48 px picture"));
  EXPECT_THAT(ErrorOf("[[[-1, -1], [64, -1], [64, 48], [-1, 48]]]"),
              HasSubstr("covers the whole picture"));
  std::string many = "[";
  for (int i = 0; i <= 1000; ++i) many += "[[1, 1], [5, 1], [5, 5]],";
  EXPECT_THAT(ErrorOf(many + "]"), HasSubstr("has 1001 polygons"));

  cv::imwrite(folder_ / "small.png", Drawn({32, 24}, {1, 1, 2, 2}, cv::Scalar::all(255)));
  EXPECT_THAT(ErrorOf("\"small.png\""), HasSubstr("small.png is 32 x 24 px; it must be 64 x 48"));
  cv::imwrite(folder_ / "white.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(255)));
  EXPECT_THAT(ErrorOf("\"white.png\""), HasSubstr("covers the whole picture"));
  EXPECT_THAT(MessageOf(Load("\"none.png\"")), HasSubstr("none.png: no such file"));
  std::ofstream(folder_ / "text.png") << "no picture";
  EXPECT_THAT(MessageOf(Load("\"text.png\"")), HasSubstr("text.png"));
}

}  // namespace
}  // namespace vantage
