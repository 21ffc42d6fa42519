// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/linking_picture.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "vantage/rendering/palette.h"

namespace vantage {
namespace {

/// Cells of 1 m, 20 x 12, the outer ring being extension; two people for 10 frames, the first
/// missed in frames 4 and 5, the second gone after frame 6.
class LinkingPictureTest : public ::testing::Test {
 protected:
  LinkingPictureTest() {
    maps_.grid = {.min_x_m = -3, .min_y_m = 2, .cell_m = 1, .columns = 20, .rows = 12};
    maps_.first_frame = 100;
    maps_.frames_per_second = 5;
    maps_.in_area.assign(240, 0);
    maps_.visible.assign(240, 1);
    maps_.values.assign(2400, 0);
    paths_.resize(2);
    paths_[1].first_frame = 2;
    for (int frame = 0; frame < 10; ++frame) {
      Add(0, frame, maps_.grid.Index(3 + frame, 3), frame == 4 || frame == 5 ? 0.1F : 0.9F);
      if (frame >= 2 && frame <= 6) Add(1, frame, maps_.grid.Index(4, 8), 0.9F);
    }
  }

  void Add(std::size_t path, int frame, CellIndex cell, float q) {
    paths_[path].cells.push_back(cell);
    maps_.values[static_cast<std::size_t>(frame * 240 + cell)] = q;
  }

  LinkingPicture Draw(double support = 0.5) const { return {scene_, maps_, paths_, support}; }

  static int Count(const cv::Mat& picture, const cv::Scalar& color) {
    cv::Mat found;
    const cv::Scalar near = cv::Scalar::all(12);
    cv::inRange(picture, color - near, color + near, found);
    return cv::countNonZero(found);
  }
  static int Of(const cv::Mat& picture, int path) { return Count(picture, ColorOf(TrackId{path})); }

  Scene scene_;  // of no area
  OccupancyMaps maps_;
  std::vector<LinkedPath> paths_;
};

TEST_F(LinkingPictureTest, AFrameHasItsPeopleAndTheWaysThatTheyCame) {
  const cv::Mat early = Draw().DrawFrame(0, 0);
  EXPECT_GT(Of(early, 1), 100);
  EXPECT_LT(Of(early, 2), 20);  // not there yet
  const cv::Mat both = Draw().DrawFrame(6, 0);
  EXPECT_GT(Of(both, 1), Of(Draw().DrawFrame(6, 6), 1) + 200);
  EXPECT_GT(Of(both, 2), 100);
  EXPECT_LT(Of(Draw().DrawFrame(7, 0), 2), 20);  // gone
}

TEST_F(LinkingPictureTest, WhatWasInferredIsDashed) {
  const auto length = [&](double support) { return Of(Draw(support).DrawFrame(9, 0), 1); };
  EXPECT_LT(length(0.5), length(0.05) - 100);
  EXPECT_LT(length(1), length(0.5) - 300);  // 0.9 supports nothing then
}

TEST_F(LinkingPictureTest, AStretchHasPathsAndWeakSteps) {
  const Stretch stretch = {.first_frame = 3, .last_frame = 8};
  Alternatives alternatives;
  for (std::size_t i = 0; i < 2; ++i) {
    alternatives.paths.push_back({.path = i,
                                  .first_frame = 3,
                                  .cells = {paths_[i].cells.begin() + 2, paths_[i].cells.end()},
                                  .cost = -1,
                                  .weakest = std::nullopt});
  }
  const cv::Mat plain = Draw().DrawStretch(stretch, alternatives);
  EXPECT_GT(Of(plain, 1), 500);
  EXPECT_GT(Of(plain, 2), 50);  // its end, a cross
  // The highest probability of each cell: the six cells of a path that were seen, at 0.8 of 0.95.
  EXPECT_GT(Count(plain, {64, 186, 216}) + Count(plain, {63, 184, 213}), 500);
  alternatives.paths[1].weakest =
      WeakStep{.frame = 4, .from = paths_[1].cells[2], .to = paths_[1].cells[3], .margin = 1.5};
  EXPECT_GT(Of(Draw().DrawStretch(stretch, alternatives), 2), Of(plain, 2) + 50);
}

TEST_F(LinkingPictureTest, AnySizeOfGridCanBeDrawn) {
  maps_.grid = {.min_x_m = 0, .min_y_m = 0, .cell_m = 0.2, .columns = 240, .rows = 1};
  paths_.clear();
  const cv::Mat picture = Draw().DrawFrame(0, 0);
  EXPECT_EQ(picture.cols, 1100);
  EXPECT_EQ(picture.type(), CV_8UC3);
}

}  // namespace
}  // namespace vantage
