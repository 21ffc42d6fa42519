// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/appearance.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "vantage/geometry/test_cameras.h"

namespace vantage {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

const PersonOptions kPerson;
const cv::Vec3b kGreen(20, 200, 30);
const cv::Vec3b kOrange(0, 120, 250);

/// 320 x 240, 8 m from the middle of the ground, on the side of this angle.
Camera CameraAt(double height_m, double angle = 0) {
  const Eigen::Vector3d center_m(8 * std::sin(angle), -8 * std::cos(angle), height_m);
  return *Camera::Create({320, 240},
                         PinholeModel{.fx_px = 320, .fy_px = 320, .cx_px = 159.5, .cy_px = 119.5},
                         testing::LookAt(center_m, {0, 0, 0.9}));
}

Peak At(double x_m, double y_m, CellIndex cell = 1) {
  return {.cell = cell, .position_m = {x_m, y_m}, .probability = 0.9F};
}

/// What one camera delivers: a background of noise, nothing in the foreground.
struct Shot {
  explicit Shot(const Camera& seen_by) : camera(seen_by), picture(240, 320, CV_8UC3) {
    cv::RNG(7).fill(picture, cv::RNG::UNIFORM, 0, 256);
  }

  /// Calls `paint(pixel, band)` for the pixels of the person, whose centres the rectangle has.
  template <class Paint>
  void ForPixelsOf(const Peak& person, const Paint& paint) const {
    const PixelBox box = *PersonBox(camera, person.position_m, kPerson);
    for (int y = 0; y < picture.rows; ++y) {
      for (int x = 0; x < picture.cols; ++x) {
        if (x < box.min_x || x > box.max_x || y < box.min_y || y > box.max_y) continue;
        const int band = static_cast<int>(kAppearanceBands * (box.max_y - y) / box.height());
        paint(cv::Point(x, y), std::min(band, kAppearanceBands - 1));
      }
    }
  }
  /// The whole rectangle in one colour for each band, in the foreground.
  void Put(const Peak& person, const std::vector<cv::Vec3b>& colors) {
    ForPixelsOf(person, [&](const cv::Point& at, int band) {
      picture.at<cv::Vec3b>(at) = colors[static_cast<std::size_t>(band) % colors.size()];
      mask.at<std::uint8_t>(at) = 255;
    });
  }

  Camera camera;
  cv::Mat picture;
  cv::Mat mask = cv::Mat::zeros(240, 320, CV_8UC1);
  cv::Mat informative = {};
};

Appearances Look(const std::vector<Shot>& shots, const std::vector<Peak>& people) {
  std::vector<AppearanceSampler::View> views;
  std::vector<cv::Mat> pictures, masks;
  for (const Shot& shot : shots) {
    views.push_back({.camera = shot.camera, .informative = shot.informative});
    pictures.push_back(shot.picture);
    masks.push_back(shot.mask);
  }
  Appearances appearances;
  AppearanceSampler(views, kPerson).Look(5, pictures, masks, people, appearances);
  return appearances;
}

std::array<float, 3> Band(const Appearance& seen, int band) {
  const auto at = static_cast<std::size_t>(3 * band);
  return {seen.colors[at], seen.colors[at + 1], seen.colors[at + 2]};
}

std::array<float, 3> LabOf(const cv::Vec3b& color) {
  cv::Mat lab;
  cv::cvtColor(cv::Mat(1, 1, CV_8UC3, cv::Scalar(color)), lab, cv::COLOR_BGR2Lab);
  const auto value = lab.at<cv::Vec3b>(0, 0);
  return {static_cast<float>(value[0]), static_cast<float>(value[1]), static_cast<float>(value[2])};
}

bool IsMissing(const Appearance& seen, int band) {
  return std::ranges::all_of(Band(seen, band), [](float value) { return std::isnan(value); });
}

/// All bands of this colour.
void ExpectAll(const Appearance& seen, const cv::Vec3b& color) {
  for (int band = 0; band < kAppearanceBands; ++band) {
    EXPECT_EQ(Band(seen, band), LabOf(color)) << band;
  }
}

/// The same bits, where nothing is known, too.
bool Same(const Appearances& a, const Appearances& b) {
  return std::ranges::equal(a, b, [](const Appearance& one, const Appearance& other) {
    return one.frame == other.frame && one.cell == other.cell && one.camera == other.camera &&
           std::ranges::equal(one.colors, other.colors, [](float x, float y) {
             return x == y || (std::isnan(x) && std::isnan(y));
           });
  });
}

TEST(AppearanceSampler, BandsAreFromTheFeetUp) {
  const std::vector<cv::Vec3b> colors = {{10, 10, 10},  {200, 30, 30}, {30, 200, 30},
                                         {30, 30, 200}, {0, 220, 220}, {250, 250, 250}};
  Shot shot(CameraAt(2.5));
  shot.Put(At(0.3, 0.5), colors);
  const Appearances seen = Look({shot}, {At(0.3, 0.5, 77)});
  ASSERT_THAT(seen, SizeIs(1));
  EXPECT_EQ(seen[0].frame, 5);
  EXPECT_EQ(seen[0].cell, 77);
  EXPECT_EQ(seen[0].camera, 0);
  for (int band = 0; band < kAppearanceBands; ++band) {
    EXPECT_EQ(Band(seen[0], band), LabOf(colors[static_cast<std::size_t>(band)])) << band;
  }
}

TEST(AppearanceSampler, MedianOfTheForegroundOnly) {
  const Peak person = At(0, 0);
  Shot shot(CameraAt(2.5));
  const double middle_px = shot.camera.ImageFromWorld({0, 0, 0})->x();
  // Less than half of the rectangle is the person: dark, a stripe of middle grey, light.
  shot.ForPixelsOf(person, [&](const cv::Point& at, int) {
    const double off_px = std::abs(at.x - middle_px);
    const bool is_person = off_px < 4;
    const bool is_left = at.x < middle_px;
    shot.picture.at<cv::Vec3b>(at) = !is_person     ? kOrange
                                     : off_px < 1.5 ? cv::Vec3b(90, 90, 90)
                                     : is_left      ? cv::Vec3b(20, 20, 20)
                                                    : cv::Vec3b(200, 200, 200);
    shot.mask.at<std::uint8_t>(at) = is_person ? 128 : 127;
  });
  Appearances seen = Look({shot}, {person});
  ASSERT_THAT(seen, SizeIs(1));
  ExpectAll(seen[0], {90, 90, 90});

  // Of one band nothing is foreground, then of none.
  shot.ForPixelsOf(person, [&](const cv::Point& at, int band) {
    if (band == 2) shot.mask.at<std::uint8_t>(at) = 0;
  });
  seen = Look({shot}, {person});
  ASSERT_THAT(seen, SizeIs(1));
  for (int band = 0; band < kAppearanceBands; ++band) {
    EXPECT_EQ(IsMissing(seen[0], band), band == 2) << band;
  }
  shot.mask.setTo(127);
  EXPECT_THAT(Look({shot}, {person}), IsEmpty());
}

/// How much of each band is in no rectangle of the others.
std::array<double, kAppearanceBands> OpenShares(const Shot& shot, const Peak& person,
                                                const std::vector<Peak>& nearer) {
  cv::Mat hidden = cv::Mat::zeros(shot.picture.size(), CV_8UC1);
  for (const Peak& other : nearer) {
    shot.ForPixelsOf(other, [&](const cv::Point& at, int) { hidden.at<std::uint8_t>(at) = 1; });
  }
  std::array<double, kAppearanceBands> open = {}, all = {};
  shot.ForPixelsOf(person, [&](const cv::Point& at, int band) {
    all[static_cast<std::size_t>(band)] += 1;
    open[static_cast<std::size_t>(band)] += hidden.at<std::uint8_t>(at) == 0;
  });
  for (std::size_t band = 0; band < open.size(); ++band) open[band] /= all[band];
  return open;
}

/// Bands that are surely seen are of the colour, those surely hidden are missing.
void ExpectSeen(const Appearance& seen, const std::array<double, kAppearanceBands>& open,
                const cv::Vec3b& color) {
  int shown = 0, hidden = 0;
  for (int band = 0; band < kAppearanceBands; ++band) {
    const double share = open[static_cast<std::size_t>(band)];
    if (share > 0.8) {
      ++shown;
      EXPECT_EQ(Band(seen, band), LabOf(color)) << band;
    } else if (share < 0.6) {
      ++hidden;
      EXPECT_TRUE(IsMissing(seen, band)) << band;
    }
  }
  EXPECT_GE(shown, 1);
  EXPECT_GE(hidden, 1);
}

TEST(AppearanceSampler, WhoIsBehindIsSeenWhereNobodyHidesThem) {
  const Peak near = At(0.1, -1, 3), far = At(0, 1.5, 9);
  Shot shot(CameraAt(4));
  shot.Put(far, {kGreen});
  shot.Put(near, {kOrange});
  for (const bool near_first : {true, false}) {
    const Appearances seen =
        Look({shot}, near_first ? std::vector{near, far} : std::vector{far, near});
    ASSERT_THAT(seen, SizeIs(2));
    const bool first_is_near = seen[0].cell == 3;
    ExpectAll(seen[first_is_near ? 0 : 1], kOrange);
    ExpectSeen(seen[first_is_near ? 1 : 0], OpenShares(shot, far, {near}), kGreen);
  }
}

TEST(AppearanceSampler, WhoIsWhollyHiddenHasNoAppearance) {
  const Peak near = At(0, -1, 3), far = At(0, 1.5, 9);
  Shot shot(CameraAt(0.9));
  shot.Put(far, {kGreen});
  shot.Put(near, {kOrange});
  const Appearances seen = Look({shot}, {far, near});
  ASSERT_THAT(seen, SizeIs(1));
  EXPECT_EQ(seen[0].cell, 3);
  ExpectAll(seen[0], kOrange);
  EXPECT_THAT(Look({shot}, {far}), SizeIs(1)) << "alone";
}

TEST(AppearanceSampler, WhoIsPartlyOutsideHidesButIsNotSeen) {
  // Feet below the picture.
  const Peak near = At(0.2, -5, 3), far = At(0.2, 1, 9);
  Shot shot(CameraAt(2.2));
  const PixelBox box = *PersonBox(shot.camera, near.position_m, kPerson);
  ASSERT_GT(box.max_y, 250);
  shot.Put(far, {kGreen});
  shot.Put(near, {kOrange});
  const Appearances seen = Look({shot}, {near, far});
  ASSERT_THAT(seen, SizeIs(1));
  EXPECT_EQ(seen[0].cell, 9);
  ExpectSeen(seen[0], OpenShares(shot, far, {near}), kGreen);
  EXPECT_THAT(Look({shot}, {At(50, 0), At(0, -30)}), IsEmpty()) << "not in the picture at all";
}

TEST(AppearanceSampler, CamerasWithoutPictureOrMaskHaveSeenNobody) {
  std::vector<Shot> shots;
  for (int camera = 0; camera < 3; ++camera) {
    shots.emplace_back(CameraAt(2.5, camera)).Put(At(0, 0), {kGreen});
  }
  ASSERT_THAT(Look(shots, {At(0, 0)}), SizeIs(3));
  shots[0].picture = cv::Mat();
  shots[2].mask = cv::Mat();
  const Appearances seen = Look(shots, {At(0, 0)});
  ASSERT_THAT(seen, SizeIs(1));
  EXPECT_EQ(seen[0].camera, 1);
  EXPECT_THAT(Look(shots, {}), IsEmpty());
}

TEST(AppearanceSampler, BlindPixelsDoNotCount) {
  const Peak person = At(0, 0);
  Shot shot(CameraAt(2.5));
  shot.informative = cv::Mat(240, 320, CV_8UC1, cv::Scalar(255));
  const PixelBox box = *PersonBox(shot.camera, person.position_m, kPerson);
  // A blind stripe of orange on the left; as much green in the foreground would be the minority.
  shot.ForPixelsOf(person, [&](const cv::Point& at, int) {
    const double share = (at.x - box.min_x) / box.width();
    const bool is_blind = share < 0.25;
    shot.picture.at<cv::Vec3b>(at) = is_blind ? kOrange : kGreen;
    shot.mask.at<std::uint8_t>(at) = is_blind || share > 0.85 ? 255 : 0;
    if (is_blind) shot.informative.at<std::uint8_t>(at) = 0;
  });
  Appearances seen = Look({shot}, {person});
  ASSERT_THAT(seen, SizeIs(1));
  ExpectAll(seen[0], kGreen);
  Shot all = shot;
  all.informative = cv::Mat();
  ExpectAll(Look({all}, {person}).at(0), kOrange);

  // A post that hides the legs hides those bands; one that hides all leaves nothing.
  shot.Put(person, {kGreen});
  shot.ForPixelsOf(person, [&](const cv::Point& at, int band) {
    shot.informative.at<std::uint8_t>(at) = band < 2 ? 0 : 255;
  });
  seen = Look({shot}, {person});
  ASSERT_THAT(seen, SizeIs(1));
  for (int band = 0; band < kAppearanceBands; ++band) {
    EXPECT_EQ(IsMissing(seen[0], band), band < 2) << band;
  }
  // Nor is there enough to see beside one that hides half of every band.
  shot.informative.setTo(255);
  shot.informative.colRange(160, 320).setTo(0);
  EXPECT_THAT(Look({shot}, {person}), IsEmpty());
}

TEST(AppearanceSampler, AppendsByCameraTheSameFromAnyThread) {
  std::vector<Peak> people;
  for (int i = 0; i < 9; ++i) people.push_back(At(0.9 * (i % 3) - 1, 0.8 * (i / 3) - 1, i));
  std::vector<AppearanceSampler::View> views;
  std::vector<cv::Mat> pictures, masks;
  for (int camera = 0; camera < 4; ++camera) {
    Shot shot(CameraAt(3, camera));
    for (const Peak& person : people) shot.Put(person, {kGreen, kOrange});
    cv::RNG(1).fill(shot.picture, cv::RNG::UNIFORM, 0, 256);
    views.push_back(
        {.camera = shot.camera, .informative = cv::Mat(240, 320, CV_8UC1, cv::Scalar(255))});
    pictures.push_back(shot.picture);
    masks.push_back(shot.mask);
  }
  const AppearanceSampler sampler(views, kPerson);
  const auto look = [&](Appearances& appearances) {
    for (int frame = 0; frame < 5; ++frame) {
      sampler.Look(frame, pictures, masks, people, appearances);
    }
  };
  Appearances alone;
  look(alone);
  EXPECT_THAT(alone, SizeIs(::testing::Gt(60)));
  EXPECT_TRUE(std::ranges::is_sorted(alone, {}, [](const Appearance& seen) {
    return std::pair(seen.frame, seen.camera);
  })) << "appended to what is there";
  std::vector<Appearances> together(4);
  std::vector<std::thread> threads;
  for (Appearances& appearances : together) threads.emplace_back([&] { look(appearances); });
  for (std::thread& thread : threads) thread.join();
  for (const Appearances& appearances : together) EXPECT_TRUE(Same(appearances, alone));
}

}  // namespace
}  // namespace vantage
