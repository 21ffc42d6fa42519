// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "vantage/geometry/camera.h"
#include "vantage/geometry/grid.h"
#include "vantage/occupancy/solver.h"
#include "vantage/occupancy/views.h"

namespace vantage::bench {

struct OccupancyFrame {
  std::vector<cv::Mat> masks;
  std::vector<Eigen::Vector2d> people_m;
};

/// A problem that every solver is given. Frames of a case are seconds apart.
struct OccupancyCase {
  /// Why the case cannot run; empty: it can.
  std::string missing;
  GroundGrid grid;
  /// The authors' defaults, with the `ignored` that they advise for speed.
  OccupancyOptions options = OriginalPomOptions();
  /// At the masks' resolution, and as the fast mode takes them.
  std::vector<CameraView> views;
  std::vector<CameraView> fast_views;
  std::vector<OccupancyFrame> frames;
  /// False where nobody says where people were.
  bool has_truth = true;
};

/// The authors' own example: 2 cameras of 160 x 120 px, 1332 cells, 30 frames, nearly empty.
const OccupancyCase& PomCase();
/// WILDTRACK: 7 cameras of 960 x 540 px, 12 x 36 m in cells of 0.2 m, perfect silhouettes of 20 to
/// 40 people, 6 frames.
const OccupancyCase& WildtrackCase();

/// A hall of 40 x 20 m with cameras high up all around and 12 people with round silhouettes
/// (simulated).
struct ArenaOptions {
  int cameras = 8;
  ImageSize size{960, 768};
  double cell_m = 0.5;
};
OccupancyCase MakeArena(const ArenaOptions& options);
/// 8 cameras of 960 x 768 px, cells of 0.5 m, 6 frames.
const OccupancyCase& ArenaCase();

/// Share of people found less false alarms, all frames together, at 0.5 m.
/// Peaks are kept 0.5 m apart, as in the published figures of the authors' program.
double Moda(const OccupancyCase& problem, const std::vector<std::vector<float>>& maps);

}  // namespace vantage::bench
