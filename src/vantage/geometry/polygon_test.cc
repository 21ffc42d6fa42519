// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/geometry/polygon.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
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

/// A star with corners at random distances around (3, -2): simple, mostly not convex.
std::vector<Vector2d> RandomStar(Random& random) {
  const int corners = static_cast<int>(random.Between(3, 12));
  std::vector<Vector2d> result;
  for (int i = 0; i < corners; ++i) {
    const double angle = 6.283185 * (i + random.Between(0, 0.5)) / corners;
    result.emplace_back(Vector2d(3, -2) +
                        random.Between(1, 6) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return result;
}

/// Inside when the corners wind around the point: sum of the signed angles, an independent rule.
bool ContainsByWinding(const std::vector<Vector2d>& corners, const Vector2d& p) {
  double turn = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d a = corners[i] - p;
    const Vector2d b = corners[(i + 1) % corners.size()] - p;
    turn += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return std::abs(turn) > 3;
}

/// Distance to the outline by walking along it in steps of 1/2000 of each edge.
double DistanceBySampling(const std::vector<Vector2d>& corners, const Vector2d& p) {
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d& a = corners[i];
    const Vector2d& b = corners[(i + 1) % corners.size()];
    for (int step = 0; step <= 2000; ++step) {
      distance = std::min(distance, (a + step / 2000.0 * (b - a) - p).norm());
    }
  }
  return distance;
}

TEST(Polygon, ContainsAndDistanceAgreeWithSlowRules) {
  Random random(1);
  int inside = 0;
  for (int round = 0; round < 100; ++round) {
    std::vector<Vector2d> corners = RandomStar(random);
    const Polygon polygon = Polygon::Create(corners).value();
    std::reverse(corners.begin(), corners.end());
    const Polygon reversed = Polygon::Create(corners).value();
    EXPECT_DOUBLE_EQ(polygon.area_m2(), reversed.area_m2());
    for (int i = 0; i < 20; ++i) {
      const Vector2d p = Vector2d(3, -2) + random.Point(-8, 8);
      const bool expected = ContainsByWinding(corners, p);
      EXPECT_EQ(polygon.Contains(p), expected);
      EXPECT_EQ(reversed.Contains(p), expected);
      EXPECT_NEAR(polygon.Distance(p), expected ? 0 : DistanceBySampling(corners, p), 5e-3);
      EXPECT_NEAR(polygon.Distance(p), reversed.Distance(p), 1e-12);
      inside += expected;
    }
  }
  EXPECT_GT(inside, 200);
}

TEST(Polygon, AreaIsTheShareOfSamplesInside) {
  Random random(2);
  const Polygon polygon = Polygon::Create(RandomStar(random)).value();
  const Vector2d side = polygon.max_m() - polygon.min_m();
  int inside = 0;
  for (int i = 0; i < 40'000; ++i) {
    const Vector2d p = polygon.min_m() + side.cwiseProduct(random.Point(0, 1));
    inside += polygon.Contains(p);
  }
  EXPECT_NEAR(polygon.area_m2(), inside / 40'000.0 * side.prod(), 0.02 * side.prod());
}

TEST(Polygon, ContainsItsEdgeAndCorners) {
  const Polygon polygon = Polygon::Rectangle({-1, 2}, {3, 5}).value();
  EXPECT_EQ(polygon.area_m2(), 12);
  for (const Vector2d& corner : polygon.corners_m()) EXPECT_TRUE(polygon.Contains(corner));
  EXPECT_TRUE(polygon.Contains({1, 2}));
  EXPECT_TRUE(polygon.Contains({3, 4}));
  EXPECT_FALSE(polygon.Contains({3.001, 4}));
  EXPECT_FALSE(polygon.Contains({1, 1.999}));
  EXPECT_DOUBLE_EQ(polygon.Distance({6, 9}), 5);
  EXPECT_FALSE(polygon.Contains({std::nan(""), 3}));
}

TEST(Polygon, RefusesWhatIsNotASimplePolygon) {
  EXPECT_THAT(MessageOf(Polygon::Create({{0, 0}, {1, 0}})), HasSubstr("2 corners"));
  EXPECT_THAT(MessageOf(Polygon::Create(std::vector<Vector2d>(5000, Vector2d(0, 0)))),
              HasSubstr("5000 corners; a polygon has at most 1000"));
  EXPECT_THAT(MessageOf(Polygon::Create({{0, 0}, {1, 0}, {std::nan(""), 1}})),
              HasSubstr("corner 3 is (nan, 1) m"));
  EXPECT_THAT(MessageOf(Polygon::Create({{0, 0}, {20'000, 0}, {1, 1}})), HasSubstr("corner 2"));
  // A bow tie, also one whose lobes cancel.
  EXPECT_THAT(MessageOf(Polygon::Create({{0, 0}, {2, 2}, {2, 0}, {0, 2}})),
              HasSubstr("the edges after corners 1 and 3 cross"));
  // An edge through a corner, and two lobes that share a corner.
  EXPECT_THAT(MessageOf(Polygon::Create({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}})),
              HasSubstr("cross or touch"));
  EXPECT_THAT(MessageOf(Polygon::Create({{0, 0}, {1, 1}, {2, 0}, {2, 2}, {1, 1}, {0, 2}})),
              HasSubstr("cross or touch"));
  // A spike; the first corner repeated at the end; no area.
  EXPECT_THAT(MessageOf(Polygon::Create({{0, 0}, {4, 0}, {2, 0}, {2, 3}})),
              HasSubstr("the edges after corners 1 and 2 cross or touch"));
  EXPECT_THAT(MessageOf(Polygon::Create({{0, 0}, {4, 0}, {4, 4}, {0, 0}})),
              HasSubstr("corners 4 and 1 are the same"));
  EXPECT_THAT(MessageOf(Polygon::Create({{0, 0}, {1e-3, 0}, {0, 1e-3}})),
              HasSubstr("encloses no ground"));
  EXPECT_THAT(MessageOf(Polygon::Rectangle({1, 1}, {1, 5})), HasSubstr("are the same"));
}

TEST(Polygon, StraightCornersAreAllowed) {
  const auto polygon = Polygon::Create({{0, 0}, {2, 0}, {4, 0}, {4, 4}, {0, 4}});
  ASSERT_TRUE(polygon);
  EXPECT_EQ(polygon->area_m2(), 16);
}

}  // namespace
}  // namespace vantage
