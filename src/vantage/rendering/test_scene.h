// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vantage/geometry/test_cameras.h"
#include "vantage/scene/scene.h"

/// A scene for tests only; not installed.

namespace vantage::testing {

/// An area of 8 x 6 m watched by cameras of these sizes from its corners, 10 frames per second.
inline Scene CornerScene(const std::vector<ImageSize>& sizes) {
  Scene scene;
  scene.name = "corners";
  scene.frames_per_second = 10;
  scene.area = Polygon::Rectangle({-4, -3}, {4, 3}).value();
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double x = i % 2 == 0 ? -7 : 7;
    const double y = i % 4 < 2 ? -6 : 6;
    const PinholeModel lens{.fx_px = 0.9 * sizes[i].width,
                            .fy_px = 0.9 * sizes[i].width,
                            .cx_px = (sizes[i].width - 1) / 2.0,
                            .cy_px = (sizes[i].height - 1) / 2.0};
    scene.cameras.push_back(
        {"cam" + std::to_string(i + 1),
         {},
         Camera::Create(sizes[i], lens, LookAt({x, y, 5}, {0, 0, 0.5})).value()});
  }
  return scene;
}

}  // namespace vantage::testing
