// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/floorball_hall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "vantage/simulation/floorball_play.h"
#include "vantage/simulation/floorball_sideline.h"
#include "vantage/simulation/floorball_walkers.h"

namespace vantage::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3f;
using std::numbers::pi;
using Pattern = Material::Pattern;

class Builder {
 public:
  explicit Builder(Stage& stage) : stage_(stage) {}

  void Build() {
    Floor();
    FloorballLines();
    OtherLines();
    Boards();
    for (const double side : {-1.0, 1.0}) {
      Goal(side);
      SideBench(side);
    }
    Walls();
    Lamps();
  }

 private:
  MaterialIndex Make(const Material& material) { return AddMaterial(stage_, material); }
  MaterialIndex Paint(const Vector3f& color) { return Make({.color = color}); }

  void Box(double x, double y, double z, double half_x, double half_y, double half_z,
           MaterialIndex material, double yaw_rad = 0) {
    Block block;
    block.center_m = Eigen::Vector3d(x, y, z).cast<float>();
    block.half_m = Eigen::Vector3d(half_x, half_y, half_z).cast<float>();
    block.yaw_rad = static_cast<float>(yaw_rad);
    block.material = material;
    stage_.blocks.push_back(block);
  }

  void Rod(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius,
           MaterialIndex material) {
    Limb limb;
    limb.a_m = a.cast<float>();
    limb.b_m = b.cast<float>();
    limb.a_radius_m = limb.b_radius_m = static_cast<float>(radius);
    limb.material = material;
    stage_.limbs.push_back(limb);
  }

  // A painted line; crossing lines of different sports lie at different heights.
  void Line(const Vector2d& from, const Vector2d& to, double top_m, MaterialIndex material,
            double width_m = 0.05) {
    const Vector2d middle = 0.5 * (from + to), way = to - from;
    Box(middle.x(), middle.y(), top_m / 2, way.norm() / 2 + width_m / 2, width_m / 2, top_m / 2,
        material, std::atan2(way.y(), way.x()));
  }

  void Arc(const Vector2d& center, double radius, double from_rad, double to_rad, double top_m,
           MaterialIndex material) {
    const int pieces = std::max(4, static_cast<int>(radius * std::abs(to_rad - from_rad) / 0.5));
    const auto at = [&](int i) {
      const double angle = from_rad + (to_rad - from_rad) * i / pieces;
      return Vector2d(center + radius * Vector2d(std::cos(angle), std::sin(angle)));
    };
    for (int i = 0; i < pieces; ++i) Line(at(i), at(i + 1), top_m, material);
  }

  void Rectangle(double from_x, double to_x, double half_y, double top_m, MaterialIndex material) {
    Line({from_x, -half_y}, {to_x, -half_y}, top_m, material);
    Line({from_x, half_y}, {to_x, half_y}, top_m, material);
    Line({from_x, -half_y}, {from_x, half_y}, top_m, material);
    Line({to_x, -half_y}, {to_x, half_y}, top_m, material);
  }

  void Floor() {
    const MaterialIndex wood = Make({.pattern = Pattern::kPlanks,
                                     .color = {0.46F, 0.29F, 0.15F},
                                     .second = {0.28F, 0.17F, 0.09F},
                                     .scale_m = 0.14F,
                                     .gloss = 0.07F,
                                     .roughness_rad = 0.03F,
                                     .seed = 11});
    Box(0, 0, -0.05, kHallHalfLength_m, kHallHalfWidth_m, 0.05, wood);
  }

  void FloorballLines() {
    const MaterialIndex white =
        Make({.color = {0.80F, 0.80F, 0.78F}, .gloss = 0.05F, .roughness_rad = 0.06F});
    const double top = 0.005;
    Line({0, -kRinkHalfWidth_m}, {0, kRinkHalfWidth_m}, top, white, 0.06);
    for (const double side : {-1.0, 1.0}) {
      Rectangle(side * 17.15, side * 13.15, 2.5, top, white);  // goal area
      Rectangle(side * 16.5, side * 15.5, 1.25, top, white);   // the keeper's own
    }
    // Crosses for face-offs.
    for (const double x : {-16.5, 0.0, 16.5}) {
      for (const double y : {-8.5, 0.0, 8.5}) {
        if (x != 0 && y == 0) continue;
        Line({x - 0.15, y}, {x + 0.15, y}, top, white);
        Line({x, y - 0.15}, {x, y + 0.15}, top, white);
      }
    }
  }

  // The floor serves other sports, too.
  void OtherLines() {
    const MaterialIndex yellow = Paint({0.70F, 0.50F, 0.04F});
    const MaterialIndex blue = Paint({0.04F, 0.12F, 0.40F});
    const MaterialIndex green = Paint({0.03F, 0.26F, 0.10F});
    for (const double side : {-1.0, 1.0}) {
      const double turn = side > 0 ? pi / 2 : -pi / 2;  // handball, 6 m
      Arc({side * 19.4, side * 1.5}, 6, turn, turn + pi / 2, 0.002, yellow);
      Arc({side * 19.4, -side * 1.5}, 6, turn + pi / 2, turn + pi, 0.002, yellow);
      Line({side * 13.4, -1.5}, {side * 13.4, 1.5}, 0.002, yellow);
      Arc({side * 12.4, 0}, 6.75, turn, turn + pi, 0.003, blue);  // basketball
      Rectangle(side * 14, side * 8.2, 2.45, 0.003, blue);
    }
    Arc({0, 0}, 1.8, 0, 2 * pi, 0.003, blue);
    for (const double x : {-10.0, 0.0, 10.0}) Rectangle(x - 3.05, x + 3.05, 6.7, 0.004, green);
  }

  MaterialIndex Advert(const Vector3f& color, const Vector3f& letters, std::uint32_t seed) {
    return Make({.pattern = Pattern::kLetters,
                 .color = color,
                 .second = letters,
                 .scale_m = 0.28F,
                 .seed = seed});
  }

  // 0.5 m high, with rounded corners, and a gap before either bench. Some boards are as dark as the
  // shirts.
  void Boards() {
    const Vector3f white = {0.78F, 0.78F, 0.76F};
    const Vector3f dark = {0.025F, 0.027F, 0.04F};
    const Vector3f navy = {0.02F, 0.035F, 0.13F};
    const std::array<MaterialIndex, 7> adverts = {Advert(white, {0.55F, 0.03F, 0.03F}, 21),
                                                  Paint(white),
                                                  Advert(dark, {0.60F, 0.60F, 0.58F}, 22),
                                                  Advert(white, {0.03F, 0.08F, 0.40F}, 23),
                                                  Advert(navy, {0.60F, 0.45F, 0.05F}, 24),
                                                  Paint(white),
                                                  Advert(white, dark, 25)};
    std::size_t next = 0;
    const auto put = [&](const Vector2d& from, const Vector2d& to) {
      const Vector2d middle = 0.5 * (from + to), way = to - from;
      Box(middle.x(), middle.y(), 0.25, way.norm() / 2, 0.015, 0.25, adverts[next++ % 7],
          std::atan2(way.y(), way.x()));
    };
    const double x = kRinkHalfLength_m - kRinkCornerRadius_m, y = kRinkHalfWidth_m + 0.02;
    const auto run = [&](double from, double to, double at_y) {
      const int pieces = static_cast<int>(std::ceil((to - from) / 2));
      for (int i = 0; i < pieces; ++i) {
        put({from + (to - from) * i / pieces, at_y}, {from + (to - from) * (i + 1) / pieces, at_y});
      }
    };
    run(-x, x, -y);
    run(-x, -kGateTo_m, y);
    run(-kGateFrom_m, kGateFrom_m, y);
    run(kGateTo_m, x, y);
    for (const double side : {-1.0, 1.0}) {
      const double end = side * (kRinkHalfLength_m + 0.02);
      const double straight = kRinkHalfWidth_m - kRinkCornerRadius_m;
      for (int i = 0; i < 8; ++i) {
        put({end, -straight + straight * i / 4}, {end, -straight + straight * (i + 1) / 4});
      }
      for (const double up : {-1.0, 1.0}) {
        const Vector2d center(side * x, up * straight);
        const auto at = [&](int i) {
          const double angle = pi / 2 * i / 6;
          return Vector2d(center + (kRinkCornerRadius_m + 0.02) *
                                       Vector2d(side * std::cos(angle), up * std::sin(angle)));
        };
        for (int i = 0; i < 6; ++i) put(at(i), at(i + 1));
      }
    }
  }

  // 1.6 m wide and 1.15 m high, open to the middle, with a coarse net.
  void Goal(double side) {
    const MaterialIndex red = Paint({0.55F, 0.03F, 0.03F});
    const MaterialIndex net = Paint({0.75F, 0.75F, 0.75F});
    const double front = side * kGoalLine_m, back = side * (kGoalLine_m + 0.6);
    const double shallow = side * (kGoalLine_m + 0.35);
    const double height = 1.15, half = 0.8, radius = 0.03;
    Rod({front, -half, height}, {front, half, height}, radius, red);
    Rod({back, -half, 0.03}, {back, half, 0.03}, radius, red);
    for (const double y : {-half, half}) {
      Rod({front, y, 0.03}, {front, y, height}, radius, red);
      Rod({front, y, 0.03}, {back, y, 0.03}, radius, red);
      Rod({shallow, y, height}, {front, y, height}, radius, red);
      Rod({back, y, 0.03}, {shallow, y, height}, radius, red);
    }
    for (int i = 0; i <= 10; ++i) {
      const double y = -half + 0.16 * i;
      Rod({back, y, 0.03}, {shallow, y, height}, 0.006, net);
    }
    for (int i = 1; i <= 6; ++i) {
      const double share = i / 7.0, z = 0.03 + (height - 0.03) * share;
      const double x = back + (shallow - back) * share;
      Rod({x, -half, z}, {x, half, z}, 0.006, net);
      for (const double y : {-half, half}) Rod({front, y, z}, {x, y, z}, 0.006, net);
    }
  }

  void SideBench(double side) {
    const MaterialIndex wood = Paint({0.42F, 0.26F, 0.12F});
    const MaterialIndex metal = Paint({0.20F, 0.20F, 0.21F});
    const double middle = side * (kBenchFrom_m + 1.5 * kSeat_m);
    Box(middle, kBench_m, 0.42, 1.7, 0.16, 0.02, wood);
    for (const double x : {middle - 1.4, middle, middle + 1.4}) {
      Box(x, kBench_m, 0.2, 0.03, 0.14, 0.2, metal);
    }
    // Bottles, bags and the boards' transport trolley.
    Box(middle + side * 4.4, 12.7, 0.2, 0.5, 0.25, 0.2, Paint({0.30F, 0.03F, 0.03F}), 0.3);
    Box(middle + side * 6.0, 12.9, 0.16, 0.4, 0.22, 0.16, Paint({0.03F, 0.04F, 0.12F}), -0.5);
    // A long bench by the end wall, and the scorers' table between the teams.
    Box(side * 21.8, 0.5, 0.42, 0.18, 2, 0.02, wood);
    for (const double y : {-1.2, 2.2}) Box(side * 21.8, y, 0.2, 0.15, 0.03, 0.2, metal);
    if (side > 0) {
      Box(0, 11.8, 0.72, 1.0, 0.35, 0.02, Paint({0.62F, 0.62F, 0.60F}));
      Box(0, 11.46, 0.36, 1.0, 0.01, 0.34, Advert({0.70F, 0.70F, 0.68F}, {0.5F, 0.2F, 0.02F}, 31));
    }
  }

  void Walls() {
    const MaterialIndex brick = Make({.pattern = Pattern::kBricks,
                                      .color = {0.42F, 0.20F, 0.13F},
                                      .second = {0.50F, 0.48F, 0.45F},
                                      .scale_m = 0.5F,
                                      .seed = 41});
    const MaterialIndex plaster = Make({.pattern = Pattern::kSpeckle,
                                        .color = {0.62F, 0.61F, 0.56F},
                                        .second = {0.54F, 0.53F, 0.49F},
                                        .scale_m = 0.6F,
                                        .seed = 42});
    const MaterialIndex bars = Make({.pattern = Pattern::kStripes,
                                     .color = {0.48F, 0.30F, 0.14F},
                                     .second = {0.05F, 0.04F, 0.03F},
                                     .scale_m = 0.12F});
    const MaterialIndex panel = Make({.pattern = Pattern::kPlanks,
                                      .color = {0.07F, 0.06F, 0.06F},
                                      .second = {0.02F, 0.02F, 0.02F},
                                      .scale_m = 0.4F,
                                      .seed = 43});
    const MaterialIndex door = Paint({0.06F, 0.16F, 0.30F});
    const MaterialIndex window = Paint({0.85F, 0.88F, 0.92F});
    const MaterialIndex banner = Advert({0.55F, 0.05F, 0.04F}, {0.80F, 0.80F, 0.78F}, 44);
    const double x = kHallHalfLength_m + 0.1, y = kHallHalfWidth_m + 0.1;
    for (const double side : {-1.0, 1.0}) {
      Box(0, side * y, 2, x, 0.1, 2, brick);
      Box(0, side * y, 7, x, 0.1, 3, plaster);
      Box(side * x, 0, 2, 0.1, y, 2, brick);
      Box(side * x, 0, 7, 0.1, y, 3, plaster);
      // Along the long walls: wall bars, dark panels, doors, windows above.
      for (int i = 0; i < 6; ++i) {
        const double at = -19 + 7.6 * i;
        const MaterialIndex what = i % 3 == 0 ? bars : i % 3 == 1 ? panel : door;
        const double half = what == door ? 0.9 : 1.9;
        Box(at, side * (y - 0.13), what == door ? 1.05 : 1.3, half, 0.03, what == door ? 1.05 : 1.3,
            what);
        Box(at + 3.4, side * (y - 0.12), 6.4, 1.5, 0.02, 0.9, window);
      }
      for (const double at : {-8.0, 8.0}) {
        Box(side * (x - 0.13), at, 1.3, 0.03, 2.4, 1.3, bars);
        Box(side * (x - 0.12), at, 3.6, 0.02, 1.8, 0.6, banner);
      }
      Box(side * (x - 0.13), 0, 1.05, 0.03, 1.0, 1.05, door);
    }
    const MaterialIndex ceiling = Make({.pattern = Pattern::kPlanks,
                                        .color = {0.40F, 0.38F, 0.35F},
                                        .second = {0.22F, 0.20F, 0.18F},
                                        .scale_m = 1.2F,
                                        .seed = 45});
    Box(0, 0, 10.1, x, y, 0.1, ceiling);
  }

  void Lamps() {
    const MaterialIndex tube = Paint({0.95F, 0.95F, 0.95F});
    stage_.lighting.ambient = {0.27F, 0.28F, 0.29F};
    stage_.lighting.sky = {0.6F, 0.6F, 0.6F};
    for (const double x : {-11.0, 11.0}) {
      for (const double y : {-6.0, 6.0}) {
        Lamp lamp;
        lamp.center_m = {static_cast<float>(x), static_cast<float>(y), 9.6F};
        lamp.half_u_m = {2.5F, 0, 0};
        lamp.half_v_m = {0, 0.8F, 0};
        lamp.color = {0.22F, 0.213F, 0.195F};
        stage_.lighting.lamps.push_back(lamp);
        Box(x, y, 9.8, 2.5, 0.8, 0.05, tube);
      }
    }
  }

  Stage& stage_;
};

}  // namespace

MaterialIndex AddMaterial(Stage& stage, const Material& material) {
  stage.materials.push_back(material);
  return static_cast<MaterialIndex>(stage.materials.size()) - 1;
}

void BuildHall(Stage& stage) { Builder(stage).Build(); }

HallScenery::HallScenery(Stage& stage) {
  const std::array<std::array<Vector3f, 2>, 3> pictures = {
      {{{{0.03F, 0.06F, 0.30F}, {0.75F, 0.75F, 0.75F}}},
       {{{0.75F, 0.70F, 0.10F}, {0.04F, 0.04F, 0.04F}}},
       {{{0.70F, 0.70F, 0.70F}, {0.50F, 0.04F, 0.05F}}}}};
  std::uint32_t seed = 61;
  for (const auto& [color, letters] : pictures) {
    pictures_.push_back(AddMaterial(stage, {.pattern = Pattern::kLetters,
                                            .color = color,
                                            .second = letters,
                                            .scale_m = 0.5F,
                                            .seed = seed++}));
  }
  cloth_ = AddMaterial(stage, {.pattern = Pattern::kStripes,
                               .color = {0.05F, 0.16F, 0.10F},
                               .second = {0.10F, 0.26F, 0.16F},
                               .scale_m = 0.2F});
}

Thing HallScenery::Board(int id, double secs) const {
  Thing thing;
  thing.id = id;
  thing.kind = Thing::Kind::kScenery;
  thing.foreground = false;
  thing.ground_m = {0, -kHallHalfWidth_m + 0.1};
  Block block;
  block.center_m = {0, static_cast<float>(-kHallHalfWidth_m + 0.08), 3.4F};
  block.half_m = {2.4F, 0.05F, 0.7F};
  const auto shown = static_cast<std::size_t>(std::max(0.0, secs) / 10) % pictures_.size();
  block.material = pictures_[shown];
  thing.blocks.push_back(block);
  return thing;
}

// Strips of cloth that hang from a rail and swing a little, each with its own beat.
Thing HallScenery::Curtain(int id, double secs) const {
  Thing thing;
  thing.id = id;
  thing.kind = Thing::Kind::kScenery;
  thing.foreground = false;
  thing.ground_m = {kHallHalfLength_m - 0.5, -12};
  for (int i = 0; i < 6; ++i) {
    Block block;
    const double sway = std::sin(1.1 * secs + 0.8 * i) + 0.5 * std::sin(2.3 * secs + 1.7 * i);
    block.center_m =
        Eigen::Vector3d(kHallHalfLength_m - 0.4 + 0.06 * sway, -13.4 + 0.42 * i, 2.2).cast<float>();
    block.half_m = {0.01F, 0.21F, 2.1F};
    block.yaw_rad = static_cast<float>(0.25 * (i % 2 == 0 ? 1 : -1) + 0.12 * sway);
    block.material = cloth_;
    thing.blocks.push_back(block);
  }
  return thing;
}

}  // namespace vantage::simulation
