// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

namespace vantage {

/// How far the picture of a camera that was moved lies from its background picture.
struct CameraShift {
  cv::Point2d shift_px;  ///< median over the parts of the picture that moved
  double length_px = 0;  ///< median of the parts' lengths; more than |shift_px| in a rotation
};

/// The shift of the edges of `frame` against those of `background`, both CV_8UC3 of one size: by
/// phase correlation of the whole picture, or, for rotations, of nine parts, most of which must
/// have moved. Nothing where edges lie where they were, or fit nowhere (another light, something
/// large in front of the camera), or where the shift is shorter than `least_px`.
std::optional<CameraShift> EstimateCameraShift(const cv::Mat& frame, const cv::Mat& background,
                                               double least_px);

}  // namespace vantage
