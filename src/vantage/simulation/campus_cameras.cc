// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include <array>

#include "vantage/scene/calibration.h"
#include "vantage/simulation/preset_cameras.h"

namespace vantage::simulation {
namespace {

/// One calibration file of PETS 2009 (J. Ferryman and A. Shahrokni, "PETS2009: Dataset and
/// challenge", 2009): Tsai's model, millimetres, R = Rz Ry Rx.
struct Calibration {
  std::string_view name;
  ImageSize size;
  TsaiModel lens;
  std::array<double, 3> rotation_rad;
  std::array<double, 3> translation_mm;
};

constexpr std::array<Calibration, 8> kCalibrations = {{
    {"view1",
     {768, 576},
     {5.5549183034, 0.0051113043639, 0.0051273271277, 0.00465, 1.0937855397, 324.22149053,
      282.56650051},
     {2.0405458695, -0.89337703748, -0.43056124791},
     {828.73214225, -3175.4796051, 35469.298547}},
    {"view3",
     {768, 576},
     {6.8289664701, -0.012058925618, 0.0051273271277, 0.00465, 1.0749039449, 372.84162282,
      316.59953686},
     {1.763755445, -0.68268312644, -0.063321351894},
     {2560.215008, -1483.663337, 51063.732312}},
    {"view4",
     {768, 576},
     {18.579748488, -0.00010419523154, 0.0051273271277, 0.00465, 1.0804745826, 351.92780774,
      287.96348569},
     {-1.629646153, 0.36853070326, 3.1252104484},
     {-2952.4368798, 1410.285426, 80157.550249}},
    {"view5",
     {720, 576},
     {3.859393484, 0.022757857614, 0.00465, 0.00465, 1.0, 248.53856155, 337.9101175},
     {-2.1094320856, -1.0807782908, -2.6584356063},
     {-7610.1258932, -986.39923333, 12748.53099}},
    {"view6",
     {720, 576},
     {4.0766744114, 0.018390355585, 0.00465, 0.00465, 1.0, 547.78587794, 200.25964732},
     {2.218126306, -1.3115850224, -0.62222518243},
     {-9418.5059582, -683.42071459, 18334.013493}},
    {"view7",
     {720, 576},
     {3.6936729025, -0.061986350417, 0.00465, 0.00465, 1.0, 436.10005997, 257.92023557},
     {1.7745394894, 0.36370404431, 0.092805843657},
     {8604.1235949, -447.15843627, 14593.893245}},
    {"view8",
     {720, 576},
     {3.4345527587, 0.032678605363, 0.00465, 0.00465, 1.0, 592.20854519, 397.28183795},
     {-2.5947507242, 1.1385785426, 2.2484536187},
     {3206.9863258, 2311.9343215, -287.40583612}},
    {"view2",
     {768, 576},
     {3.1316979686, 0.037880262468, 0.0051273271277, 0.00465, 1.0894268482, 361.05480377,
      307.32879992},
     {1.8665618542, 0.15219705811, 0.045968889283},
     {7496.9800372, -1940.2122072, 23838.02768}},
}};

}  // namespace

std::vector<NamedCamera> CampusCameras() {
  std::vector<NamedCamera> cameras;
  for (const Calibration& calibration : kCalibrations) {
    const CameraPose pose{
        .rotation = RotationFromAngles(Eigen::Vector3d(calibration.rotation_rad.data())),
        .translation_m = 1e-3 * Eigen::Vector3d(calibration.translation_mm.data())};
    cameras.push_back(
        {calibration.name, Camera::Create(calibration.size, calibration.lens, pose).value()});
  }
  return cameras;
}

}  // namespace vantage::simulation
