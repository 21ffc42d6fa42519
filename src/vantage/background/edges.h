// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>

namespace vantage {

/// Derivatives of a picture's luma by the 3x3 Sobel filter, the picture continued beyond its edges
/// by its outermost pixels.
struct LumaGradient {
  cv::Mat x, y;     ///< CV_16SC1, levels
  cv::Mat squared;  ///< CV_32SC1, x^2 + y^2
};
/// `bgr` is CV_8UC3.
LumaGradient GradientOf(const cv::Mat& bgr);

/// Otsu's threshold of the lengths of both gradients (either may be null) inside `region` (CV_8UC1
/// of their size): one threshold for two pictures, so that an edge of one strength counts the same
/// in both. 0 where the region is empty.
double EdgeThreshold(const LumaGradient* a, const LumaGradient* b, const cv::Mat& region);

/// Canny's edges (1986) inside `region` only, 255 in a CV_8UC1 picture: maxima along the gradient
/// whose length exceeds `upper`, and those above upper / 2 that are linked to them inside the
/// region. Inside a region that is the whole picture the same as cv::Canny with L2 gradients.
cv::Mat CannyEdges(const LumaGradient& gradient, const cv::Mat& region, double upper);

}  // namespace vantage
