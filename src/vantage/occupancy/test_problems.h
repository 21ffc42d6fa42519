// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "vantage/geometry/camera.h"
#include "vantage/geometry/grid.h"
#include "vantage/geometry/person.h"
#include "vantage/occupancy/occupancy_oracle.h"
#include "vantage/occupancy/solver.h"

/// Occupancy problems for tests only; not installed.

namespace vantage::testing {

/// Solves with a solver of the problem's own; a failure fails the test.
std::vector<float> Solve(const OccupancyProblem& problem, SolveReport* report = nullptr);

/// The cells above one half.
std::vector<std::size_t> Raised(const std::vector<float>& q);

/// Uniform random numbers from a fixed seed.
class RandomNumbers {
 public:
  explicit RandomNumbers(unsigned seed) : engine_(seed) {}
  int Int(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  double Real(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  bool Chance(double probability) { return Real(0, 1) < probability; }

 private:
  std::mt19937 engine_;
};

/// Rectangles anywhere, with no geometry behind them: masks hold those of some cells and some
/// noise. Some masks are soft, reduced, partly blind or missing; some cells are not visible, have a
/// prior of their own or a previous presence, or count less; both evidences and dampings.
OccupancyProblem RandomProblem(RandomNumbers& random);

/// A hall with cameras in its corners and in the middles of its walls.
struct Hall {
  GroundGrid grid;
  std::vector<Camera> cameras;
  PersonOptions person;

  /// 8 x 6 m, 1 to 8 cameras.
  Hall(int camera_count, ImageSize size, double cell_m);

  std::vector<CameraView> Views(Visibility rule = Visibility::kCentre) const;
  /// Rectangles of people in all cameras, 255 on 0; a pixel is a person's when its centre is.
  std::vector<cv::Mat> Silhouettes(const std::vector<Eigen::Vector2d>& people_m) const;
  /// `count` people or fewer, at least `apart_m` from each other and 0.5 m from the walls.
  std::vector<Eigen::Vector2d> People(RandomNumbers& random, int count, double apart_m) const;
};

/// Turns pixels around in blobs of up to `side_px`, until this share of the mask has been visited.
void AddBlobs(RandomNumbers& random, double share, int side_px, cv::Mat& mask);

}  // namespace vantage::testing
