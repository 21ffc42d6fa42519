// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/occupancy/occupancy_options.h"
#include "vantage/occupancy/views.h"

/// For tests only: the formulas of solver.h and algorithms.md section 3 as printed, one loop each.

namespace vantage::testing {

/// All that one frame's map depends on.
struct OccupancyProblem {
  std::vector<CameraView> views;
  std::vector<cv::Mat> masks;
  OccupancyOptions options;
  std::vector<double> priors = {};
  std::vector<float> previous = {};
};

/// The absences that the evidence asks for where these are the absences of the cells: 1 / (1 +
/// exp(logit(prior) + sum of w r)). A fixed point is where it asks for what there is.
std::vector<double> PlainEvaluation(const OccupancyProblem& problem, const std::vector<double>& n);

/// Probabilities of presence after the iteration, every cell and every pixel (whatever the mode).
std::vector<double> PlainSolve(const OccupancyProblem& problem);

/// Average over the part of `image` that each pixel of a picture of `size` covers.
cv::Mat_<double> PlainAreaAverage(const cv::Mat_<double>& image, ImageSize size);

}  // namespace vantage::testing
