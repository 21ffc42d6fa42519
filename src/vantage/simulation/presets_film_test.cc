// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"
#include "vantage/simulation/film.h"
#include "vantage/simulation/presets.h"

namespace vantage::simulation {
namespace {

using vantage::testing::MessageOf;

class PresetsFilmTest : public ::testing::TestWithParam<const char*> {};

TEST_P(PresetsFilmTest, PicturesAreNeitherBurntNorBlackAndShowPeople) {
  const Result<Stage> stage = MakeStage(GetParam(), {.frames = 20, .cameras = 1, .scale = 0.2});
  ASSERT_TRUE(stage.has_value()) << MessageOf(stage);
  Result<Film> film = Film::Create(*stage, 1, 2);
  ASSERT_TRUE(film.has_value()) << MessageOf(film);
  const Result<std::vector<Shot>> shots = film->Shoot(10, 2);
  ASSERT_TRUE(shots.has_value()) << MessageOf(shots);
  const cv::Mat& picture = shots->at(0).picture;
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_GT(cv::mean(picture)[channel], 50);
    EXPECT_LT(cv::mean(picture)[channel], 190);
  }
  cv::Mat gray;
  cv::extractChannel(picture, gray, 1);
  const double pixels = static_cast<double>(gray.total());
  EXPECT_LT(cv::countNonZero(gray > 250) / pixels, 0.05);
  EXPECT_LT(cv::countNonZero(gray < 5) / pixels, 0.05);
  // People of a size that can be tracked, but not everywhere.
  EXPECT_GT(cv::countNonZero(shots->at(0).mask) / pixels, 0.004);
  EXPECT_LT(cv::countNonZero(shots->at(0).mask) / pixels, 0.4);
}

INSTANTIATE_TEST_SUITE_P(Presets, PresetsFilmTest, ::testing::Values("campus", "crowd", "ghosts"));

}  // namespace
}  // namespace vantage::simulation
