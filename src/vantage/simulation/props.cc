// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/props.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage::simulation {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

Limb Ball(const Vector3f& center_m, float radius_m, MaterialIndex material) {
  return {center_m, center_m, radius_m, radius_m, material};
}

}  // namespace

Shape Placed(const Shape& shape, const Vector3f& place_m, float yaw_rad) {
  const float c = std::cos(yaw_rad);
  const float s = std::sin(yaw_rad);
  const auto moved = [&](const Vector3f& p) -> Vector3f {
    return place_m + Vector3f(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z());
  };
  Shape placed = shape;
  for (Limb& limb : placed.limbs) {
    limb.a_m = moved(limb.a_m);
    limb.b_m = moved(limb.b_m);
  }
  for (Block& block : placed.blocks) {
    block.center_m = moved(block.center_m);
    block.yaw_rad += yaw_rad;
  }
  return placed;
}

void Build(Stage& stage, const Shape& shape) {
  stage.limbs.insert(stage.limbs.end(), shape.limbs.begin(), shape.limbs.end());
  stage.blocks.insert(stage.blocks.end(), shape.blocks.begin(), shape.blocks.end());
}

Block Patch(const Vector2f& center_m, const Vector2f& half_m, double yaw_rad, float height_mm,
            MaterialIndex material) {
  constexpr float kDepth = 0.2F;  // below the ground, where nobody looks
  const float top = 1e-3F * height_mm;
  return {{center_m.x(), center_m.y(), 0.5F * (top - kDepth)},
          {half_m.x(), half_m.y(), 0.5F * (top + kDepth)},
          static_cast<float>(yaw_rad),
          material};
}

Block GroundLine(const Vector2f& a_m, const Vector2f& b_m, float width_m, float height_mm,
                 MaterialIndex material) {
  const Vector2f way = b_m - a_m;
  return Patch(0.5F * (a_m + b_m), {0.5F * way.norm(), 0.5F * width_m},
               std::atan2(way.y(), way.x()), height_mm, material);
}

Shape Tripod(const Vector3f& camera_m, MaterialIndex material) {
  Shape tripod;
  const Vector3f head = camera_m - Vector3f(0, 0, 0.25F);
  const Vector3f hub = {head.x(), head.y(), 0.75F * head.z()};
  tripod.limbs.push_back({head, hub, 0.045F, 0.03F, material});
  for (int leg = 0; leg < 3; ++leg) {
    const float angle = 0.4F + static_cast<float>(leg) * 2 * std::numbers::pi_v<float> / 3;
    const Vector3f foot = {head.x() + 0.55F * std::cos(angle), head.y() + 0.55F * std::sin(angle),
                           0.02F};
    tripod.limbs.push_back({hub, foot, 0.03F, 0.02F, material});
  }
  return tripod;
}

Shape TrafficCone(MaterialIndex orange, MaterialIndex white) {
  Shape cone;
  cone.blocks.push_back({{0, 0, 0.02F}, {0.2F, 0.2F, 0.02F}, 0.3F, orange});
  cone.limbs.push_back({{0, 0, 0.14F}, {0, 0, 0.7F}, 0.14F, 0.035F, orange});
  cone.limbs.push_back({{0, 0, 0.36F}, {0, 0, 0.48F}, 0.105F, 0.085F, white});
  return cone;
}

Shape Bench(MaterialIndex wood, MaterialIndex metal) {
  Shape bench;
  for (const float y : {-0.14F, 0.03F, 0.2F}) {
    bench.blocks.push_back({{0, y, 0.43F}, {0.9F, 0.075F, 0.02F}, 0, wood});
  }
  for (const float z : {0.62F, 0.8F}) {
    bench.blocks.push_back({{0, -0.26F, z}, {0.9F, 0.02F, 0.07F}, 0, wood});
  }
  for (const float x : {-0.75F, 0.75F}) {
    bench.blocks.push_back({{x, 0.2F, 0.205F}, {0.03F, 0.03F, 0.205F}, 0, metal});
    bench.blocks.push_back({{x, -0.29F, 0.43F}, {0.03F, 0.03F, 0.43F}, 0, metal});
  }
  return bench;
}

Shape Car(const CarPaint& paint, bool van) {
  Shape car;
  const float top = van ? 1.05F : 0.72F;
  car.blocks.push_back({{0, 0, 0.62F}, {2.1F, 0.84F, 0.3F}, 0, paint.body});
  // The cabin: roof on pillars, glass a little inside.
  const float middle = van ? -0.4F : -0.15F;
  const float half = van ? 1.65F : 1.1F;
  car.blocks.push_back({{middle, 0, 0.92F + 0.5F * top},
                        {half - 0.1F, 0.74F, 0.5F * top},
                        0,
                        van ? paint.body : paint.glass});
  car.blocks.push_back({{middle, 0, 0.9F + top}, {half - 0.2F, 0.72F, 0.04F}, 0, paint.body});
  for (const float side : {-0.75F, 0.75F}) {
    for (const float x : {-half + 0.12F, 0.0F, half - 0.12F}) {
      car.blocks.push_back(
          {{middle + x, side, 0.92F + 0.5F * top}, {0.05F, 0.02F, 0.5F * top}, 0, paint.body});
    }
  }
  if (van) {
    car.blocks.push_back({{middle + half - 0.1F, 0, 1.55F}, {0.03F, 0.65F, 0.3F}, 0, paint.glass});
    for (const float side : {-0.76F, 0.76F}) {
      car.blocks.push_back(
          {{middle + half - 0.7F, side, 1.55F}, {0.4F, 0.02F, 0.28F}, 0, paint.glass});
    }
  }
  for (const float x : {-1.3F, 1.3F}) {
    for (const float side : {-0.72F, 0.72F}) {
      car.limbs.push_back(
          {{x, side - 0.02F, 0.33F}, {x, side + 0.02F, 0.33F}, 0.33F, 0.33F, paint.tyre});
    }
  }
  for (const float side : {-0.6F, 0.6F}) {
    car.blocks.push_back({{2.11F, side, 0.68F}, {0.02F, 0.14F, 0.08F}, 0, paint.light});
    car.blocks.push_back({{-2.11F, side, 0.72F}, {0.02F, 0.12F, 0.1F}, 0, paint.light});
  }
  return car;
}

Shape HouseShape(const House& house) {
  constexpr float kPitch = 2.4F;   // m from window to window
  constexpr float kStorey = 3.0F;  // m
  Shape shape;
  shape.blocks.push_back({{0, 0, 0.5F * house.height_m},
                          {house.half_m.x(), house.half_m.y(), 0.5F * house.height_m},
                          0,
                          house.wall});
  shape.blocks.push_back({{0, 0, house.height_m},
                          {house.half_m.x() + 0.15F, house.half_m.y() + 0.15F, 0.15F},
                          0,
                          house.frame});
  for (int wall = 0; wall < 4; ++wall) {
    const bool along_x = wall % 2 == 0;
    const float sign = wall < 2 ? 1.0F : -1.0F;
    const float length = along_x ? house.half_m.x() : house.half_m.y();
    const float depth = along_x ? house.half_m.y() : house.half_m.x();
    const int columns = static_cast<int>(2 * length / kPitch);
    const int storeys = static_cast<int>(house.height_m / kStorey);
    for (int storey = 0; storey < storeys; ++storey) {
      const float z = kStorey * static_cast<float>(storey) + 1.75F;
      for (int column = 0; column < columns; ++column) {
        const float at =
            kPitch * (static_cast<float>(column) - 0.5F * static_cast<float>(columns - 1));
        const auto sheet = [&](float half_width, float half_height, float out,
                               MaterialIndex material) {
          const float from_wall = sign * (depth + out);
          shape.blocks.push_back({along_x ? Vector3f(at, from_wall, z) : Vector3f(from_wall, at, z),
                                  along_x ? Vector3f(half_width, 0.01F, half_height)
                                          : Vector3f(0.01F, half_width, half_height),
                                  0, material});
        };
        sheet(0.85F, 0.75F, 0.01F, house.frame);
        sheet(0.78F, 0.68F, 0.02F, house.window);
      }
    }
  }
  return Placed(shape, {house.center_m.x(), house.center_m.y(), 0}, house.yaw_rad);
}

Tree Plant(const Vector2f& ground_m, double height_m, int clusters, MaterialIndex bark,
           const std::vector<MaterialIndex>& leaves, Dice& dice) {
  Tree tree;
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(dice.Uniform(low, high));
  };
  const auto height = static_cast<float>(height_m);
  const Vector3f foot = {ground_m.x(), ground_m.y(), 0};
  const Vector3f fork = foot + Vector3f{uniform(-0.1, 0.1), uniform(-0.1, 0.1), 0.4F * height};
  const Vector3f crown = foot + Vector3f(0, 0, 0.68F * height);
  tree.wood.limbs.push_back({foot, fork, 0.035F * height, 0.022F * height, bark});
  tree.wood.limbs.push_back({fork, crown, 0.022F * height, 0.01F * height, bark});
  tree.foliage.ground_m = ground_m;
  for (int i = 0; i < clusters; ++i) {
    // In a ball about the crown, wider than high, denser outside.
    const double angle = dice.Uniform(0, 2 * std::numbers::pi);
    const double up = dice.Uniform(-1, 1);
    const double out = std::cbrt(dice.Uniform(0.15, 1));
    const double ring = std::sqrt(1 - up * up);
    const Vector3f offset =
        height * static_cast<float>(out) *
        Vector3f(0.3F * static_cast<float>(ring * std::cos(angle)),
                 0.3F * static_cast<float>(ring * std::sin(angle)), 0.28F * static_cast<float>(up));
    Foliage::Cluster cluster;
    cluster.rest_m = crown + offset;
    cluster.radius_m = height * uniform(0.035, 0.075);
    const float sway = 0.012F * height * uniform(0.4, 1.2);
    cluster.sway_m = {sway, 0.7F * sway, 0.4F * sway};
    cluster.rate_rad_s = uniform(2.5, 6);
    cluster.phase_rad = uniform(0, 2 * std::numbers::pi);
    cluster.material =
        leaves[static_cast<std::size_t>(dice.Below(static_cast<int>(leaves.size())))];
    if (i % 6 == 0) {
      tree.wood.limbs.push_back({fork + 0.3F * (crown - fork), crown + 0.8F * offset,
                                 0.012F * height, 0.004F * height, bark});
    }
    tree.foliage.clusters.push_back(cluster);
  }
  return tree;
}

std::vector<Limb> LeavesAt(const Foliage& foliage, double seconds) {
  const auto t = static_cast<float>(seconds);
  const float wind = 0.55F + 0.45F * std::sin(0.23F * t + 0.11F * foliage.ground_m.x());
  std::vector<Limb> limbs;
  limbs.reserve(foliage.clusters.size());
  for (const Foliage::Cluster& cluster : foliage.clusters) {
    const float phase = cluster.rate_rad_s * t + cluster.phase_rad;
    const float swing = wind * (std::sin(phase) + 0.5F * std::sin(2.3F * phase + 1));
    limbs.push_back(
        Ball(cluster.rest_m + swing * cluster.sway_m, cluster.radius_m, cluster.material));
  }
  return limbs;
}

}  // namespace vantage::simulation
