// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/extension.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "vantage/base/test_support.h"
#include "vantage/geometry/test_cameras.h"

namespace vantage {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using testing::LookAt;
using testing::MessageOf;
using testing::Random;

/// A camera with a picture of 120 x 100 degrees.
Camera WideCamera(const Eigen::Vector3d& center_m, const Eigen::Vector3d& target_m) {
  const PinholeModel lens{.fx_px = 300, .fy_px = 300, .cx_px = 519.5, .cy_px = 357.5};
  return Camera::Create({1040, 716}, lens, LookAt(center_m, target_m)).value();
}

Polygon Square(double half_m) {
  return Polygon::Rectangle({-half_m, -half_m}, {half_m, half_m}).value();
}

ExtensionReport Choose(const Polygon& area, const std::vector<Camera>& cameras,
                       const GridOptions& grid = {.cell_m = 0.5}, const PersonOptions& person = {},
                       Visibility visibility = Visibility::kCentre) {
  const auto report = ChooseExtension(area, grid, cameras, person, visibility);
  EXPECT_TRUE(report) << MessageOf(report);
  return report.value_or(ExtensionReport());
}

/// The definition, each pair of cells for itself.
Extension Reference(const Polygon& area, const std::vector<Camera>& cameras,
                    const GridOptions& options, const PersonOptions& person, Visibility rule) {
  const int around = static_cast<int>(std::lround(options.max_extension_m / options.cell_m));
  const GroundGrid grid =
      GroundGrid::Cover(area, options.cell_m, Extension::Uniform(options.max_extension_m)).value();
  std::vector<CameraView> views;
  for (const Camera& camera : cameras) {
    views.push_back(BuildView(camera, grid, person, rule, 1).value());
  }
  const auto visible = VisibleCells(views);
  const auto clipped = [&](const Camera& camera, CellIndex cell) -> std::optional<PixelBox> {
    auto box = PersonBox(camera, grid.Center(cell), person);
    if (!box) return std::nullopt;
    box = PixelBox{std::max(box->min_x, -0.5), std::max(box->min_y, -0.5),
                   std::min(box->max_x, camera.size().width - 0.5),
                   std::min(box->max_y, camera.size().height - 0.5)};
    if (box->width() <= 0 || box->height() <= 0) return std::nullopt;
    return box;
  };
  Extension extension;
  const auto raise = [&](double& side_m, int cells) {
    side_m = std::max(side_m, cells * options.cell_m);
  };
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    for (CellIndex outside = 0; outside < grid.count(); ++outside) {
      const auto covering = clipped(cameras[c], outside);
      if (visible[static_cast<std::size_t>(outside)] == 0 || !covering) continue;
      bool covers = false;
      for (CellIndex inside = 0; inside < grid.count() && !covers; ++inside) {
        if (views[c].rectangles[static_cast<std::size_t>(inside)].empty() ||
            !area.Contains(grid.Center(inside))) {
          continue;
        }
        const PixelBox box = clipped(cameras[c], inside).value();
        const double width =
            std::min(box.max_x, covering->max_x) - std::max(box.min_x, covering->min_x);
        const double height =
            std::min(box.max_y, covering->max_y) - std::max(box.min_y, covering->min_y);
        covers = width > 0 && height > 0 &&
                 width * height >= options.covering_share * box.width() * box.height();
      }
      if (!covers) continue;
      raise(extension.min_x_m, around - grid.Column(outside));
      raise(extension.max_x_m, grid.Column(outside) + 1 - (grid.columns - around));
      raise(extension.min_y_m, around - grid.Row(outside));
      raise(extension.max_y_m, grid.Row(outside) + 1 - (grid.rows - around));
    }
  }
  return extension;
}

TEST(ChooseExtension, IsWhatTheFormulasSayAlongTheLineOfSight) {
  // A level camera 4 m up, 15 m before the area: heights in its picture are as in the formulas.
  const Polygon area = Polygon::Rectangle({0, -5}, {10, 5}).value();
  const Camera camera = WideCamera({-15, 0, 4}, {0, 0, 4});
  const double cell = 0.5, up = 4, h = 1.75, share = 0.5;
  const GridOptions grid{.cell_m = cell, .max_extension_m = 12, .covering_share = share};
  const ExtensionReport report = Choose(area, {camera}, grid, {.height_m = h});

  const double near = 15 + cell / 2;  // D of the nearest and of the farthest cells inside
  const double far = 25 - cell / 2;
  int behind = 0, before = 0;  // cells of the extension
  for (int k = 1; k < 24; ++k) {
    const double d = k * cell;
    if ((1 - up * d / (far + d) / h) * far / (far + d) >= share) behind = k;
    if (d <= near * (1 - share) * h / (up - share * h)) before = k;
  }
  EXPECT_EQ(report.sides[0].extension_m, before * cell);
  EXPECT_EQ(report.sides[1].extension_m, behind * cell);
  EXPECT_EQ(report.sides[0].reason, ExtensionReason::kCovers);
  EXPECT_EQ(report.sides[1].reason, ExtensionReason::kCovers);
  EXPECT_EQ(report.sides[1].camera, 0u);
  // People beside the line of sight need the breadth of a person and the slant of the view.
  EXPECT_EQ(report.sides[2].extension_m, report.sides[3].extension_m);
  EXPECT_LT(report.sides[2].extension_m, report.sides[1].extension_m);
}

TEST(ChooseExtension, FewCellsUnderACameraStraightAbove) {
  const Camera above = WideCamera({0, 0, 30}, {0, 0, 0});
  const ExtensionReport report = Choose(Square(4), {above});
  for (const ExtensionSide& side : report.sides) {
    EXPECT_LE(side.extension_m, 0.5);
    EXPECT_NE(side.reason, ExtensionReason::kBounded);
  }
  // Cells wider than people, from so high above: nobody covers anybody.
  const Camera high = WideCamera({0, 0, 100}, {0, 0, 0});
  const ExtensionReport none = Choose(Square(4), {high}, {.cell_m = 1});
  EXPECT_EQ(none.extension(), Extension());
  for (const ExtensionSide& side : none.sides) {
    EXPECT_EQ(side.reason, ExtensionReason::kNone);
    EXPECT_EQ(side.camera, std::nullopt);
  }
}

TEST(ChooseExtension, ALowCameraNeedsAllThatIsAllowed) {
  const Camera low = WideCamera({-20, 0, 1.2}, {0, 0, 1.2});
  for (const double most_m : {0.0, 2.0, 7.3}) {
    const ExtensionReport report =
        Choose(Square(4), {low}, {.cell_m = 0.5, .max_extension_m = most_m});
    for (const std::size_t side : {0, 1}) {
      EXPECT_EQ(report.sides[side].extension_m, std::floor(most_m / 0.5) * 0.5);
      EXPECT_EQ(report.sides[side].reason, ExtensionReason::kBounded);
    }
  }
}

TEST(ChooseExtension, NoCellsWhereNobodyIsSeen) {
  // A narrow view of the middle of a large area.
  const PinholeModel lens{.fx_px = 900, .fy_px = 900, .cx_px = 319.5, .cy_px = 239.5};
  const Camera narrow = Camera::Create({640, 480}, lens, LookAt({0, -8, 8}, {0, 0, 0})).value();
  const ExtensionReport report = Choose(Square(12), {narrow});
  EXPECT_EQ(report.extension(), Extension());
  for (const ExtensionSide& side : report.sides) {
    EXPECT_EQ(side.reason, ExtensionReason::kUnseen);
    EXPECT_THAT(side.cameras_m, Each(0.0));
  }
  // With the end of its view 2 m behind the area, the extension ends there too.
  const auto end = narrow.WorldFromImage({319.5, 0}, 0.9).value();
  const Polygon before = Polygon::Rectangle({-1, -1}, {1, end.y() - 2}).value();
  const ExtensionReport seen = Choose(before, {narrow}, {.cell_m = 0.5, .covering_share = 0.05});
  EXPECT_EQ(seen.sides[3].reason, ExtensionReason::kUnseen);
  EXPECT_GT(seen.sides[3].extension_m, 1);
  EXPECT_LT(seen.sides[3].extension_m, 3.1);
}

TEST(ChooseExtension, IsTheDefinition) {
  Random random(4);
  const Polygon corner =
      Polygon::Create({{-4, -3}, {4, -3}, {4, 1}, {0, 1}, {0, 4}, {-4, 3}}).value();
  for (int round = 0; round < 12; ++round) {
    std::vector<Camera> cameras;
    for (int c = 0; c < 2; ++c) {
      const Eigen::Vector2d from = 14 * random.Point(-1, 1);
      const Eigen::Vector2d to = random.Point(-4, 4);
      const CameraPose pose =
          LookAt({from.x(), from.y(), random.Between(1.5, 12)}, {to.x(), to.y(), 0});
      const ImageSize size{768, 576};
      if (c == 0) {
        cameras.push_back(Camera::Create(size, testing::RandomPinhole(random), pose).value());
      } else {
        cameras.push_back(Camera::Create(size, testing::RandomTsai(random), pose).value());
      }
    }
    const GridOptions grid{
        .cell_m = 0.5, .max_extension_m = 3, .covering_share = random.Between(0.1, 0.9)};
    const PersonOptions person{.width_m = 0.6};
    for (const Visibility rule :
         {Visibility::kGround, Visibility::kComplete, Visibility::kCentre}) {
      EXPECT_EQ(Choose(corner, cameras, grid, person, rule).extension(),
                Reference(corner, cameras, grid, person, rule))
          << "round " << round << ", rule " << static_cast<int>(rule);
    }
  }
}

TEST(ChooseExtension, TheOrderOfCamerasChangesNothingButTheirNumbers) {
  const Camera south = WideCamera({1, -12, 6}, {0, 0, 0});
  const Camera east = WideCamera({15, 2, 4}, {0, 0, 0});
  const Camera away = WideCamera({300, 300, 4}, {400, 400, 0});  // sees none of it
  const ExtensionReport two =
      Choose(Square(5), {south, east}, {.cell_m = 0.5, .max_extension_m = 20});
  const ExtensionReport three =
      Choose(Square(5), {east, away, south}, {.cell_m = 0.5, .max_extension_m = 20});
  EXPECT_EQ(two.extension(), three.extension());
  for (std::size_t side = 0; side < 4; ++side) {
    EXPECT_EQ(two.sides[side].reason, three.sides[side].reason);
    EXPECT_EQ(two.sides[side].camera, three.sides[side].camera == 2u ? 0u : 1u) << side;
    EXPECT_EQ(three.sides[side].cameras_m[1], 0);
    EXPECT_EQ(three.sides[side].extension_m, *std::max_element(three.sides[side].cameras_m.begin(),
                                                               three.sides[side].cameras_m.end()));
  }
  // Each side is decided by the camera that looks across it.
  EXPECT_EQ(two.sides[0].camera, 1u);
  EXPECT_EQ(two.sides[3].camera, 0u);
}

TEST(ChooseExtension, GrowsWithTheHeightOfPeopleAndShrinksWithTheShareAndTheCamera) {
  const auto along = [](double up_m, double height_m, double share) {
    const Camera camera = WideCamera({-14, 0, up_m}, {0, 0, 0});
    return Choose(Square(5), {camera},
                  {.cell_m = 0.5, .max_extension_m = 30, .covering_share = share},
                  {.height_m = height_m})
        .extension();
  };
  Extension last;
  for (const double height_m : {0.5, 1.0, 1.5, 1.75, 2.0, 2.5}) {
    const Extension now = along(6, height_m, 0.3);
    EXPECT_GE(now.max_x_m, last.max_x_m) << height_m;
    EXPECT_GE(now.min_x_m, last.min_x_m) << height_m;
    last = now;
  }
  EXPECT_GT(last.max_x_m, along(6, 0.5, 0.3).max_x_m + 3);
  EXPECT_GT(along(6, 1.75, 0.2).max_x_m, along(6, 1.75, 0.6).max_x_m);
  EXPECT_GT(along(4, 1.75, 0.3).max_x_m, along(10, 1.75, 0.3).max_x_m);
}

TEST(ChooseExtension, SmallCellsAreTakenTogether) {
  const Camera camera = WideCamera({-8, 0, 5}, {0, 0, 0});
  const Extension fine = Choose(Square(2), {camera}, {.cell_m = 0.02}).extension();
  EXPECT_EQ(fine, Choose(Square(2), {camera}, {.cell_m = 0.2}).extension());
  EXPECT_TRUE(GroundGrid::Cover(Square(2), 0.02, fine));
}

TEST(ChooseExtension, WhatIsGivenStays) {
  const ExtensionReport report = Choose(Square(5), {}, {.extension_m = 2.25});
  EXPECT_EQ(report.extension(), Extension::Uniform(2.25));
  for (const ExtensionSide& side : report.sides) EXPECT_EQ(side.reason, ExtensionReason::kGiven);
}

TEST(ChooseExtension, RefusesWhatMakesNoSense) {
  const std::vector<Camera> camera = {WideCamera({-8, 0, 5}, {0, 0, 0})};
  const auto error = [&](const GridOptions& grid, const std::vector<Camera>& cameras) {
    return MessageOf(ChooseExtension(Square(5), grid, cameras, {}, Visibility::kCentre));
  };
  EXPECT_THAT(error({.max_extension_m = -1}, camera), HasSubstr("grid.max_extension is -1"));
  EXPECT_THAT(error({.extension_m = std::nan("")}, camera), HasSubstr("grid.extension is nan"));
  EXPECT_THAT(error({.covering_share = 0}, camera), HasSubstr("grid.covering_share is 0"));
  EXPECT_THAT(error({}, {}), HasSubstr("without any camera"));
  EXPECT_THAT(MessageOf(ChooseExtension(Square(2000), {}, camera, {}, Visibility::kCentre)),
              HasSubstr("more than 4 million"));
}

}  // namespace
}  // namespace vantage
