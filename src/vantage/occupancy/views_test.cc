// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;

/// 320 x 240, 3 m above (0, -10), looking along +y and slightly down.
Camera TestCamera() {
  CameraPose pose;
  const double tilt = 0.2;
  Eigen::Matrix3d level;
  level << 1, 0, 0, 0, 0, -1, 0, 1, 0;  // x right, y down, z along the world's y
  Eigen::Matrix3d down;
  down << 1, 0, 0, 0, std::cos(tilt), -std::sin(tilt), 0, std::sin(tilt), std::cos(tilt);
  pose.rotation = down * level;
  pose.translation_m = -pose.rotation * Eigen::Vector3d(0, -10, 3);
  return *Camera::Create(
      {320, 240}, PinholeModel{.fx_px = 300, .fy_px = 300, .cx_px = 159.5, .cy_px = 119.5}, pose);
}

GroundGrid Grid(double half_m, double cell_m) {
  const int cells = static_cast<int>(std::lround(2 * half_m / cell_m));
  return {-half_m, -half_m, cell_m, cells, cells};
}

TEST(BuildView, RectangleHoldsThePixelsWhoseCentresThePersonCovers) {
  const Camera camera = TestCamera();
  const GroundGrid grid = Grid(4, 0.5);
  const CameraView view = *BuildView(camera, grid, {}, Visibility::kComplete, 1);
  ASSERT_EQ(view.rectangles.size(), static_cast<std::size_t>(grid.count()));
  EXPECT_EQ(view.size, camera.size());
  int visible = 0;
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    const cv::Rect& r = view.rectangles[static_cast<std::size_t>(cell)];
    if (r.empty()) continue;
    ++visible;
    const PixelBox box = *PersonBox(camera, grid.Center(cell), {});
    EXPECT_GE(r.x, box.min_x);
    EXPECT_LT(r.x - 1, box.min_x);
    EXPECT_LE(r.x + r.width - 1, box.max_x);
    EXPECT_GT(r.x + r.width, box.max_x);
    EXPECT_GE(r.y, box.min_y);
    EXPECT_LE(r.y + r.height - 1, box.max_y);
    EXPECT_GT(r.y + r.height, box.max_y);
  }
  EXPECT_GT(visible, 200);
}

TEST(BuildView, RulesDecideWhichCellsAreVisible) {
  const Camera camera = TestCamera();
  const GroundGrid grid = Grid(20, 0.5);
  const PersonOptions person;
  const CameraView ground = *BuildView(camera, grid, person, Visibility::kGround, 1);
  const CameraView complete = *BuildView(camera, grid, person, Visibility::kComplete, 1);
  const CameraView centre = *BuildView(camera, grid, person, Visibility::kCentre, 1);
  int ground_only = 0, centre_only = 0;
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    const auto i = static_cast<std::size_t>(cell);
    const Eigen::Vector2d foot_m = grid.Center(cell);
    const auto box = PersonBox(camera, foot_m, person);
    const auto foot_px = camera.ImageFromWorld({foot_m.x(), foot_m.y(), 0});
    const bool foot_in = foot_px && camera.InPicture(*foot_px);
    EXPECT_EQ(!ground.rectangles[i].empty(), box && foot_in);
    EXPECT_EQ(!complete.rectangles[i].empty(), box && camera.InPicture({box->min_x, box->min_y}) &&
                                                   camera.InPicture({box->max_x, box->max_y}));
    EXPECT_EQ(
        !centre.rectangles[i].empty(),
        box && camera.InPicture({(box->min_x + box->max_x) / 2, (box->min_y + box->max_y) / 2}));
    if (!complete.rectangles[i].empty()) {
      EXPECT_EQ(centre.rectangles[i], complete.rectangles[i]);
    }
    const cv::Rect picture(0, 0, 320, 240);
    EXPECT_EQ(centre.rectangles[i] & picture, centre.rectangles[i]);
    ground_only += !ground.rectangles[i].empty() && centre.rectangles[i].empty();
    centre_only += !centre.rectangles[i].empty() && ground.rectangles[i].empty();
  }
  EXPECT_GT(ground_only + centre_only, 0);
}

TEST(BuildView, ContinuousWeighsACellByTheShareThatIsInThePicture) {
  const Camera camera = TestCamera();
  const GroundGrid grid = Grid(20, 0.5);
  const CameraView view = *BuildView(camera, grid, {}, Visibility::kContinuous, 1);
  const CameraView complete = *BuildView(camera, grid, {}, Visibility::kComplete, 1);
  const CameraView centre = *BuildView(camera, grid, {}, Visibility::kCentre, 1);
  EXPECT_THAT(complete.weights, ::testing::IsEmpty());
  ASSERT_EQ(view.weights.size(), view.rectangles.size());
  int partly = 0, less_than_half = 0;
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    const auto i = static_cast<std::size_t>(cell);
    const float weight = view.weights[i];
    ASSERT_GE(weight, 0);
    ASSERT_LE(weight, 1);
    if (!complete.rectangles[i].empty()) {
      EXPECT_NEAR(weight, 1, 1e-6);
    }
    if (!centre.rectangles[i].empty()) {
      EXPECT_EQ(view.rectangles[i], centre.rectangles[i]);
    }
    if (view.rectangles[i].empty()) continue;
    // The share of a fine grid of points over the rectangle.
    const PixelBox box = *PersonBox(camera, grid.Center(cell), {});
    constexpr int kPoints = 100;
    int inside = 0;
    for (int k = 0; k < kPoints * kPoints; ++k) {
      inside += camera.InPicture({box.min_x + (k % kPoints + 0.5) / kPoints * box.width(),
                                  box.min_y + (k / kPoints + 0.5) / kPoints * box.height()});
    }
    EXPECT_NEAR(weight, static_cast<double>(inside) / (kPoints * kPoints), 0.011);
    partly += weight < 1 - 1e-6F;
    less_than_half += weight < 0.5F;
  }
  EXPECT_GT(partly, 50);
  EXPECT_GT(less_than_half, 10);
}

/// Share of the cells that the camera sees in which a person is this wide, in pixels.
double ShareOfCells(const Camera& camera, const GroundGrid& grid, const PersonOptions& person,
                    double width_px) {
  int cells = 0, wide = 0;
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    const auto box = PersonBox(camera, grid.Center(cell), person);
    if (!box || !camera.InPicture({(box->min_x + box->max_x) / 2, (box->min_y + box->max_y) / 2})) {
      continue;
    }
    ++cells;
    wide += box->width() >= width_px;
  }
  return static_cast<double>(wide) / cells;
}

TEST(AutomaticReduction, IsTheLargestDivisorThatLeavesMostPeopleFivePixelsWide) {
  const GroundGrid grid = Grid(6, 0.5);
  for (const ImageSize size : {ImageSize{320, 240}, ImageSize{960, 768}, ImageSize{1920, 1080}}) {
    const Camera camera = *TestCamera().Scaled(size);
    int last = 1;
    for (const double width_m : {0.05, 0.2, 0.5, 1.0, 2.0, 5.0}) {
      const PersonOptions person{.width_m = width_m};
      int expected = 1;
      for (int side = 2; side <= 16; ++side) {
        const bool divides = size.width % side == 0 && size.height % side == 0;
        if (divides && ShareOfCells(camera, grid, person, 5 * side) > 0.75) expected = side;
      }
      EXPECT_EQ(AutomaticReduction(camera, grid, person), expected) << width_m;
      EXPECT_GE(expected, last) << "wider people bear more";
      last = expected;
    }
    EXPECT_GT(last, 4);
  }
}

TEST(AutomaticReduction, GrowsWithThePictures) {
  const GroundGrid grid = Grid(6, 0.5);
  int last = 0;
  for (int scale = 1; scale <= 64; scale *= 2) {
    const Camera camera = *TestCamera().Scaled({320 * scale, 240 * scale});
    const int reduction = AutomaticReduction(camera, grid, {});
    EXPECT_GE(reduction, 2 * last <= 16 ? 2 * last : last);
    EXPECT_LE(reduction, 16);
    last = reduction;
  }
  EXPECT_EQ(last, 16);
  EXPECT_EQ(AutomaticReduction(*TestCamera().Scaled({32, 24}), grid, {}), 1);
  EXPECT_EQ(AutomaticReduction(*TestCamera().Scaled({1021, 769}), grid, {}), 1) << "primes";
  EXPECT_EQ(AutomaticReduction(TestCamera(), {0, -1000, 1, 10, 10}, {}), 1) << "sees no cell";
}

TEST(BuildView, ReductionScalesThePicture) {
  const Camera camera = TestCamera();
  const GroundGrid grid = Grid(4, 0.5);
  const CameraView full = *BuildView(camera, grid, {}, Visibility::kCentre, 1);
  const CameraView reduced = *BuildView(camera, grid, {}, Visibility::kCentre, 4);
  EXPECT_EQ(reduced.mask_size, camera.size());
  EXPECT_EQ(reduced.size, (ImageSize{80, 60}));
  for (std::size_t i = 0; i < full.rectangles.size(); ++i) {
    if (full.rectangles[i].empty() || reduced.rectangles[i].empty()) continue;
    EXPECT_NEAR(full.rectangles[i].x, 4 * reduced.rectangles[i].x, 4);
    EXPECT_NEAR(full.rectangles[i].height, 4 * reduced.rectangles[i].height, 6);
  }
  EXPECT_EQ(ReducedSize({9, 1}, 4), (ImageSize{2, 1}));
}

TEST(BuildView, RectangleThatRoundsToNothingIsNotVisible) {
  // A person 5 cm wide, 300 m away, is a sixth of a pixel.
  const GroundGrid grid{-5, 290, 1, 10, 1};
  const CameraView view = *BuildView(TestCamera(), grid, {.width_m = 0.05}, Visibility::kCentre, 1);
  int visible = 0;
  for (const cv::Rect& r : view.rectangles) {
    EXPECT_TRUE(r == cv::Rect() || r.width == 1);
    visible += !r.empty();
  }
  EXPECT_LT(visible, 10);
}

TEST(BuildView, CameraThatLooksAtTheSkySpeaksForNoCell) {
  CameraPose pose;  // looks up: the camera's axes are the world's
  pose.translation_m = {0, 0, -1};
  const Camera camera = *Camera::Create(
      {64, 64}, PinholeModel{.fx_px = 60, .fy_px = 60, .cx_px = 32, .cy_px = 32}, pose);
  const CameraView view = *BuildView(camera, Grid(4, 1), {}, Visibility::kCentre, 1);
  const std::vector<CameraView> views = {view};
  EXPECT_THAT(VisibleCells(views), ::testing::Each(0));
}

TEST(BuildView, CellsWithoutAnInformativePixelAreNotVisible) {
  const Camera camera = TestCamera();
  const GroundGrid grid = Grid(4, 0.5);
  // A post over all rows, and half a pixel more than it once the masks are reduced.
  cv::Mat informative(240, 320, CV_8UC1, cv::Scalar(255));
  const cv::Rect post(118, 0, 60, 240);
  informative(post) = 0;
  for (const int reduction : {1, 4}) {
    const CameraView all = *BuildView(camera, grid, {}, Visibility::kCentre, reduction);
    const CameraView view =
        *BuildView(camera, grid, {}, Visibility::kCentre, reduction, informative);
    EXPECT_TRUE(all.informative.empty());
    EXPECT_EQ(cv::norm(view.informative, informative, cv::NORM_L1), 0);
    int hidden = 0;
    for (std::size_t i = 0; i < all.rectangles.size(); ++i) {
      const cv::Rect& r = all.rectangles[i];
      const cv::Rect full(r.x * reduction, r.y * reduction, r.width * reduction,
                          r.height * reduction);
      const bool is_hidden = !r.empty() && cv::countNonZero(informative(full)) == 0;
      EXPECT_EQ(view.rectangles[i], is_hidden ? cv::Rect() : r);
      hidden += is_hidden;
    }
    EXPECT_GT(hidden, 5);
  }
}

TEST(BuildView, RefusesNonsense) {
  const auto with = [](const cv::Mat& informative) {
    return MessageOf(BuildView(TestCamera(), Grid(4, 1), {}, Visibility::kCentre, 1, informative));
  };
  EXPECT_THAT(with(cv::Mat::ones(240, 319, CV_8UC1)),
              HasSubstr("are 319 x 240 px with 1 channels"));
  EXPECT_THAT(with(cv::Mat::ones(240, 320, CV_8UC3)), HasSubstr("must be 320 x 240 with one of 1"));

  EXPECT_THAT(MessageOf(BuildView(TestCamera(), Grid(4, 1), {}, Visibility::kCentre, 0)),
              HasSubstr("occupancy.reduction is 0"));
  EXPECT_THAT(MessageOf(BuildView(TestCamera(), Grid(4, 1), {}, Visibility::kCentre,
                                  std::numeric_limits<double>::quiet_NaN())),
              HasSubstr("occupancy.reduction is nan"));
  EXPECT_THAT(MessageOf(BuildView(TestCamera(), {}, {}, Visibility::kCentre, 1)),
              HasSubstr("no cells"));
}

TEST(VisibleCells, IsTheUnionOfTheViews) {
  CameraView a{{4, 4}, {4, 4}, {cv::Rect(0, 0, 1, 1), {}, {}}};
  CameraView b{{4, 4}, {4, 4}, {{}, cv::Rect(0, 0, 2, 1), {}}};
  const std::vector<CameraView> views = {a, b};
  EXPECT_THAT(VisibleCells(views), ::testing::ElementsAre(1, 1, 0));
}

}  // namespace
}  // namespace vantage
