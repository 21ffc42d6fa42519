// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/geometry/polygon.h"
#include "vantage/scene/scene.h"
#include "vantage/tracks/track.h"

/// Simulated silhouettes of real people. For tests only; not installed.

namespace vantage::testing {

struct SimulatedPets {
  /// Of no sources: its masks are those below.
  Scene scene;
  /// The people of every `every`-th frame; those outside the area, too.
  Tracks truth;
  /// Frames with anybody in them.
  std::vector<FrameIndex> frames;
  /// The masks of a frame, one for each camera of the scene. Thread-safe.
  std::function<std::vector<cv::Mat>(FrameIndex)> masks;
};

/// The people of PETS 2009 S2.L1 where they really stood, drawn (simulated) into the pictures that
/// the real cameras would take. Each has a height of 1.6 to 1.9 m and a breadth of 0.45 to 0.6 m of
/// its own, a fixed function of the id, and is a flat figure that faces the camera: an ellipse from
/// the ground to the shoulders, another for the head. All people are drawn, inside the area and
/// outside of it, cut off at the edges of the pictures, in one silhouette with those they hide.
/// `folder` holds calibration/ and gt-mot15-3d.txt; `views` are numbers of 1 to 8. Throws where the
/// data are not what they should be.
SimulatedPets SimulatePets(const std::filesystem::path& folder, const Polygon& area,
                           const std::vector<int>& views, FrameIndex every);

}  // namespace vantage::testing
