// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/ground_light.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/simulation/hash.h"

namespace vantage::simulation::internal {
namespace {

using Eigen::AlignedBox2f;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kTexel_m = 0.05F;
constexpr int kTile = 32;              // texels along a side of a tile
constexpr int kCorners = kTile + 1;    // with the first ones of the next: for interpolation
constexpr int kTraced = kCorners + 2;  // with one more around them: for smoothing
constexpr float kLargestSide_m = 300;
constexpr float kLongestShadow_m = 15;
constexpr float kDimReach_m = 1.2F;  // of things on the ambient light around them

struct Ball {
  Vector3f center_m;
  float radius_m;
};

/// Spheres that fill about the volume of a part.
void AddBalls(const Thing& thing, std::vector<Ball>& balls) {
  const auto add = [&](const Vector3f& a, const Vector3f& b, float a_radius, float b_radius,
                       int count) {
    for (int i = 0; i < count; ++i) {
      const float share = (static_cast<float>(i) + 0.5F) / static_cast<float>(count);
      balls.push_back({a + share * (b - a), a_radius + share * (b_radius - a_radius)});
    }
  };
  for (const Limb& limb : thing.limbs) {
    const float girth = limb.a_radius_m + limb.b_radius_m;
    const float length = (limb.b_m - limb.a_m).norm();
    const int count = std::clamp(static_cast<int>(length / std::max(girth, 0.02F) + 0.5F), 1, 4);
    add(limb.a_m, limb.b_m, limb.a_radius_m, limb.b_radius_m, count);
  }
  for (const Block& block : thing.blocks) {
    const bool along_x = block.half_m.x() > block.half_m.y();
    const float half = std::max(block.half_m.x(), block.half_m.y());
    const float radius = std::min(std::min(block.half_m.x(), block.half_m.y()), block.half_m.z());
    const float turn = block.yaw_rad + (along_x ? 0.0F : 1.5707963F);
    const Vector3f way(std::cos(turn) * half, std::sin(turn) * half, 0);
    const int count = std::clamp(static_cast<int>(half / std::max(radius, 0.02F) + 0.5F), 1, 8);
    add(block.center_m - way, block.center_m + way, radius, radius, count);
  }
}

/// Share of the ambient light on the ground that a sphere takes: its solid angle weighed with the
/// cosine, (r / d)^2 cos, half more for what lies between the spheres, fading out to nothing at
/// kDimReach_m.
float Dimming(const Ball& ball, const Vector2f& ground_m) {
  const float beside2 = (ball.center_m.head<2>() - ground_m).squaredNorm();
  const float fade = 1 - beside2 / (kDimReach_m * kDimReach_m);
  if (fade <= 0) return 0;
  const float height = std::max(ball.center_m.z(), ball.radius_m);
  const float distance2 = beside2 + height * height;
  return 1.5F * ball.radius_m * ball.radius_m * height / (distance2 * std::sqrt(distance2)) * fade *
         fade;
}

/// Adds the place of the ground that a sphere shades from a point of a lamp.
void AddShadow(const Vector3f& lamp_m, const Vector3f& center_m, float radius_m,
               AlignedBox2f& box) {
  const Vector2f foot = center_m.head<2>();
  const float drop = std::max(0.1F, lamp_m.z() - center_m.z());
  const Vector2f tilt = (foot - lamp_m.head<2>()) / drop;
  const Vector2f way = tilt * std::max(0.0F, center_m.z());
  const float stretch = lamp_m.z() / drop * std::sqrt(1 + tilt.squaredNorm());
  const float far = way.norm();
  const Vector2f middle = foot + way * (far > kLongestShadow_m ? kLongestShadow_m / far : 1.0F);
  const float reach = std::min(radius_m * stretch * 1.2F, kLongestShadow_m);
  box.extend(Vector2f(middle.array() - reach));
  box.extend(Vector2f(middle.array() + reach));
}

}  // namespace

/// A rectangle of texels in which a part of a thing may take light of a group.
struct GroundLight::Patch {
  std::uint32_t thing = 0;
  int group = 0;
  int left = 0;
  int top = 0;
  int right = 0;  // inclusive
  int bottom = 0;
};

GroundLight::GroundLight(const FixedWorld& world, const AlignedBox2f& seen)
    : groups_(world.groups()) {
  if (seen.isEmpty()) return;
  const Vector2f size = seen.sizes().cwiseMin(kLargestSide_m);
  min_m_ = seen.center() - size / 2;
  const float tile_m = kTile * kTexel_m;
  columns_ = static_cast<int>(size.x() / tile_m) + 1;
  rows_ = static_cast<int>(size.y() / tile_m) + 1;
  tiles_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
}

Vector2f GroundLight::PointOf(int column, int row) const {
  return min_m_ + kTexel_m * Vector2f(static_cast<float>(column), static_cast<float>(row));
}

void GroundLight::Update(const FixedWorld& world, const Moving& moving, int threads) {
  std::vector<Patch> patches;
  const auto add = [&](std::size_t thing, int group, const AlignedBox2f& box) {
    const auto texel = [&](float value, float min, float rounded) {
      return static_cast<int>(
          std::clamp(std::floor((value - min) / kTexel_m) + rounded, -1e6F, 1e6F));
    };
    patches.push_back({static_cast<std::uint32_t>(thing), group,
                       texel(box.min().x(), min_m_.x(), 0), texel(box.min().y(), min_m_.y(), 0),
                       texel(box.max().x(), min_m_.x(), 1), texel(box.max().y(), min_m_.y(), 1)});
  };
  const std::vector<Lamp>& lamps = world.lighting().lamps;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const PreparedThing& prepared = moving[i];
    if (prepared.bounds.isEmpty()) continue;
    const Vector2f reach = Vector2f::Constant(kDimReach_m);
    add(i, 0, {prepared.bounds.min().head<2>() - reach, prepared.bounds.max().head<2>() + reach});
    for (std::size_t lamp = 0; lamp < lamps.size(); ++lamp) {
      const auto shadow = [&](auto add_part) {
        AlignedBox2f box;
        for (const float u : {0.0F, 1.0F}) {
          for (const float v : {0.0F, 1.0F}) add_part(LampPoint(lamps[lamp], u, v), box);
        }
        add(i, static_cast<int>(1 + lamp), box);
      };
      for (const Limb& limb : prepared.thing.limbs) {
        shadow([&](const Vector3f& from, AlignedBox2f& box) {
          AddShadow(from, limb.a_m, limb.a_radius_m, box);
          AddShadow(from, limb.b_m, limb.b_radius_m, box);
        });
      }
      for (const Block& block : prepared.thing.blocks) {
        shadow([&](const Vector3f& from, AlignedBox2f& box) {
          for (const Vector3f& corner : BlockCorners(block)) AddShadow(from, corner, 0, box);
        });
      }
    }
  }

  // Which patches touch which tiles, in the order of the things.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> touches;
  for (std::uint32_t i = 0; i < patches.size(); ++i) {
    const Patch& patch = patches[i];
    // A tile is touched by what its outermost traced texels see: one before it, two after it.
    const auto first = [](int texel) { return std::max(0, (texel - 2) / kTile); };
    const auto last = [](int texel, int count) {
      return texel < -1 ? -1 : std::min(count - 1, (texel + 1) / kTile);
    };
    for (int row = first(patch.top); row <= last(patch.bottom, rows_); ++row) {
      for (int column = first(patch.left); column <= last(patch.right, columns_); ++column) {
        touches.emplace_back(static_cast<std::uint32_t>(row * columns_ + column), i);
      }
    }
  }
  std::sort(touches.begin(), touches.end());
  std::vector<std::uint32_t> before;
  before.swap(shaded_);
  struct Work {
    std::uint32_t tile;
    std::vector<std::uint32_t> patches;
  };
  std::vector<Work> work;
  for (std::size_t i = 0; i < touches.size();) {
    Work item{touches[i].first, {}};
    std::uint64_t key = 1;
    for (; i < touches.size() && touches[i].first == item.tile; ++i) {
      const std::uint32_t thing = patches[touches[i].second].thing;
      if (item.patches.empty() || patches[item.patches.back()].thing != thing) {
        key = Hash(key, moving[thing].key);
      }
      item.patches.push_back(touches[i].second);
    }
    shaded_.push_back(item.tile);
    if (tiles_[item.tile].key == key) continue;
    tiles_[item.tile].key = key;
    work.push_back(std::move(item));
  }
  for (const std::uint32_t tile : before) {
    if (!std::binary_search(shaded_.begin(), shaded_.end(), tile)) tiles_[tile] = {};
  }
  ParallelFor(threads, static_cast<std::int64_t>(work.size()), [&](std::int64_t i) {
    const Work& item = work[static_cast<std::size_t>(i)];
    Trace(world, moving, item.tile, patches, item.patches);
  });
}

void GroundLight::Trace(const FixedWorld& world, const Moving& moving, std::uint32_t tile,
                        const std::vector<Patch>& patches, const std::vector<std::uint32_t>& here) {
  const int left = static_cast<int>(tile) % columns_ * kTile;
  const int top = static_cast<int>(tile) / columns_ * kTile;
  const auto at = [](int x, int y, int width) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  };
  constexpr std::size_t kLayer = static_cast<std::size_t>(kCorners) * kCorners;
  std::vector<float>& shares = tiles_[tile].shares;
  shares.assign(static_cast<std::size_t>(groups_) * kLayer, 1.0F);

  std::vector<Ball> balls;
  for (const std::uint32_t patch : here) {
    if (patches[patch].group == 0) AddBalls(moving[patches[patch].thing].thing, balls);
  }
  std::array<float, kLayer> taken = {};
  for (const Ball& ball : balls) {
    const Vector2f middle =
        (ball.center_m.head<2>() - PointOf(left, top)) / kTexel_m;  // in texels of the tile
    const float reach = kDimReach_m / kTexel_m;
    const auto texel = [](float place) {
      return static_cast<int>(std::clamp(place, -1.0F, static_cast<float>(kCorners)));
    };
    for (int y = std::max(0, texel(middle.y() - reach));
         y <= std::min(kCorners - 1, texel(middle.y() + reach)); ++y) {
      for (int x = std::max(0, texel(middle.x() - reach));
           x <= std::min(kCorners - 1, texel(middle.x() + reach)); ++x) {
        taken[at(x, y, kCorners)] += Dimming(ball, PointOf(left + x, top + y));
      }
    }
  }
  for (std::size_t i = 0; i < kLayer; ++i) shares[i] = 1 - std::min(taken[i], 0.85F);

  for (int group = 1; group < groups_; ++group) {
    std::array<std::uint8_t, static_cast<std::size_t>(kTraced)* kTraced> wanted = {};
    bool some = false;
    for (const std::uint32_t index : here) {
      const Patch& patch = patches[index];
      if (patch.group != group) continue;
      for (int y = std::max(0, patch.top - top + 1);
           y <= std::min(kTraced - 1, patch.bottom - top + 1); ++y) {
        for (int x = std::max(0, patch.left - left + 1);
             x <= std::min(kTraced - 1, patch.right - left + 1); ++x) {
          wanted[at(x, y, kTraced)] = 1;
          some = true;
        }
      }
    }
    if (!some) continue;
    const Lamp& lamp = world.lighting().lamps[static_cast<std::size_t>(group - 1)];
    std::array<float, wanted.size()> seen;
    seen.fill(1);
    for (int y = 0; y < kTraced; ++y) {
      for (int x = 0; x < kTraced; ++x) {
        if (wanted[at(x, y, kTraced)] == 0) continue;
        const Vector2f ground = PointOf(left + x - 1, top + y - 1);
        const std::uint64_t key = Hash(0x67726e64U, left + x, top + y);
        std::array<Ray, 8> rays;
        for (std::size_t ray = 0; ray < rays.size(); ++ray) {
          const float u = (static_cast<float>(ray % 4) + UpperUnit(key)) / 4;
          const float v = (static_cast<float>(ray / 4) + LowerUnit(key)) / 2;
          rays[ray] =
              RayTowards({ground.x(), ground.y(), 0}, Vector3f::UnitZ(), LampPoint(lamp, u, v));
        }
        const int blocked = std::popcount(BlockedRays(moving.together(), rays));
        seen[at(x, y, kTraced)] = 1 - static_cast<float>(blocked) / 8;
      }
    }
    // Few rays a texel, smoothed over nine of them.
    for (int y = 0; y < kCorners; ++y) {
      for (int x = 0; x < kCorners; ++x) {
        float sum = 0;
        for (int dy = 0; dy < 3; ++dy) {
          for (int dx = 0; dx < 3; ++dx) sum += seen[at(x + dx, y + dy, kTraced)];
        }
        shares[static_cast<std::size_t>(group) * kLayer + at(x, y, kCorners)] = sum / 9;
      }
    }
  }
}

std::optional<std::uint32_t> GroundLight::TileAt(const Vector2f& ground_m) const {
  const Vector2f place = (ground_m - min_m_) / (kTile * kTexel_m);
  if (!(place.x() >= 0 && place.y() >= 0 && place.x() < static_cast<float>(columns_) &&
        place.y() < static_cast<float>(rows_))) {
    return std::nullopt;
  }
  return static_cast<std::uint32_t>(static_cast<int>(place.y()) * columns_ +
                                    static_cast<int>(place.x()));
}

GroupShares GroundLight::At(const Vector2f& ground_m) const {
  GroupShares result;
  result.fill(1);
  const auto tile = TileAt(ground_m);
  if (!tile || tiles_[*tile].shares.empty()) return result;
  const std::vector<float>& shares = tiles_[*tile].shares;
  const auto column = static_cast<float>(static_cast<int>(*tile) % columns_ * kTile);
  const auto row = static_cast<float>(static_cast<int>(*tile) / columns_ * kTile);
  const Vector2f texel = (ground_m - min_m_) / kTexel_m - Vector2f(column, row);
  const int x = std::clamp(static_cast<int>(texel.x()), 0, kTile - 1);
  const int y = std::clamp(static_cast<int>(texel.y()), 0, kTile - 1);
  const float fx = std::clamp(texel.x() - static_cast<float>(x), 0.0F, 1.0F);
  const float fy = std::clamp(texel.y() - static_cast<float>(y), 0.0F, 1.0F);
  for (std::size_t group = 0; group < static_cast<std::size_t>(groups_); ++group) {
    const float* corner =
        shares.data() + group * kCorners * kCorners + static_cast<std::size_t>(y * kCorners + x);
    const float low = corner[0] + fx * (corner[1] - corner[0]);
    const float high = corner[kCorners] + fx * (corner[kCorners + 1] - corner[kCorners]);
    result[group] = low + fy * (high - low);
  }
  return result;
}

}  // namespace vantage::simulation::internal
