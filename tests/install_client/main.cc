// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <cstdio>

#include "vantage/base/version.h"
#include "vantage/geometry/camera.h"
#include "vantage/occupancy/map_file.h"

int main() {
  const vantage::PinholeModel lens{.fx_px = 600, .fy_px = 600, .cx_px = 320, .cy_px = 240};
  const auto camera = vantage::Camera::Create({640, 480}, lens, {});
  if (!camera || camera->ImageFromWorld({0, 0, 5}) != Eigen::Vector2d(320, 240)) return 1;
  const auto maps = vantage::ReadMaps("no-such-file.h5");
  std::printf("vantage %s: %s\n", vantage::kVersion, maps ? "?" : maps.error().message.c_str());
  return maps ? 1 : 0;
}
