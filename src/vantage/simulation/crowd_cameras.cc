// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <array>

#include "vantage/scene/calibration.h"
#include "vantage/simulation/preset_cameras.h"

namespace vantage::simulation {
namespace {

/// One camera of WILDTRACK (T. Chavdarova et al., "WILDTRACK: A Multi-Camera HD Dataset for Dense
/// Unscripted Pedestrian Detection", CVPR 2018), pixels and centimetres.
struct Calibration {
  std::string_view name;
  std::array<double, 4> lens_px;  // fx, fy, cx, cy
  std::array<double, 3> rotation_vector_rad;
  std::array<double, 3> translation_cm;
};

constexpr ImageSize kSize = {1920, 1080};

constexpr std::array<Calibration, 7> kCalibrations = {{
    {"camera1",
     {1743.4478759765625, 1735.1566162109375, 934.5202026367188, 444.3987731933594},
     {1.759099006652832, 0.46710100769996643, -0.331699013710022},
     {-525.8941650390625, 45.40763473510742, 986.7235107421875}},
    {"camera2",
     {1707.266845703125, 1719.0408935546875, 978.1306762695312, 417.01922607421875},
     {0.6167870163917542, -2.14595890045166, 1.6577140092849731},
     {1195.231201171875, -336.5144958496094, 2040.53955078125}},
    {"camera3",
     {1738.7144775390625, 1752.8876953125, 906.56689453125, 462.0346374511719},
     {0.5511789917945862, 2.229501962661743, -1.7721869945526123},
     {55.07157897949219, -213.2444610595703, 1992.845703125}},
    {"camera4",
     {1725.2772216796875, 1720.581787109375, 995.0142211914062, 520.4190063476562},
     {1.6647210121154785, 0.9668620228767395, -0.6937940120697021},
     {42.36193084716797, -45.360652923583984, 1106.8572998046875}},
    {"camera5",
     {1708.6573486328125, 1737.1904296875, 936.0921630859375, 465.18243408203125},
     {1.2132920026779175, -1.4771349430084229, 1.2775369882583618},
     {836.6625366210938, 85.86837005615234, 600.2880859375}},
    {"camera6",
     {1742.977783203125, 1746.0140380859375, 1001.0738525390625, 362.4325866699219},
     {1.6907379627227783, -0.3968360126018524, 0.355197012424469},
     {-338.5532531738281, 62.87659454345703, 1044.094482421875}},
    {"camera7",
     {1732.4674072265625, 1757.58203125, 931.2559204101562, 459.43389892578125},
     {1.6439390182495117, 1.126188039779663, -0.7273139953613281},
     {-648.9456787109375, -57.225215911865234, 1052.767578125}},
}};

}  // namespace

std::vector<NamedCamera> CrowdCameras() {
  std::vector<NamedCamera> cameras;
  for (const Calibration& calibration : kCalibrations) {
    const auto& [fx, fy, cx, cy] = calibration.lens_px;
    const PinholeModel lens{.fx_px = fx, .fy_px = fy, .cx_px = cx, .cy_px = cy};
    const CameraPose pose{
        .rotation = RotationFromVector(Eigen::Vector3d(calibration.rotation_vector_rad.data())),
        .translation_m = 0.01 * Eigen::Vector3d(calibration.translation_cm.data())};
    cameras.push_back({calibration.name, Camera::Create(kSize, lens, pose).value()});
  }
  return cameras;
}

}  // namespace vantage::simulation
