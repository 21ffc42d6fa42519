// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>
#include <random>
#include <vector>

#include "bench/report.h"
#include "vantage/geometry/camera.h"

namespace vantage::bench {
namespace {

/// 10,000 points spread through the view of a 1920x1080 camera with the distortion of an ordinary
/// wide lens (k1 k2 p1 p2 k3).
struct Setting {
  static constexpr std::size_t kPoints = 10'000;
  const PinholeModel lens = {.fx_px = 1050,
                             .fy_px = 1052,
                             .cx_px = 962,
                             .cy_px = 538,
                             .distortion = {-0.21, 0.06, 0.0011, -0.0007, -0.005}};
  const CameraPose pose = {
      .rotation =
          Eigen::AngleAxisd(1.9, Eigen::Vector3d(1, 0.1, -0.05).normalized()).toRotationMatrix(),
      .translation_m = {0.5, 1.2, 12}};
  const Camera camera = Camera::Create({1920, 1080}, lens, pose).value();
  std::vector<Eigen::Vector3d> points_m;

  Setting() {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> across(-0.8, 0.8);
    std::uniform_real_distribution<double> depth(5, 40);
    while (points_m.size() < kPoints) {
      const double z_m = depth(random);
      const Eigen::Vector3d camera_m(across(random) * z_m, across(random) * z_m * 0.6, z_m);
      points_m.push_back(pose.rotation.transpose() * (camera_m - pose.translation_m));
    }
  }
};

void CountPoints(benchmark::State& state) {
  state.counters["Mpoint/s"] =
      benchmark::Counter(1e-6 * Setting::kPoints, benchmark::Counter::kIsIterationInvariantRate);
}

void BM_ProjectOurs(benchmark::State& state) {
  const Setting setting;
  std::vector<Eigen::Vector2d> pixels(Setting::kPoints);
  while (state.KeepRunning()) {
    for (std::size_t i = 0; i < Setting::kPoints; ++i) {
      pixels[i] =
          setting.camera.ImageFromWorld(setting.points_m[i]).value_or(Eigen::Vector2d(0, 0));
    }
    benchmark::DoNotOptimize(pixels.data());
    benchmark::ClobberMemory();
  }
  CountPoints(state);
}
BENCHMARK(BM_ProjectOurs)->UseRealTime();

void BM_ProjectOpenCv(benchmark::State& state) {
  const Setting setting;
  std::vector<cv::Point3d> points_m;
  for (const auto& p : setting.points_m) points_m.emplace_back(p.x(), p.y(), p.z());
  const PinholeModel& lens = setting.lens;
  const cv::Matx33d matrix(lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1);
  const std::vector<double> distortion(lens.distortion.begin(), lens.distortion.begin() + 5);
  const Eigen::AngleAxisd turn(setting.pose.rotation);
  const Eigen::Vector3d axis = turn.angle() * turn.axis();
  const Eigen::Vector3d& t = setting.pose.translation_m;
  const cv::Vec3d rotation(axis.x(), axis.y(), axis.z());
  const cv::Vec3d translation(t.x(), t.y(), t.z());
  std::vector<cv::Point2d> pixels;
  while (state.KeepRunning()) {
    cv::projectPoints(points_m, rotation, translation, matrix, distortion, pixels);
    benchmark::DoNotOptimize(pixels.data());
    benchmark::ClobberMemory();
  }
  CountPoints(state);
}
BENCHMARK(BM_ProjectOpenCv)->UseRealTime();

const bool compared = Compare({.name = "geometry.project.1t.vs_opencv",
                               .ours = "BM_ProjectOurs",
                               .peer = "BM_ProjectOpenCv",
                               .peer_name = "cv::projectPoints",
                               .unit = "Mpoint/s",
                               .threads = 1});

}  // namespace
}  // namespace vantage::bench
