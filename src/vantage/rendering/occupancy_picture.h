// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <vector>

#include "vantage/geometry/grid.h"
#include "vantage/occupancy/extension.h"
#include "vantage/occupancy/peaks.h"
#include "vantage/occupancy/views.h"
#include "vantage/rendering/people.h"
#include "vantage/rendering/plan.h"
#include "vantage/scene/scene.h"

namespace vantage {

/// Explains a scene's ground (thesis figure 13): the area, its extension, the cells, and what each
/// camera sees of them; and what the map of one frame says (its figure 14). Pictures are CV_8UC3.
class OccupancyPicture {
 public:
  /// `views`: of the scene's cameras over `grid`, for people like `person`. `extension`: what the
  /// plan says of each side.
  OccupancyPicture(const Scene& scene, const PersonOptions& person, const GroundGrid& grid,
                   std::vector<CameraView> views, const ExtensionReport& extension);

  /// From above: the area white, its extension amber with its metres, cells that nobody sees dark
  /// red, and around the ground that each camera sees a line in its colour.
  cv::Mat DrawPlan() const;

  /// What a camera sees: outlines of area and extension, the cells that it speaks for tinted, and
  /// how large people are in it. `picture`: CV_8UC3 or a mask, of the camera's size; an empty one:
  /// dark ground.
  cv::Mat DrawView(std::size_t camera, const cv::Mat& picture) const;

  /// The map q[cell] from above, with its peaks as rings, thin ones in the extension.
  cv::Mat DrawMap(std::span<const float> q, const std::vector<Peak>& peaks) const;

  /// The peaks as rectangles in a camera's picture, its foreground tinted. Either may be empty.
  cv::Mat DrawPeaks(std::size_t camera, const cv::Mat& picture, const cv::Mat& mask,
                    const std::vector<Peak>& peaks) const;

 private:
  struct Border {
    std::vector<Eigen::Vector2d> corners_m;
    cv::Scalar color;
  };
  /// Of the extension and of the area.
  std::array<Border, 2> Borders() const;
  cv::Rect2d BoxOf(CellIndex cell, const Plan& plan) const;
  void DrawBorders(cv::Mat& picture, const Plan& plan) const;
  void DrawCameras(cv::Mat& picture, const Plan& plan) const;
  void DrawFieldOfView(cv::Mat& plan, std::size_t camera) const;
  void DrawSideLabels(cv::Mat& plan) const;
  void DrawBordersInView(cv::Mat& view, std::size_t camera) const;
  void DrawCellsInView(cv::Mat& view, std::size_t camera) const;
  void DrawFiguresInView(cv::Mat& view, std::size_t camera) const;
  cv::Mat Canvas(std::size_t camera, const cv::Mat& picture, double brightness) const;
  std::vector<Person> PeopleOf(const std::vector<Peak>& peaks) const;

  Polygon area_;
  PersonOptions figure_;
  std::vector<Camera> cameras_;
  std::vector<std::string> names_;
  std::string scene_name_;
  GroundGrid grid_;
  std::vector<CameraView> views_;
  std::vector<std::uint8_t> in_area_, visible_;
  ExtensionReport extension_;
  Plan plan_;      // of the cameras' fields of view
  Plan map_plan_;  // of the grid alone
};

}  // namespace vantage
