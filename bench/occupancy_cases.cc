// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "bench/occupancy_cases.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <utility>

#include "vantage/base/test_support.h"
#include "vantage/geometry/person.h"
#include "vantage/occupancy/peaks.h"
#include "vantage/occupancy/pom_file.h"
#include "vantage/occupancy/test_wildtrack.h"

namespace vantage::bench {
namespace {

OccupancyCase Missing() {
  OccupancyCase problem;
  problem.missing = "research data is absent (VANTAGE_TEST_DATA, or ../shared/data)";
  return problem;
}

void BuildViews(const std::vector<Camera>& cameras, const PersonOptions& person,
                OccupancyCase& problem) {
  for (const Camera& camera : cameras) {
    const auto view = [&](int reduction) {
      return BuildView(camera, problem.grid, person, Visibility::kCentre, reduction).value();
    };
    problem.views.push_back(view(1));
    problem.fast_views.push_back(view(AutomaticReduction(camera, problem.grid, person)));
  }
}

OccupancyCase ReadPom() {
  if (testing::DataFolder().empty()) return Missing();
  PomFile file = ReadPomFile(testing::DataFolder() / "pom/test.pom").value();
  OccupancyCase problem;
  problem.has_truth = false;
  problem.options = file.options;
  const PomFile::Frames& frames = file.frames.front();
  for (std::int64_t frame = frames.first; frame < frames.first + frames.count; ++frame) {
    OccupancyFrame& read = problem.frames.emplace_back();
    for (std::size_t camera = 0; camera < file.views.size(); ++camera) {
      read.masks.push_back(
          cv::imread(file.InputPath(camera, frame).string(), cv::IMREAD_GRAYSCALE));
    }
  }
  problem.views = std::move(file.views);
  problem.fast_views = problem.views;  // its rectangles are given in pixels of these pictures
  return problem;
}

OccupancyCase ReadWildtrack() {
  if (testing::DataFolder().empty()) return Missing();
  const testing::WildtrackData data(testing::DataFolder() / "wildtrack", 2);
  OccupancyCase problem;
  problem.grid = testing::WildtrackData::Grid(0.2);
  problem.options.ignored = 0.99;
  problem.options.variance = 2e-4;  // of 0.01 to 1e-4, the one with which the authors' scheme finds
                                    // most people of this crowd
  BuildViews(data.cameras(), {.width_m = 0.5, .height_m = 1.8}, problem);
  for (std::size_t i = 0; i < 6; ++i) {
    testing::WildtrackFrame frame = data.Frame(50 * i);
    problem.frames.push_back({std::move(frame.masks), std::move(frame.people_m)});
  }
  return problem;
}

// --- The hall
// -------------------------------------------------------------------------------------------------

constexpr double kHalfLength_m = 20, kHalfWidth_m = 10;

/// 8 m up, 2 m outside the hall: four corners, then the middles of the sides. Any first two, four
/// or all eight see the hall from sides that differ as much as they can.
Camera ArenaCamera(int index, ImageSize size) {
  constexpr double kX[] = {-22, 22, 22, -22, 0, 0, -22, 22};
  constexpr double kY[] = {-12, 12, -12, 12, -12, 12, 0, 0};
  const Eigen::Vector3d center_m(kX[index], kY[index], 8);
  const Eigen::Vector3d forward = (Eigen::Vector3d(0, 0, 0.5) - center_m).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  CameraPose pose;
  pose.rotation << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  pose.translation_m = -pose.rotation * center_m;
  const double focal_px = 0.62 * size.width;  // 78 degrees across
  const PinholeModel lens{.fx_px = focal_px,
                          .fy_px = focal_px,
                          .cx_px = (size.width - 1) / 2.0,
                          .cy_px = (size.height - 1) / 2.0};
  return Camera::Create(size, lens, pose).value();
}

void DrawEllipse(cv::Mat& mask, const PixelBox& box) {
  constexpr int kShift = 4;  // cv::ellipse takes sixteenths of a pixel
  const auto fixed = [](double pixels) {
    return static_cast<int>(std::lround(pixels * (1 << kShift)));
  };
  cv::ellipse(mask, {fixed((box.min_x + box.max_x) / 2), fixed((box.min_y + box.max_y) / 2)},
              {fixed(box.width() / 2), fixed(box.height() / 2)}, 0, 0, 360, cv::Scalar(255),
              cv::FILLED, cv::LINE_8, kShift);
}

/// Somebody walks straight on through the hall and turns at its walls.
struct Walker {
  Eigen::Vector2d start_m, velocity_mps;
  double width_m, height_m;

  Eigen::Vector2d At(double seconds) const {
    // Half a metre from the walls; folding the straight way back in is reflection.
    const auto fold = [](double along, double half) {
      const double period = 4 * half;
      const double phase = std::fmod(std::fmod(along + half, period) + period, period);
      return phase < 2 * half ? phase - half : 3 * half - phase;
    };
    const Eigen::Vector2d straight_m = start_m + seconds * velocity_mps;
    return {fold(straight_m.x(), kHalfLength_m - 0.5), fold(straight_m.y(), kHalfWidth_m - 0.5)};
  }

  /// A body as an ellipse up to the shoulders, and a head.
  void Draw(const Camera& camera, double seconds, cv::Mat& mask) const {
    const Eigen::Vector2d foot_m = At(seconds);
    const auto whole = PersonBox(camera, foot_m, {.width_m = 0.25, .height_m = height_m});
    const auto body = PersonBox(camera, foot_m, {.width_m = width_m, .height_m = 0.88 * height_m});
    if (!whole || !body) return;
    DrawEllipse(mask, *body);
    PixelBox head = *whole;
    head.max_y = head.min_y + 0.16 * whole->height();
    DrawEllipse(mask, head);
  }
};

std::vector<Walker> Walkers() {
  std::mt19937 engine(4);
  const auto between = [&engine](double low, double high) {
    return low + (high - low) * static_cast<double>(engine() % 10000) / 10000;
  };
  std::vector<Walker> walkers;
  for (int i = 0; i < 12; ++i) {
    Walker walker;
    walker.start_m.x() = between(-kHalfLength_m, kHalfLength_m);
    walker.start_m.y() = between(-kHalfWidth_m, kHalfWidth_m);
    const double speed_mps = between(0.5, 3), heading = between(0, 2 * std::numbers::pi);
    walker.velocity_mps = {speed_mps * std::cos(heading), speed_mps * std::sin(heading)};
    walker.width_m = between(0.45, 0.6);
    walker.height_m = between(1.6, 1.9);
    walkers.push_back(walker);
  }
  return walkers;
}

}  // namespace

OccupancyCase MakeArena(const ArenaOptions& options) {
  constexpr int kFrames = 6;
  constexpr double kBetweenFrames_secs = 2;
  OccupancyCase problem;
  const auto cells = [&](double half_m) {
    return static_cast<int>(std::lround(2 * half_m / options.cell_m));
  };
  problem.grid = {-kHalfLength_m, -kHalfWidth_m, options.cell_m, cells(kHalfLength_m),
                  cells(kHalfWidth_m)};
  problem.options.ignored = 0.99;
  problem.options.variance = 0.003;  // likewise
  std::vector<Camera> cameras;
  for (int c = 0; c < options.cameras; ++c) cameras.push_back(ArenaCamera(c, options.size));
  BuildViews(cameras, {}, problem);
  const std::vector<Walker> walkers = Walkers();
  for (int f = 0; f < kFrames; ++f) {
    const double now_secs = kBetweenFrames_secs * f;
    OccupancyFrame& frame = problem.frames.emplace_back();
    for (const Walker& walker : walkers) frame.people_m.push_back(walker.At(now_secs));
    for (const Camera& camera : cameras) {
      cv::Mat mask = cv::Mat::zeros(options.size.height, options.size.width, CV_8UC1);
      for (const Walker& walker : walkers) walker.Draw(camera, now_secs, mask);
      frame.masks.push_back(mask);
    }
  }
  return problem;
}

const OccupancyCase& PomCase() {
  static const OccupancyCase problem = ReadPom();
  return problem;
}

const OccupancyCase& WildtrackCase() {
  static const OccupancyCase problem = ReadWildtrack();
  return problem;
}

const OccupancyCase& ArenaCase() {
  static const OccupancyCase problem = MakeArena({});
  return problem;
}

double Moda(const OccupancyCase& problem, const std::vector<std::vector<float>>& maps) {
  std::size_t people = 0, found = 0, matched = 0;
  for (std::size_t i = 0; i < problem.frames.size(); ++i) {
    const std::vector<Peak> peaks = FindPeaks(problem.grid, maps[i], {.distance_m = 0.5}).value();
    people += problem.frames[i].people_m.size();
    found += peaks.size();
    matched +=
        static_cast<std::size_t>(testing::CountMatches(peaks, problem.frames[i].people_m, 0.5));
  }
  const auto errors = static_cast<double>(people + found - 2 * matched);
  return 1 - errors / static_cast<double>(people);
}

}  // namespace vantage::bench
