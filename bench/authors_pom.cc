// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "bench/authors_pom.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/core.hpp>

namespace vantage::bench {
namespace {

using Picture = cv::Mat_<double>;

/// M of algorithms.md, section 3: the probability that a pixel is not covered.
void FillUncovered(const CameraView& view, const std::vector<double>& absence, double ignored,
                   Picture& m) {
  m.create(view.size.height, view.size.width);
  m.setTo(1.0);
  for (std::size_t i = 0; i < absence.size(); ++i) {
    const cv::Rect& r = view.rectangles[i];
    if (absence[i] > ignored) continue;
    const double n = absence[i];
    for (int y = r.y; y < r.y + r.height; ++y) {
      double* const pixels = m[y] + r.x;
      for (int x = 0; x < r.width; ++x) pixels[x] *= n;
    }
  }
}

/// Sums of M and of M B over all pixels above and left of a corner.
void Integrate(const Picture& m, const Picture& b, Picture& sum_m, Picture& sum_mb) {
  for (Picture* sum : {&sum_m, &sum_mb}) {
    sum->create(m.rows + 1, m.cols + 1);
    sum->row(0).setTo(0.0);
  }
  for (int y = 0; y < m.rows; ++y) {
    const double *const m_row = m[y], *const b_row = b[y];
    const double *const above = sum_m[y], *const above_b = sum_mb[y];
    double *const below = sum_m[y + 1], *const below_b = sum_mb[y + 1];
    double along = 0, along_b = 0;
    below[0] = below_b[0] = 0;
    for (int x = 0; x < m.cols; ++x) {
      along += m_row[x];
      along_b += m_row[x] * b_row[x];
      below[x + 1] = above[x + 1] + along;
      below_b[x + 1] = above_b[x + 1] + along_b;
    }
  }
}

double BoxSum(const Picture& sum, const cv::Rect& r) {
  const int right = r.x + r.width, bottom = r.y + r.height;
  return sum(bottom, right) - sum(r.y, right) - sum(bottom, r.x) + sum(r.y, r.x);
}

}  // namespace

void AuthorsPom::Solve(std::span<const cv::Mat> masks, std::span<float> q) const {
  const OccupancyOptions& o = options_;
  const std::size_t cells = q.size();
  std::vector<Picture> b(views_.size());
  std::vector<double> sum_b(views_.size());
  for (std::size_t c = 0; c < views_.size(); ++c) {
    masks[c].convertTo(b[c], CV_64F, 1.0 / 255);
    sum_b[c] = cv::sum(b[c])[0];
  }
  const double logit_prior = std::log(o.prior / (1 - o.prior));
  std::vector<double> n(cells, 1 - o.prior), score(cells);
  Picture m, sum_m, sum_mb;
  int stable = 0;
  for (int i = 0; i < o.max_iterations && stable < o.stable_iterations; ++i) {
    std::fill(score.begin(), score.end(), 0.0);
    for (std::size_t c = 0; c < views_.size(); ++c) {
      FillUncovered(views_[c], n, o.ignored, m);
      Integrate(m, b[c], sum_m, sum_mb);
      const cv::Rect picture(0, 0, m.cols, m.rows);
      const double s = picture.area() * (1 + o.noise) - BoxSum(sum_m, picture);
      const double d = s + 2 * BoxSum(sum_mb, picture) - sum_b[c];
      for (std::size_t cell = 0; cell < cells; ++cell) {
        const cv::Rect& r = views_[c].rectangles[cell];
        if (r.empty()) continue;
        const double l = 1 - 1 / n[cell];
        const double a = BoxSum(sum_m, r), v = a - 2 * BoxSum(sum_mb, r);
        const double present = (d + v) / (s + a), absent = (d + l * v) / (s + l * a);
        score[cell] += (absent * absent - present * present) / (2 * o.variance);
      }
    }
    double largest = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
      const double next =
          o.smoothing * n[cell] + (1 - o.smoothing) / (1 + std::exp(logit_prior + score[cell]));
      largest = std::max(largest, std::abs(next - n[cell]));
      n[cell] = next;
    }
    stable = largest < o.tolerance ? stable + 1 : 0;
  }
  for (std::size_t cell = 0; cell < cells; ++cell) q[cell] = static_cast<float>(1 - n[cell]);
}

}  // namespace vantage::bench
