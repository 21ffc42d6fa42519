// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "vantage/base/result.h"
#include "vantage/geometry/camera.h"

/// Calibration files of others as Cameras (world in metres, z up). Each function fails with one
/// line that names the file and the field: missing, of wrong size, not finite, not a rotation.

namespace vantage {

/// The XML of PETS 2009 (Tsai's model, millimetres): <Camera> with <Geometry width height dpx dpy>,
/// <Intrinsic focal kappa1 cx cy sx>, <Extrinsic tx ty tz rx ry rz>, R = Rz Ry Rx.
Result<Camera> ReadTsaiXml(const std::filesystem::path& path);

/// What an OpenCV file leaves open.
struct OpenCvConventions {
  /// Metres per unit of the translation, > 0 (0.01 for centimetres).
  double unit_m = 1;
  /// True when the file's world is left-handed (z up, as seen from above x turns clockwise into y):
  /// no rotation leads from there into a camera, and the file's own turns all depths negative. The
  /// Camera then lives in the mirrored world (x, -y, z).
  bool left_handed = false;
  /// Size of the pictures, where the files do not say it; must agree where they do.
  std::optional<ImageSize> size = std::nullopt;
};

/// One file of OpenCV's FileStorage (YAML, XML or JSON) with camera matrix, distortion (may be left
/// out), rotation (3x3 or rotation vector), translation and size. Common names are understood:
///   camera_matrix K cameraMatrix Camera_Matrix intrinsic_matrix
///   distortion_coefficients distCoeffs dist_coeffs Distortion_Coefficients dist D
///   R rotation_matrix rotation rvec rotation_vector;  T t tvec translation translation_vector
///   image_width and image_height, image_Width and image_Height, width and height, image_size
Result<Camera> ReadOpenCv(const std::filesystem::path& path,
                          const OpenCvConventions& conventions = {});

/// A pair of such files, as WILDTRACK (unit_m = 0.01) and MultiviewX (unit_m = 1,
/// left_handed) have them: camera
/// matrix and distortion in one, rotation and translation in the other.
Result<Camera> ReadIntrinsicExtrinsic(const std::filesystem::path& intrinsic,
                                      const std::filesystem::path& extrinsic,
                                      const OpenCvConventions& conventions);

/// Rotations as the calibrations give them: Rz Ry Rx from three angles, and a rotation vector
/// (axis times angle, OpenCV's rvec); radians.
Eigen::Matrix3d RotationFromAngles(const Eigen::Vector3d& angles_rad);
Eigen::Matrix3d RotationFromVector(const Eigen::Vector3d& vector_rad);

}  // namespace vantage
