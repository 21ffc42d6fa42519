// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "vantage/simulation/dice.h"
#include "vantage/simulation/stage.h"

/// Things that several presets have, made of round cones and blocks.

namespace vantage::simulation {

struct Shape {
  std::vector<Limb> limbs;
  std::vector<Block> blocks;
};

/// The shape turned about its origin and moved there.
Shape Placed(const Shape& shape, const Eigen::Vector3f& place_m, float yaw_rad);

/// Puts a shape into the world for good.
void Build(Stage& stage, const Shape& shape);

/// A flat piece of ground, its upper face `height_mm` above z = 0 (at most 5).
Block Patch(const Eigen::Vector2f& center_m, const Eigen::Vector2f& half_m, double yaw_rad,
            float height_mm, MaterialIndex material);

/// A line on the ground from a to b.
Block GroundLine(const Eigen::Vector2f& a_m, const Eigen::Vector2f& b_m, float width_m,
                 float height_mm, MaterialIndex material);

/// A camera's tripod with its head just under and behind this place, legs spread on the ground.
Shape Tripod(const Eigen::Vector3f& camera_m, MaterialIndex material);

/// A traffic cone at the origin.
Shape TrafficCone(MaterialIndex orange, MaterialIndex white);

/// A bench along its own x axis, its seat 0.45 m high at the origin, backrest towards -y.
Shape Bench(MaterialIndex wood, MaterialIndex metal);

struct CarPaint {
  MaterialIndex body = 0;
  MaterialIndex glass = 0;
  MaterialIndex tyre = 0;
  MaterialIndex light = 0;
};
/// A car that looks along its own x axis, 4.2 m long; a van is higher.
Shape Car(const CarPaint& paint, bool van);

/// A box of a house with rows of windows on its four walls, and doors where people vanish.
struct House {
  Eigen::Vector2f center_m = {0, 0};
  Eigen::Vector2f half_m = {5, 5};
  float height_m = 7;
  float yaw_rad = 0;
  MaterialIndex wall = 0;
  MaterialIndex window = 0;
  MaterialIndex frame = 0;
};
Shape HouseShape(const House& house);

/// Leaves of a tree, clusters that move in the wind by sums of sines.
struct Foliage {
  struct Cluster {
    Eigen::Vector3f rest_m;
    float radius_m = 0.2F;
    Eigen::Vector3f sway_m;  ///< how far it goes
    float rate_rad_s = 4;
    float phase_rad = 0;
    MaterialIndex material = 0;
  };
  Eigen::Vector2f ground_m = {0, 0};
  std::vector<Cluster> clusters;
};

struct Tree {
  Shape wood;  ///< trunk and limbs: fixed
  Foliage foliage;
};
/// A tree of this height at this place, with so many clusters of leaves.
Tree Plant(const Eigen::Vector2f& ground_m, double height_m, int clusters, MaterialIndex bark,
           const std::vector<MaterialIndex>& leaves, Dice& dice);

/// The clusters as spheres. Wind rises and falls slowly.
std::vector<Limb> LeavesAt(const Foliage& foliage, double seconds);

}  // namespace vantage::simulation
