// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/experiments/picture_uri.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;

TEST(Base64, TheExamplesOfTheStandard) {
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foo"), "Zm9v");
  EXPECT_EQ(Base64("foob"), "Zm9vYg==");
  EXPECT_EQ(Base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(Base64("\xff\xef\xbe"), "/+++");
}

/// The inverse, for these tests.
std::vector<unsigned char> Decoded(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(kDigits.find(c));
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<unsigned char>(bits >> count & 255u));
  }
  return bytes;
}

TEST(PictureUri, APngIsTheSamePicture) {
  cv::Mat mask(30, 40, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(5, 6, 11, 9)) = 255;
  const std::string uri = PictureUri(mask, PictureFormat::kPng).value();
  const std::string head = "data:image/png;base64,";
  ASSERT_EQ(uri.substr(0, head.size()), head);
  const cv::Mat back = cv::imdecode(Decoded(std::string_view(uri).substr(head.size())), 0);
  ASSERT_EQ(back.size(), mask.size());
  EXPECT_EQ(cv::norm(back, mask, cv::NORM_INF), 0);
}

TEST(PictureUri, WidePicturesAreReduced) {
  const cv::Mat wide(100, 1000, CV_8UC3, cv::Scalar(10, 200, 90));
  const std::string uri = PictureUri(wide, PictureFormat::kJpeg, 200).value();
  const std::string head = "data:image/jpeg;base64,";
  ASSERT_EQ(uri.substr(0, head.size()), head);
  const cv::Mat back =
      cv::imdecode(Decoded(std::string_view(uri).substr(head.size())), cv::IMREAD_COLOR);
  EXPECT_EQ(back.size(), cv::Size(200, 20));
  EXPECT_LT(cv::norm(back.at<cv::Vec3b>(10, 100), cv::Vec3b(10, 200, 90), cv::NORM_INF), 5);
}

TEST(PictureUri, WhatIsNoPicture) {
  EXPECT_THAT(MessageOf(PictureUri(cv::Mat(), PictureFormat::kPng)), HasSubstr("8 bits"));
  EXPECT_THAT(MessageOf(PictureUri(cv::Mat(3, 3, CV_32FC1, cv::Scalar(0)), PictureFormat::kPng)),
              HasSubstr("8 bits"));
}

}  // namespace
}  // namespace vantage
