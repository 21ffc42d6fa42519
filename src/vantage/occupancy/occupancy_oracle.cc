// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/occupancy/occupancy_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

namespace vantage::testing {
namespace {

/// Length of what [a, a + 1) and [low, high) share.
double Overlap(int a, double low, double high) {
  return std::max(0.0, std::min(a + 1.0, high) - std::max(static_cast<double>(a), low));
}

/// w and B of one camera.
struct Picture {
  cv::Mat_<double> share, foreground;
};

Picture PictureOf(const CameraView& view, const cv::Mat& mask) {
  cv::Mat_<double> share(mask.rows, mask.cols, 1.0), foreground(mask.rows, mask.cols, 0.0);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (!view.informative.empty() && view.informative.at<std::uint8_t>(y, x) == 0) {
        share(y, x) = 0;
      } else {
        foreground(y, x) = mask.at<std::uint8_t>(y, x) / 255.0;
      }
    }
  }
  return {PlainAreaAverage(share, view.size), PlainAreaAverage(foreground, view.size)};
}

double Sum(const cv::Mat_<double>& image) { return cv::sum(image)[0]; }

/// r of every cell that the camera speaks for.
void AddScores(const OccupancyProblem& problem, std::size_t camera, const std::vector<double>& n,
               std::vector<double>& scores) {
  const OccupancyOptions& o = problem.options;
  const CameraView& view = problem.views[camera];
  const Picture picture = PictureOf(view, problem.masks[camera]);
  const auto weight = [&](std::size_t i) {
    return view.weights.empty() ? 1.0 : static_cast<double>(view.weights[i]);
  };
  const auto speaks_for = [&](std::size_t i) {
    return !view.rectangles[i].empty() && weight(i) > 0;
  };
  cv::Mat_<double> m(view.size.height, view.size.width, 1.0);
  for (std::size_t i = 0; i < n.size(); ++i) {
    if (speaks_for(i) && n[i] <= o.ignored) m(view.rectangles[i]) *= n[i];
  }
  const cv::Mat_<double> mw = m.mul(picture.share);
  const cv::Mat_<double> mb = m.mul(picture.foreground);
  const double pixels = Sum(picture.share);
  const double s = pixels * (1 + o.noise) - Sum(mw);
  const double d = s + 2 * Sum(mb) - Sum(picture.foreground);
  const auto log_likelihood = [&](double x) { return -x * x / (2 * o.variance); };
  for (std::size_t i = 0; i < n.size(); ++i) {
    if (!speaks_for(i)) continue;
    const cv::Rect& a = view.rectangles[i];
    const double area = Sum(picture.share(a));
    if (area == 0) continue;
    const double box_m = Sum(mw(a)), box_mb = Sum(mb(a));
    double r = 0;
    if (o.evidence == Evidence::kPerson) {
      r = o.worth / area * (box_mb - o.background_cost * (box_m - box_mb)) / n[i];
    } else {
      const double l = 1 - 1 / n[i];
      const double absent_surface = std::max(s + l * box_m, 1e-6 * pixels);
      r = log_likelihood((d + box_m - 2 * box_mb) / (s + box_m)) -
          log_likelihood((d + l * (box_m - 2 * box_mb)) / absent_surface);
    }
    scores[i] += weight(i) * r;
  }
}

double Prior(const OccupancyProblem& problem, std::size_t cell) {
  return problem.priors.empty() ? problem.options.prior : problem.priors[cell];
}

}  // namespace

cv::Mat_<double> PlainAreaAverage(const cv::Mat_<double>& image, ImageSize size) {
  if (image.cols == size.width && image.rows == size.height) return image;
  cv::Mat_<double> average(size.height, size.width, 0.0);
  const double scale_x = static_cast<double>(image.cols) / size.width;
  const double scale_y = static_cast<double>(image.rows) / size.height;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      for (int v = 0; v < image.rows; ++v) {
        const double rows = Overlap(v, y * scale_y, (y + 1) * scale_y);
        for (int u = 0; u < image.cols && rows > 0; ++u) {
          const double columns = Overlap(u, x * scale_x, (x + 1) * scale_x);
          average(y, x) += image(v, u) * rows * columns / (scale_x * scale_y);
        }
      }
    }
  }
  return average;
}

std::vector<double> PlainEvaluation(const OccupancyProblem& problem, const std::vector<double>& n) {
  std::vector<double> scores(n.size(), 0.0);
  for (std::size_t c = 0; c < problem.views.size(); ++c) {
    if (!problem.masks[c].empty()) AddScores(problem, c, n, scores);
  }
  std::vector<double> asked(n.size());
  for (std::size_t i = 0; i < n.size(); ++i) {
    const double prior = Prior(problem, i);
    asked[i] = 1 / (1 + std::exp(std::log(prior / (1 - prior)) + scores[i]));
  }
  return asked;
}

std::vector<double> PlainSolve(const OccupancyProblem& problem) {
  const OccupancyOptions& o = problem.options;
  const std::size_t cells = problem.views.front().rectangles.size();
  constexpr double kMinAbsence = 1e-10;
  std::vector<double> n(cells), step(cells, 1 - o.smoothing);
  std::vector<int> direction(cells, 0);
  for (std::size_t i = 0; i < cells; ++i) {
    n[i] = 1 - Prior(problem, i);
    if (problem.previous.empty()) continue;
    n[i] = std::clamp(1 - static_cast<double>(problem.previous[i]), kMinAbsence, n[i]);
  }
  int stable = 0;
  for (int iteration = 0; iteration < o.max_iterations && stable < o.stable_iterations;
       ++iteration) {
    const std::vector<double> asked = PlainEvaluation(problem, n);
    double change = 0;
    for (std::size_t i = 0; i < cells; ++i) {
      const double way = asked[i] - n[i];
      if (o.damping == Damping::kAdaptive) {
        const int now = std::abs(way) < 1e-4 ? 0 : way > 0 ? 1 : -1;
        if (now * direction[i] < 0) step[i] = std::max(step[i] / 2, 0.02);
        if (now * direction[i] > 0) step[i] = std::min(step[i] * 1.1, 0.6);
        direction[i] = now;
      }
      const double old = n[i];
      n[i] = std::max(old + step[i] * way, kMinAbsence);
      change = std::max(change, std::abs(n[i] - old));
    }
    stable = change < o.tolerance ? stable + 1 : 0;
  }
  std::vector<double> q(cells);
  for (std::size_t i = 0; i < cells; ++i) q[i] = 1 - n[i];
  return q;
}

}  // namespace vantage::testing
