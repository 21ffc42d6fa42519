// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/base/ids.h"
#include "vantage/geometry/camera.h"
#include "vantage/geometry/polygon.h"

/// What the simulator films: a fixed world, its lights and cameras, and a script that says where
/// everything that moves is in each frame. Metres, world frame of geometry/camera.h; colours are
/// linear reflectances or radiances, red green blue.

namespace vantage::simulation {

/// How a surface looks. Patterns are functions of the place on the surface (of the world for what
/// is fixed, of the limb or block itself for what moves), so they need no files.
struct Material {
  enum class Pattern {
    kPlain,
    kSpeckle,  ///< smooth noise between the colours
    kStripes,  ///< bands of width scale_m, along the first axis of the surface
    kChecks,   ///< squares of side scale_m
    kPlaid,    ///< crossing bands, as on shirts
    kBricks,   ///< bricks of color in mortar of second, scale_m long
    kPlanks,   ///< boards of width scale_m, each of its own shade, with dark joints of second
    kLetters,  ///< blocks of second on color like large print: strong edges
    kGrass,    ///< fine strong noise between the colours
  };
  Pattern pattern = Pattern::kPlain;
  Eigen::Vector3f color = {0.5F, 0.5F, 0.5F};
  Eigen::Vector3f second = {0.5F, 0.5F, 0.5F};
  float scale_m = 1;  ///< > 0
  float gloss = 0;  ///< share of light mirrored at normal incidence, 0 to 1; more at grazing angles
  /// Spread of the mirrored direction, radians; 0 is a mirror.
  float roughness_rad = 0;
  std::uint32_t seed = 0;  ///< makes two surfaces of one pattern differ
};

/// Index into Stage::materials.
using MaterialIndex = int;

/// A round cone: the hull of two spheres. One sphere where the ends are equal.
struct Limb {
  Eigen::Vector3f a_m;
  Eigen::Vector3f b_m;
  float a_radius_m = 0.1F;
  float b_radius_m = 0.1F;
  MaterialIndex material = 0;
};

/// A box with a base parallel to the ground, turned by yaw about the vertical.
struct Block {
  Eigen::Vector3f center_m;
  Eigen::Vector3f
      half_m;  ///< half of its sides along its own axes, each >= 0; one may be 0 (a sheet)
  float yaw_rad = 0;
  MaterialIndex material = 0;
};

/// Something that moves or may move, at one instant.
struct Thing {
  enum class Kind {
    kPerson,   ///< to be tracked; foreground in every frame
    kObject,   ///< a bag, a car, a ball
    kScenery,  ///< leaves, a board with changing pictures: never foreground
  };
  int id = 0;  ///< above 0; the same in all frames
  Kind kind = Kind::kPerson;
  /// Whether its pixels are foreground in the true masks (objects only: true from their first move
  /// on).
  bool foreground = true;
  Eigen::Vector2d ground_m = {0, 0};  ///< where it stands
  std::vector<Limb> limbs;
  std::vector<Block> blocks;
};

/// A rectangular lamp, or the sun: a small distant one. Its light falls off with neither distance
/// nor angle (halls are lit evenly): irradiance is `color` times the cosine at the receiver times
/// the share of the lamp that is seen from there.
struct Lamp {
  Eigen::Vector3f center_m;
  Eigen::Vector3f half_u_m;  ///< half of its first side, as a vector
  Eigen::Vector3f half_v_m;
  Eigen::Vector3f color;
};

/// Light groups: 0 is the ambient light, 1 + i is lamp i.
struct Lighting {
  Eigen::Vector3f ambient = {0.3F, 0.3F, 0.3F};  ///< from above on an upward surface, unoccluded
  std::vector<Lamp> lamps;                       ///< at most 4
  Eigen::Vector3f sky = {0.5F, 0.6F, 0.8F};      ///< radiance of rays that meet nothing
};

/// One camera and its sensor.
struct StageCamera {
  std::string name;
  Camera camera;
  double exposure = 1;                  ///< radiance 1 / exposure is white
  Eigen::Vector3f balance = {1, 1, 1};  ///< gain of each channel
  double noise = 0.008;                 ///< standard deviation at white, of 1
  double vignetting = 0.15;             ///< light lost in the corners, share
};

/// What happens. Functions of the frame alone, safe to call from several threads.
class Script {
 public:
  virtual ~Script() = default;
  /// Everything that moves or may move, in ascending order of id. What is far outside every
  /// picture may be left out.
  virtual std::vector<Thing> At(FrameIndex frame) const = 0;
  /// Gain of each light group (1 + lamps of them), each >= 0.
  virtual std::vector<float> Gains(FrameIndex frame) const = 0;
};

struct Stage {
  std::string name;
  double frames_per_second = 20;
  FrameIndex frames = 0;
  Polygon area;
  std::vector<Polygon> doors;
  std::vector<Polygon> obstacles;
  std::optional<double> cell_m;  ///< for the scene file; none: the default of scenes
  std::vector<StageCamera> cameras;
  std::vector<Material> materials;
  /// What never moves. Ground, walls and markings are blocks, too; the ground's upper face is z = 0
  /// and markings lie up to 5 mm above it.
  std::vector<Block> blocks;
  std::vector<Limb> limbs;
  Lighting lighting;
  std::unique_ptr<Script> script;
};

}  // namespace vantage::simulation
