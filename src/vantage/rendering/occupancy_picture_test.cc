// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/rendering/occupancy_picture.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "vantage/rendering/palette.h"
#include "vantage/rendering/test_scene.h"

namespace vantage {
namespace {

/// Two cameras over an area of 8 x 6 m, extended by 1, 2, 0 and 3 m.
class OccupancyPictureTest : public ::testing::Test {
 protected:
  OccupancyPictureTest() {
    scene_.grid.cell_m = 0.5;
    for (std::size_t side = 0; side < 4; ++side) {
      extension_.sides[side].extension_m = std::array{1.0, 2.0, 0.0, 3.0}[side];
    }
    grid_ = GroundGrid::Cover(scene_.area, 0.5, extension_.extension()).value();
    for (const SceneCamera& camera : scene_.cameras) {
      views_.push_back(
          BuildView(camera.camera, grid_, scene_.person.OrDefault(), Visibility::kCentre, 1)
              .value());
    }
  }
  OccupancyPicture Draw() const {
    return {scene_, scene_.person.OrDefault(), grid_, views_, extension_};
  }
  static int Different(const cv::Mat& a, const cv::Mat& b) {
    EXPECT_EQ(a.size(), b.size());
    cv::Mat differs;
    cv::absdiff(a, b, differs);
    return cv::countNonZero(differs.reshape(1));
  }
  /// Pixels of about this colour.
  static int Count(const cv::Mat& picture, const cv::Scalar& color) {
    cv::Mat found;
    const cv::Scalar near = cv::Scalar::all(12);
    cv::inRange(picture, color - near, color + near, found);
    return cv::countNonZero(found);
  }

  Scene scene_ = testing::CornerScene({{640, 480}, {320, 240}});
  ExtensionReport extension_;
  GroundGrid grid_;
  std::vector<CameraView> views_;
  const cv::Scalar amber_ = {40, 170, 250};
  const cv::Scalar white_ = {240, 236, 232};
};

TEST_F(OccupancyPictureTest, ThePlanHasBordersFieldsOfViewAndReasons) {
  const cv::Mat plan = Draw().DrawPlan();
  EXPECT_EQ(std::max(plan.cols, plan.rows), 1100);
  EXPECT_GT(Count(plan, amber_), 1000);
  EXPECT_GT(Count(plan, white_), 1000);
  for (const int camera : {1, 2}) EXPECT_GT(Count(plan, ColorOf(TrackId{camera})), 300) << camera;
  // The same cells without any extension: no amber but in the words.
  extension_ = {};
  grid_ = GroundGrid::Cover(scene_.area, 0.5, {}).value();
  views_.clear();
  for (const SceneCamera& camera : scene_.cameras) {
    views_.push_back(
        BuildView(camera.camera, grid_, scene_.person.OrDefault(), Visibility::kCentre, 1).value());
  }
  EXPECT_LT(Count(Draw().DrawPlan(), amber_), Count(plan, amber_));
}

TEST_F(OccupancyPictureTest, CellsThatNobodySeesStandOut) {
  const cv::Mat seen = Draw().DrawPlan();
  for (CameraView& view : views_) {
    for (CellIndex cell = 0; cell < grid_.count(); ++cell) {
      if (grid_.Column(cell) < 5) view.rectangles[static_cast<std::size_t>(cell)] = {};
    }
  }
  const cv::Mat unseen = Draw().DrawPlan();
  EXPECT_GT(Different(seen, unseen), 5000);
  const auto redness = [](const cv::Mat& picture) {
    const cv::Scalar mean = cv::mean(picture);
    return mean[2] - (mean[0] + mean[1]) / 2;
  };
  EXPECT_GT(redness(unseen), redness(seen) + 1);
}

TEST_F(OccupancyPictureTest, AViewIsOfTheCamerasSizeOrTwiceThat) {
  const OccupancyPicture draw = Draw();
  EXPECT_EQ(draw.DrawView(0, {}).size(), cv::Size(640, 480));
  EXPECT_EQ(draw.DrawView(1, {}).size(), cv::Size(640, 480));
  EXPECT_EQ(draw.DrawPeaks(1, {}, {}, {}).size(), cv::Size(640, 480));
}

TEST_F(OccupancyPictureTest, AViewShowsPictureMaskOrDarkGroundUnderTheCells) {
  const OccupancyPicture draw = Draw();
  const cv::Mat dark = draw.DrawView(0, {});
  const cv::Mat color(480, 640, CV_8UC3, cv::Scalar(0, 200, 0));
  const cv::Mat mask(480, 640, CV_8UC1, cv::Scalar(255));
  EXPECT_GT(cv::mean(draw.DrawView(0, color))[1], cv::mean(dark)[1] + 40);
  EXPECT_GT(cv::mean(draw.DrawView(0, mask))[0], cv::mean(dark)[0] + 40);
  EXPECT_GT(Count(dark, white_), 300);
  EXPECT_GT(Count(dark, amber_), 300);

  // A camera that speaks for no cell tints none and shows no people.
  for (cv::Rect& rectangle : views_[0].rectangles) rectangle = {};
  const cv::Mat silent = Draw().DrawView(0, {});
  EXPECT_LT(cv::mean(silent)[2], cv::mean(dark)[2] - 5);
}

TEST_F(OccupancyPictureTest, TheMapShowsProbabilitiesAndPeaks) {
  const OccupancyPicture draw = Draw();
  std::vector<float> q(static_cast<std::size_t>(grid_.count()), 0.0f);
  const cv::Mat empty = draw.DrawMap(q, {});
  const Eigen::Vector2d inside(1, 1), outside(5, 1);
  std::vector<Peak> peaks;
  for (const Eigen::Vector2d& place : {inside, outside}) {
    const CellIndex cell = grid_.CellAt(place).value();
    q[static_cast<std::size_t>(cell)] = 1;
    peaks.push_back({cell, grid_.Center(cell), 1});
  }
  const cv::Scalar heat = {70, 220, 255};
  EXPECT_GT(Count(draw.DrawMap(q, {}), heat), Count(empty, heat) + 500);
  const cv::Mat map = draw.DrawMap(q, peaks);
  // Rings, the one in the extension thin.
  const int in_area = Count(map, ColorOf(TrackId{1})) - Count(empty, ColorOf(TrackId{1}));
  const int in_extension = Count(map, ColorOf(TrackId{2})) - Count(empty, ColorOf(TrackId{2}));
  EXPECT_GT(in_extension, 60);
  EXPECT_GT(in_area, in_extension + 100);

  const cv::Mat nobody = draw.DrawPeaks(0, {}, {}, {});
  const cv::Mat people = draw.DrawPeaks(0, {}, {}, peaks);
  EXPECT_GT(Different(nobody, people), 500);
  const cv::Mat mask(480, 640, CV_8UC1, cv::Scalar(255));
  EXPECT_GT(cv::mean(draw.DrawPeaks(0, {}, mask, {}))[0], cv::mean(nobody)[0] + 30);
}

}  // namespace
}  // namespace vantage
