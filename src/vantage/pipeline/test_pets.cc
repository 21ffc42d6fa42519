// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/pipeline/test_pets.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <random>
#include <set>
#include <stdexcept>
#include <string>

#include "vantage/base/file.h"
#include "vantage/base/test_support.h"
#include "vantage/tracks/track_file.h"

namespace vantage::testing {
namespace {

using Eigen::Vector2d;

struct Body {
  Vector2d foot_m;
  double breadth_m = 0;
  double height_m = 0;
};

Body BodyOf(TrackId id, const Vector2d& foot_m) {
  std::mt19937 random(static_cast<unsigned>(id));
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  const double breadth_m = between(0.45, 0.6);
  return {foot_m, breadth_m, between(1.6, 1.9)};
}

/// Fills an ellipse of the upright plane over `foot_m` that faces the camera, unless part of it
/// cannot be projected.
void FillEllipse(const Camera& camera, const Vector2d& foot_m, double middle_m, double half_width_m,
                 double half_height_m, cv::Mat& mask) {
  const Vector2d from_camera = foot_m - camera.center_m().head<2>();
  const Vector2d right = Vector2d(from_camera.y(), -from_camera.x()).normalized();
  constexpr int kPoints = 40;
  constexpr int kShift = 4;  // sixteenths of a pixel
  constexpr double kFarthest_px = 1e5;
  std::vector<cv::Point> outline;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoints;
    const Vector2d at_m = foot_m + half_width_m * std::cos(angle) * right;
    const double z_m = middle_m + half_height_m * std::sin(angle);
    const auto pixel = camera.ImageFromWorld({at_m.x(), at_m.y(), z_m});
    if (!pixel || pixel->cwiseAbs().maxCoeff() > kFarthest_px) return;
    outline.emplace_back(static_cast<int>(std::lround(pixel->x() * (1 << kShift))),
                         static_cast<int>(std::lround(pixel->y() * (1 << kShift))));
  }
  cv::fillPoly(mask, std::vector{outline}, cv::Scalar(255), cv::LINE_8, kShift);
}

cv::Mat Draw(const Camera& camera, const std::vector<Body>& bodies) {
  cv::Mat mask = cv::Mat::zeros(camera.size().height, camera.size().width, CV_8UC1);
  for (const Body& body : bodies) {
    const double h = body.height_m;
    FillEllipse(camera, body.foot_m, 0.43 * h, body.breadth_m / 2, 0.43 * h, mask);
    FillEllipse(camera, body.foot_m, 0.92 * h, 0.10, 0.08 * h, mask);
  }
  return mask;
}

Scene SceneOf(const std::filesystem::path& folder, const Polygon& area,
              const std::vector<int>& views) {
  std::string toml = "name = \"simulated\"\nframes_per_second = 7.0\n[area]\npolygon = [";
  for (const Vector2d& corner : area.corners_m()) {
    toml += fmt::format("[{:.4f}, {:.4f}], ", corner.x(), corner.y());
  }
  toml += "]\n[grid]\ncell = 0.5\n";
  for (const int view : views) {
    toml += fmt::format(
        "[[cameras]]\nname = \"View_00{0}\"\nsource = {{ masks = \"View_00{0}/%06d.png\" }}\n"
        "calibration = {{ tsai_xml = \"calibration/View_00{0}.xml\" }}\n",
        view);
  }
  const TemporaryFolder temporary;
  const Status written = WriteTextFile(temporary / "scene.toml", toml);
  if (!written) throw std::runtime_error(written.error().message);
  return LoadScene(temporary / "scene.toml", folder).value();
}

}  // namespace

SimulatedPets SimulatePets(const std::filesystem::path& folder, const Polygon& area,
                           const std::vector<int>& views, FrameIndex every) {
  SimulatedPets pets;
  pets.scene = SceneOf(folder, area, views);
  pets.truth = ReadTracks(folder / "gt-mot15-3d.txt").value();
  std::set<FrameIndex> frames;
  for (Track& track : pets.truth) {
    std::erase_if(track.points, [&](const TrackPoint& point) { return point.frame % every != 0; });
    for (const TrackPoint& point : track.points) frames.insert(point.frame);
  }
  std::erase_if(pets.truth, [](const Track& track) { return track.points.empty(); });
  pets.frames.assign(frames.begin(), frames.end());

  std::vector<Camera> cameras;
  for (const SceneCamera& camera : pets.scene.cameras) cameras.push_back(camera.camera);
  pets.masks = [cameras, truth = pets.truth](FrameIndex frame) {
    std::vector<Body> bodies;
    for (const Track& track : truth) {
      for (const TrackPoint& point : track.points) {
        if (point.frame == frame) bodies.push_back(BodyOf(track.id, {point.x_m, point.y_m}));
      }
    }
    std::vector<cv::Mat> masks;
    for (const Camera& camera : cameras) masks.push_back(Draw(camera, bodies));
    return masks;
  };
  return pets;
}

}  // namespace vantage::testing
