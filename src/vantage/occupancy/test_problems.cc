// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/test_problems.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "vantage/base/test_support.h"
#include "vantage/geometry/test_cameras.h"

namespace vantage::testing {
namespace {

cv::Rect RandomRectangle(RandomNumbers& random, ImageSize size) {
  cv::Rect r(random.Int(0, size.width - 1), random.Int(0, size.height - 1), 0, 0);
  r.width = random.Int(1, std::min(size.width - r.x, 12));
  r.height = random.Int(1, std::min(size.height - r.y, 20));
  return r;
}

/// Where `r` of a picture of `size` is in one of `full` size, rounded.
cv::Rect Enlarged(const cv::Rect& r, ImageSize size, ImageSize full) {
  const auto x = [&](int at) { return at * full.width / size.width; };
  const auto y = [&](int at) { return at * full.height / size.height; };
  return {cv::Point(x(r.x), y(r.y)), cv::Point(x(r.x + r.width), y(r.y + r.height))};
}

void AddRandomCamera(RandomNumbers& random, const std::vector<bool>& occupied,
                     OccupancyProblem& problem) {
  const ImageSize size{random.Int(3, 40), random.Int(3, 30)};
  ImageSize full = size;
  if (random.Chance(0.3)) {
    const bool whole = random.Chance(0.5);  // or a fraction
    const int factor = random.Int(2, 3);
    full.width = whole ? size.width * factor : random.Int(size.width, 3 * size.width);
    full.height = whole ? size.height * factor : random.Int(size.height, 3 * size.height);
  }
  CameraView view{full, size, {}};
  cv::Mat mask(full.height, full.width, CV_8UC1, cv::Scalar(0));
  const bool soft = random.Chance(0.33), weighted = random.Chance(0.33);
  for (const bool present : occupied) {
    const cv::Rect r = random.Chance(0.17) ? cv::Rect() : RandomRectangle(random, size);
    view.rectangles.push_back(r);
    if (present) mask(Enlarged(r, size, full)) = soft ? random.Int(100, 255) : 255;
    if (!weighted) continue;
    view.weights.push_back(random.Chance(0.2) ? 0 : static_cast<float>(random.Real(0, 1)));
  }
  for (int k = random.Int(0, 20); k > 0; --k) {
    mask.at<std::uint8_t>(random.Int(0, full.height - 1), random.Int(0, full.width - 1)) =
        static_cast<std::uint8_t>(soft ? random.Int(0, 255) : 255 * random.Int(0, 1));
  }
  if (random.Chance(0.3)) {
    view.informative = cv::Mat(full.height, full.width, CV_8UC1, cv::Scalar(255));
    view.informative(RandomRectangle(random, full)) = 0;
    if (random.Chance(0.05)) view.informative = 0;
  }
  problem.views.push_back(view);
  problem.masks.push_back(random.Chance(0.12) ? cv::Mat() : mask);
}

}  // namespace

std::vector<float> Solve(const OccupancyProblem& problem, SolveReport* report) {
  const auto solver = OccupancySolver::Create(problem.views, problem.options, problem.priors);
  if (!solver) {
    ADD_FAILURE() << MessageOf(solver);
    return {};
  }
  std::vector<float> q(solver->cell_count());
  const auto solved = solver->Solve(problem.masks, q, problem.previous);
  EXPECT_EQ(MessageOf(solved), "");
  if (report != nullptr && solved) *report = *solved;
  return q;
}

std::vector<std::size_t> Raised(const std::vector<float>& q) {
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (q[i] > 0.5F) cells.push_back(i);
  }
  return cells;
}

OccupancyProblem RandomProblem(RandomNumbers& random) {
  OccupancyProblem problem;
  OccupancyOptions& o = problem.options;
  const int cameras = random.Int(1, 4), cells = random.Int(1, 40);
  std::vector<bool> occupied(static_cast<std::size_t>(cells));
  for (auto&& cell : occupied) cell = random.Chance(0.1);
  for (int c = 0; c < cameras; ++c) AddRandomCamera(random, occupied, problem);
  if (random.Chance(0.3)) {
    for (int i = 0; i < cells; ++i) problem.priors.push_back(random.Real(0.001, 0.3));
  }
  if (random.Chance(0.3)) {
    for (int i = 0; i < cells; ++i) {
      problem.previous.push_back(
          static_cast<float>(random.Chance(0.1) ? random.Int(0, 1) : random.Real(0, 1)));
    }
  }
  o.evidence = random.Chance(0.5) ? Evidence::kPerson : Evidence::kPicture;
  o.mode = SolveMode::kExact;
  o.damping = random.Chance(0.5) ? Damping::kAdaptive : Damping::kFixed;
  o.prior = random.Real(0.005, 0.1);
  o.worth = random.Real(1, 60);
  o.background_cost = random.Real(0, 1.5);
  o.variance = std::pow(10, random.Real(-3, -1));
  o.noise = std::pow(10, random.Real(-3, -1));
  o.smoothing = random.Real(0.5, 0.95);
  o.ignored = random.Chance(0.5) ? 1.0 : 0.995;
  o.max_iterations = random.Int(1, 100);
  o.stable_iterations = random.Int(1, 5);
  o.tolerance = random.Chance(0.5) ? 1e-4 : 1e-2;
  return problem;
}

Hall::Hall(int camera_count, ImageSize size, double cell_m)
    : grid{0, 0, cell_m, static_cast<int>(std::lround(8 / cell_m)),
           static_cast<int>(std::lround(6 / cell_m))} {
  constexpr double kPlaces_m[8][2] = {{-2, -2}, {10, 8}, {10, -2}, {-2, 8},
                                      {4, -4},  {-4, 3}, {4, 10},  {12, 3}};
  for (int c = 0; c < camera_count; ++c) {
    const auto [x, y] = kPlaces_m[c];
    const PinholeModel lens{.fx_px = 0.7 * size.width,
                            .fy_px = 0.7 * size.width,
                            .cx_px = (size.width - 1) / 2.0,
                            .cy_px = (size.height - 1) / 2.0};
    cameras.push_back(Camera::Create(size, lens, LookAt({x, y, 3}, {4 + 0.1 * c, 3, 0.8})).value());
  }
}

std::vector<CameraView> Hall::Views(Visibility rule) const {
  std::vector<CameraView> views;
  for (const Camera& camera : cameras) {
    views.push_back(BuildView(camera, grid, person, rule, 1).value());
  }
  return views;
}

std::vector<cv::Mat> Hall::Silhouettes(const std::vector<Eigen::Vector2d>& people_m) const {
  std::vector<cv::Mat> masks;
  for (const Camera& camera : cameras) {
    const auto [width, height] = camera.size();
    cv::Mat mask(height, width, CV_8UC1, cv::Scalar(0));
    for (const Eigen::Vector2d& foot_m : people_m) {
      const auto box = PersonBox(camera, foot_m, person);
      if (!box) continue;
      const auto corner = [](double x, double y) {
        return cv::Point(static_cast<int>(std::ceil(x)), static_cast<int>(std::ceil(y)));
      };
      const cv::Rect r(corner(box->min_x, box->min_y), corner(box->max_x, box->max_y));
      mask(r & cv::Rect(0, 0, width, height)) = 255;
    }
    masks.push_back(mask);
  }
  return masks;
}

std::vector<Eigen::Vector2d> Hall::People(RandomNumbers& random, int count, double apart_m) const {
  std::vector<Eigen::Vector2d> people_m;
  for (int tries = 0; tries < 100 && std::ssize(people_m) < count; ++tries) {
    const double x = random.Real(0.5, 7.5);
    const Eigen::Vector2d place_m(x, random.Real(0.5, 5.5));
    bool free = true;
    for (const Eigen::Vector2d& other_m : people_m) free &= (place_m - other_m).norm() >= apart_m;
    if (free) people_m.push_back(place_m);
  }
  return people_m;
}

void AddBlobs(RandomNumbers& random, double share, int side_px, cv::Mat& mask) {
  for (double left = share * static_cast<double>(mask.total()); left > 0;) {
    cv::Rect r(random.Int(0, mask.cols - 1), random.Int(0, mask.rows - 1), random.Int(1, side_px),
               random.Int(1, side_px));
    r &= cv::Rect(0, 0, mask.cols, mask.rows);
    cv::bitwise_not(mask(r), mask(r));
    left -= r.area();
  }
}

}  // namespace vantage::testing
