// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/geometry/grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "vantage/base/test_support.h"
#include "vantage/geometry/test_cameras.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using ::testing::HasSubstr;
using testing::MessageOf;
using testing::Random;

Polygon Area(double min_x, double min_y, double max_x, double max_y) {
  return Polygon::Rectangle({min_x, min_y}, {max_x, max_y}).value();
}

TEST(GroundGrid, CoversTheAreaWithoutASpareCell) {
  const GroundGrid grid = GroundGrid::Cover(Area(0, -5, 20, 5), 0.1, {}).value();
  EXPECT_EQ(grid.columns, 200);
  EXPECT_EQ(grid.rows, 100);
  EXPECT_EQ(grid.min_x_m, 0);
  EXPECT_EQ(grid.min_y_m, -5);
  const GroundGrid larger = GroundGrid::Cover(Area(0, -5, 20.05, 5), 0.1, {}).value();
  EXPECT_EQ(larger.columns, 201);
}

TEST(GroundGrid, ExtensionKeepsTheAreaOnACellBorder) {
  const GroundGrid grid =
      GroundGrid::Cover(Area(1, 2, 11, 7), 0.5, Extension::Uniform(1.2)).value();
  // 1.2 m are 3 cells of 0.5 m on each side.
  EXPECT_EQ(grid.columns, 20 + 6);
  EXPECT_EQ(grid.rows, 10 + 6);
  EXPECT_DOUBLE_EQ(grid.min_x_m, 1 - 1.5);
  EXPECT_DOUBLE_EQ(grid.min_y_m, 2 - 1.5);
}

TEST(GroundGrid, EverySideIsExtendedForItself) {
  const Extension extension{.min_x_m = 0.4, .max_x_m = 2, .min_y_m = 0, .max_y_m = 1.1};
  const GroundGrid grid = GroundGrid::Cover(Area(1, 2, 11, 7), 0.5, extension).value();
  EXPECT_EQ(grid.columns, 1 + 20 + 4);
  EXPECT_EQ(grid.rows, 0 + 10 + 3);
  EXPECT_DOUBLE_EQ(grid.min_x_m, 0.5);
  EXPECT_DOUBLE_EQ(grid.min_y_m, 2);
}

TEST(GroundGrid, EveryCellIsAtItsCentre) {
  Random random(1);
  for (int round = 0; round < 50; ++round) {
    const Vector2d low = random.Point(-100, 100);
    const Vector2d high = low + random.Point(0.5, 10);
    const GroundGrid grid =
        GroundGrid::Cover(Area(low.x(), low.y(), high.x(), high.y()), random.Between(0.1, 2),
                          Extension::Uniform(random.Between(0, 5)))
            .value();
    for (CellIndex cell = 0; cell < grid.count(); ++cell) {
      ASSERT_EQ(grid.CellAt(grid.Center(cell)), cell);
      ASSERT_EQ(grid.Index(grid.Column(cell), grid.Row(cell)), cell);
    }
  }
}

TEST(GroundGrid, PointsLieInTheCellThatCoversThem) {
  Random random(2);
  const Polygon area = Area(-3, 4, 8, 9);
  const GroundGrid grid = GroundGrid::Cover(area, 0.3, Extension::Uniform(1)).value();
  for (int i = 0; i < 2000; ++i) {
    const Vector2d p = random.Point(-15, 20);
    const auto cell = grid.CellAt(p);
    if (area.Distance(p) < 0.99) {
      ASSERT_TRUE(cell);
    }
    if (cell) {
      EXPECT_LE((grid.Center(*cell) - p).cwiseAbs().maxCoeff(), 0.15 + 1e-12);
    }
  }
  EXPECT_FALSE(grid.CellAt({grid.min_x_m - 1e-6, 5}));
  EXPECT_TRUE(grid.CellAt({grid.min_x_m, 5}));
  EXPECT_FALSE(grid.CellAt({std::nan(""), 5}));
  EXPECT_FALSE(grid.CellAt({5, std::numeric_limits<double>::infinity()}));
}

TEST(GroundGrid, RefusesSizesThatMakeNoSense) {
  const Polygon area = Area(0, 0, 20, 10);
  EXPECT_THAT(MessageOf(GroundGrid::Cover(area, 0, {})), HasSubstr("cell is 0 m"));
  EXPECT_THAT(MessageOf(GroundGrid::Cover(area, std::nan(""), {})), HasSubstr("cell is nan m"));
  EXPECT_THAT(MessageOf(GroundGrid::Cover(area, 0.5, {.max_y_m = -1})),
              HasSubstr("extension is -1 m"));
  EXPECT_THAT(MessageOf(GroundGrid::Cover(area, 0.5, {.min_x_m = INFINITY})),
              HasSubstr("extension is inf m"));
  EXPECT_THAT(MessageOf(GroundGrid::Cover(area, 0.005, {})),
              HasSubstr("4000 x 2000 cells of 0.005 m are more than 4 million"));
  EXPECT_THAT(MessageOf(GroundGrid::Cover(area, 1e-300, {})), HasSubstr("use larger cells"));
  EXPECT_TRUE(GroundGrid::Cover(area, 0.01, {}));
}

}  // namespace
}  // namespace vantage
