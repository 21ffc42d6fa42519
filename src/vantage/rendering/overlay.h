// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/geometry/camera.h"
#include "vantage/geometry/person.h"
#include "vantage/geometry/polygon.h"
#include "vantage/rendering/people.h"

namespace vantage {

/// Draws a straight line of the ground into a camera's picture (CV_8UC3 of the camera's size), bent
/// as the lens bends it; what cannot be projected is left out.
void DrawGroundLine(cv::Mat& picture, const Camera& camera, const Eigen::Vector2d& from_m,
                    const Eigen::Vector2d& to_m, const cv::Scalar& color, int thickness_px,
                    double opacity);

/// Draws the outline of the area on a camera's picture (CV_8UC3 of the camera's size), and a grid
/// of metres when there is no picture to show the ground.
void DrawGround(cv::Mat& picture, const Camera& camera, const Polygon& area, bool with_grid);

/// Draws everybody whom the camera sees: a box around the person, the number, and the trail on the
/// ground. Lines and type scale with the picture. People whose box lies outside the picture or
/// behind the camera are left out.
void DrawPeople(cv::Mat& picture, const Camera& camera, const std::vector<Person>& people,
                const PersonOptions& figure);

}  // namespace vantage
