// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/occupied.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "vantage/base/test_support.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::MessageOf;

constexpr double kFramesPerSecond = 10;  // a window of 20 frames, 15 of which must be seen

/// Looks along y and 37 degrees down from 4 m above (0, -4).
Camera LookingAlongY() {
  Eigen::Matrix3d rotation;
  rotation << 1, 0, 0, 0, -0.6, -0.8, 0, 0.8, -0.6;
  return Camera::Create({160, 120},
                        PinholeModel{.fx_px = 140, .fy_px = 140, .cx_px = 79.5, .cy_px = 59.5},
                        {.rotation = rotation, .translation_m = {0, 0.8, 5.6}})
      .value();
}

OccupiedRegions Regions(const HoldOptions& options = {}, std::size_t cameras = 1) {
  auto regions = OccupiedRegions::Create(std::vector<Camera>(cameras, LookingAlongY()), {}, options,
                                         kFramesPerSecond);
  EXPECT_TRUE(regions) << MessageOf(regions);
  return *regions;
}

/// Somebody at these frames, [first, end), on a straight way.
Track Seen(FrameIndex first, FrameIndex end, const Eigen::Vector2d& start_m,
           const Eigen::Vector2d& speed = {0, 0}) {
  Track track;
  for (FrameIndex frame = first; frame < end; ++frame) {
    const Eigen::Vector2d at_m =
        start_m + speed * static_cast<double>(frame - first) / kFramesPerSecond;
    track.points.push_back({.frame = frame, .x_m = at_m.x(), .y_m = at_m.y()});
  }
  return track;
}

/// The rectangle that is held, of one.
cv::Rect HeldRectangle(const OccupiedRegions& regions, std::size_t camera = 0) {
  const cv::Mat& held = regions.held()[camera];
  return held.empty() ? cv::Rect() : cv::boundingRect(held);
}

enum class Found { kNothing, kObject, kGhost };

/// A verdict on one piece.
GhostVerdict VerdictOn(const cv::Rect& piece, Found found) {
  return {.judged = {{.component = {.box = piece,
                                    .area_px = piece.area(),
                                    .window = piece,
                                    .pixels = cv::Mat(piece.size(), CV_8UC1, cv::Scalar(255))},
                      .decided = found != Found::kNothing,
                      .ghost = found == Found::kGhost}},
          .ghosts = {}};
}

TEST(OccupiedRegions, HoldsTheRectangleOfWhoStandsWithAMargin) {
  OccupiedRegions regions = Regions({.margin = 0.1});
  EXPECT_TRUE(regions.held()[0].empty());
  regions.Name({Seen(0, 20, {0.5, 0.5})}, 20);
  const PixelBox box = PersonBox(LookingAlongY(), {0.5, 0.5}, {}).value();
  const double margin_px = 0.1 * box.height();
  const cv::Rect held = HeldRectangle(regions);
  EXPECT_NEAR(held.x, box.min_x - margin_px, 1);
  EXPECT_NEAR(held.y, box.min_y - margin_px, 1);
  EXPECT_NEAR(held.br().x - 1, box.max_x + margin_px, 1);
  EXPECT_NEAR(held.br().y - 1, box.max_y + margin_px, 1);
  EXPECT_EQ(cv::countNonZero(regions.held()[0]), held.area()) << "and nothing else";
}

TEST(OccupiedRegions, HoldsThePartThatIsInThePicture) {
  int cut = 0;
  for (int x_m = -12; x_m <= 12; ++x_m) {
    for (int y_m = -8; y_m <= 30; ++y_m) {
      OccupiedRegions regions = Regions({.margin = 0});
      regions.Name({Seen(0, 20, {x_m, y_m})}, 20);
      const auto box = PersonBox(LookingAlongY(), {x_m, y_m}, {});
      const cv::Rect held = HeldRectangle(regions);
      if (!box || box->max_x < -1 || box->min_x > 160 || box->max_y < -1 || box->min_y > 120) {
        EXPECT_TRUE(held.empty()) << x_m << ", " << y_m;
        continue;
      }
      const bool inside = box->min_x > 0 && box->max_x < 158 && box->min_y > 0 && box->max_y < 118;
      cut += inside || held.empty() ? 0 : 1;
      if (!inside) continue;
      EXPECT_GE(held.area(), box->width() * box->height()) << x_m << ", " << y_m;
    }
  }
  EXPECT_GT(cut, 10);
}

TEST(OccupiedRegions, HoldsNeitherWhoWalksNorBlipsNorWhatIsInferred) {
  OccupiedRegions regions = Regions();
  regions.Name({Seen(0, 20, {0, 0}, {1, 0})}, 20);
  EXPECT_TRUE(regions.held()[0].empty()) << "walks";
  regions.Name({Seen(6, 20, {0, 0})}, 20);
  EXPECT_TRUE(regions.held()[0].empty()) << "seen in 14 frames of 20";
  Track inferred = Seen(0, 20, {0, 0});
  for (std::size_t i = 5; i < 11; ++i) inferred.points[i].inferred = true;
  regions.Name({inferred}, 20);
  EXPECT_TRUE(regions.held()[0].empty()) << "seen in 14 frames, inferred between";
  regions.Name({Seen(5, 20, {0, 0}, {0.2, 0})}, 20);
  EXPECT_FALSE(regions.held()[0].empty()) << "seen in 15 frames, moves by 0.3 m";
  EXPECT_EQ(regions.report().places, 1);
}

TEST(OccupiedRegions, PeopleSideBySideAreTwoPlaces) {
  OccupiedRegions regions = Regions();
  for (FrameIndex next = 20; next < 60; next += 8) {
    regions.Name({Seen(next - 20, next, {0, 0}), Seen(next - 20, next, {0.6, 0})}, next);
  }
  EXPECT_EQ(regions.report().places, 2);
}

TEST(OccupiedRegions, ReleasesAtOnceWhereNobodyStandsAnyMore) {
  OccupiedRegions regions = Regions();
  regions.Name({Seen(0, 20, {0, 0})}, 20);
  EXPECT_FALSE(regions.held()[0].empty());
  regions.Name({}, 28);
  EXPECT_TRUE(regions.held()[0].empty());
}

TEST(OccupiedRegions, ReleasesAPlaceAfterTheLimitAndForGood) {
  OccupiedRegions regions = Regions({.limit_secs = 6});
  const auto name = [&](FrameIndex next, double x_m) {
    regions.Name({Seen(next - 20, next, {x_m, 0})}, next);
    return !regions.held()[0].empty();
  };
  FrameIndex next = 20;
  // Positions that tremble are one place.
  for (; next < 80; next += 8) EXPECT_TRUE(name(next, next % 16 == 0 ? 0.4 : -0.4)) << next;
  for (; next < 200; next += 8) EXPECT_FALSE(name(next, 0)) << next;
  // Gaps shorter than the window do not make it a new place.
  regions.Name({}, next);
  next += 8;
  EXPECT_FALSE(name(next, 0));
  EXPECT_EQ(regions.report().released_by_time, 1);
  EXPECT_EQ(regions.report().places, 1);
  // Who comes after a whole window without anybody is somebody else; so is who moves on.
  EXPECT_TRUE(name(next + 21, 0));
  EXPECT_TRUE(name(next + 29, 1.5));
  EXPECT_EQ(regions.report().places, 3);
}

TEST(OccupiedRegions, ReleasesPixelsThatVerdictsInARowFindInAGhost) {
  OccupiedRegions regions = Regions({.ghost_verdicts = 3}, 2);
  regions.Name({Seen(0, 20, {0, 0})}, 20);
  const cv::Rect held = HeldRectangle(regions);
  const cv::Rect piece(held.x + 2, held.y + 2, 5, 9);
  cv::Mat mask(120, 160, CV_8UC1, cv::Scalar(0));
  mask(held).setTo(255);
  const auto judge = [&](Found found) {
    regions.Judge(0, mask, VerdictOn(piece, found));
    regions.Judge(1, mask, {});
    return held.area() - cv::countNonZero(regions.held()[0]);
  };
  EXPECT_EQ(judge(Found::kGhost), 0);
  EXPECT_EQ(judge(Found::kGhost), 0);
  EXPECT_EQ(judge(Found::kObject), 0) << "an object after all: the count starts anew";
  EXPECT_EQ(judge(Found::kGhost), 0);
  EXPECT_EQ(judge(Found::kNothing), 0) << "not judged: does not count";
  EXPECT_EQ(judge(Found::kGhost), 0);
  EXPECT_EQ(judge(Found::kGhost), piece.area());
  EXPECT_EQ(HeldRectangle(regions, 1), held) << "each camera judges for itself";
  EXPECT_EQ(regions.report().released_as_ghosts_px, piece.area());
  // It stays released when it is named again ...
  regions.Name({Seen(8, 28, {0, 0})}, 28);
  EXPECT_EQ(held.area() - cv::countNonZero(regions.held()[0]), piece.area());
  // ... until it has become background: then it is like any other.
  mask(piece).setTo(0);
  regions.Judge(0, mask, {});
  regions.Name({Seen(16, 36, {0, 0})}, 36);
  EXPECT_EQ(HeldRectangle(regions), held);
  EXPECT_EQ(cv::countNonZero(regions.held()[0]), held.area());
}

TEST(OccupiedRegions, RejectsWhatMakesNoSense) {
  const auto create = [](const HoldOptions& options, double frames_per_second) {
    return MessageOf(OccupiedRegions::Create({}, {}, options, frames_per_second));
  };
  EXPECT_EQ(create({}, 25), "");
  EXPECT_THAT(create({.window_secs = 0}, 25), HasSubstr("hold.window is 0"));
  EXPECT_THAT(create({.limit_secs = -1}, 25), HasSubstr("hold.limit is -1"));
  EXPECT_THAT(create({.ghost_verdicts = 0}, 25), HasSubstr("hold.ghost_verdicts is 0"));
  EXPECT_THAT(create({}, 0), HasSubstr("frames per second"));
  EXPECT_THAT(create({}, std::nan("")), HasSubstr("frames per second"));
}

}  // namespace
}  // namespace vantage
