// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/fixed_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/base/parallel.h"
#include "vantage/simulation/hash.h"
#include "vantage/simulation/texture.h"

namespace vantage::simulation::internal {
namespace {

using Eigen::Vector3f;

constexpr int kSide = 4;  // samples of a pixel along each side
constexpr int kSamples = kSide * kSide;
constexpr float kBrightest = 16;  // radiance of the largest code
constexpr float kGround_m = 0.02F;

using GroupRadiance = std::array<Vector3f, kMaxGroups>;

std::uint16_t Encode(float radiance) {
  const float root = std::sqrt(std::clamp(radiance, 0.0F, kBrightest) / kBrightest);
  return static_cast<std::uint16_t>(std::lround(65535 * root));
}

float Decode(std::uint16_t code) {
  const float root = static_cast<float>(code) * (1.0F / 65535);
  return kBrightest * root * root;
}

std::uint64_t PixelKey(int x, int y) { return Hash(0x66697865U, x, y); }

/// Adds the light from where a mirrored ray comes, `share` of it.
void AddMirrored(const FixedWorld& world, const Ray& ray, const Hit& hit, float share,
                 std::uint64_t key, int sample, GroupRadiance& sums) {
  if (const auto lamp = SeeLamp(world.lighting(), ray, hit.t_m)) {
    const int group = 1 + lamp->lamp;
    sums[static_cast<std::size_t>(group)] += share * lamp->radiance * world.GroupColor(group);
    return;
  }
  if (!hit.Exists()) {
    sums[0] += share * world.lighting().sky;
    return;
  }
  const Vector3f point = ray.origin_m + hit.t_m * ray.direction;
  const SurfacePoint surface = world.SurfaceAt(hit, point);
  const GroupShares light = world.LightAt(point, hit.normal, key, sample);
  for (int g = 0; g < world.groups(); ++g) {
    const auto group = static_cast<std::size_t>(g);
    sums[group] += share * light[group] * surface.color.cwiseProduct(world.GroupColor(g));
  }
}

}  // namespace

struct FixedView::PixelSums {
  GroupRadiance diffuse;
  GroupRadiance mirrored;
};

FixedView::FixedView(const FixedWorld& world, const PixelRays& rays, int threads)
    : groups_(world.groups()) {
  const auto pixels =
      static_cast<std::size_t>(rays.width()) * static_cast<std::size_t>(rays.height());
  const std::size_t layers = static_cast<std::size_t>(groups_) * 3;
  points_.resize(pixels);
  ground_material_.assign(pixels, 0);
  diffuse_.assign(pixels * layers, 0);
  const bool glossy = std::any_of(world.stage().materials.begin(), world.stage().materials.end(),
                                  [](const Material& material) { return material.gloss > 0; });
  if (glossy) mirrored_.assign(pixels * layers, 0);
  ParallelFor(threads, rays.height(), [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < rays.width(); ++x) {
      if (!rays.Exists(x, y)) continue;
      PixelSums sums;
      sums.diffuse.fill(Vector3f::Zero());
      sums.mirrored.fill(Vector3f::Zero());
      TracePixel(world, rays, x, y, sums);
      std::size_t layer = (static_cast<std::size_t>(y) * static_cast<std::size_t>(rays.width()) +
                           static_cast<std::size_t>(x)) *
                          layers;
      for (std::size_t group = 0; group < static_cast<std::size_t>(groups_); ++group) {
        for (Eigen::Index channel = 0; channel < 3; ++channel, ++layer) {
          diffuse_[layer] = Encode(sums.diffuse[group][channel] / kSamples);
          if (glossy) mirrored_[layer] = Encode(sums.mirrored[group][channel] / kSamples);
        }
      }
    }
  });
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    if (!points_[pixel].ground || points_[pixel].mirror_share <= 0) continue;
    ground_roughness_rad_ =
        std::max(ground_roughness_rad_, world.material(ground_material_[pixel]).roughness_rad);
  }
}

void FixedView::TracePixel(const FixedWorld& world, const PixelRays& rays, int x, int y,
                           PixelSums& sums) {
  const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(rays.width()) +
                            static_cast<std::size_t>(x);
  FixedPoint& center = points_[pixel];
  const Ray center_ray = rays.Through(x, y);
  const Hit center_hit = world.solid().Trace(center_ray);
  center.t_m = center_hit.t_m;
  if (center_hit.Exists()) {
    const Vector3f point = center_ray.origin_m + center_hit.t_m * center_ray.direction;
    const SurfacePoint surface = world.SurfaceAt(center_hit, point);
    center.ground = center_hit.normal.z() > 0.99F && std::abs(point.z()) < kGround_m;
    ground_material_[pixel] = surface.material;
    if (center.ground) {
      center.mirror_share = MirroredShare(world.material(surface.material).gloss,
                                          -center_ray.direction.dot(center_hit.normal));
    }
    if (center.mirror_share > 0) {
      center.mirror_t_m = world.solid().Trace(MirroredRay(world, rays, x, y)).t_m;
    }
  }

  const std::uint64_t key = PixelKey(x, y);
  GroupShares light = {};
  std::uint32_t lit_part = 0;
  for (int sample = 0; sample < kSamples; ++sample) {
    const float dx = (static_cast<float>(sample % kSide) + 0.5F) / kSide - 0.5F;
    const float dy = (static_cast<float>(sample / kSide) + 0.5F) / kSide - 0.5F;
    const Ray ray = rays.Through(x, y, dx, dy);
    const Hit hit = world.solid().Trace(ray);
    if (const auto lamp = SeeLamp(world.lighting(), ray, hit.t_m)) {
      const int group = 1 + lamp->lamp;
      sums.diffuse[static_cast<std::size_t>(group)] += lamp->radiance * world.GroupColor(group);
      continue;
    }
    if (!hit.Exists()) {
      sums.diffuse[0] += world.lighting().sky;
      continue;
    }
    const Vector3f point = ray.origin_m + hit.t_m * ray.direction;
    const SurfacePoint surface = world.SurfaceAt(hit, point);
    // Light changes slowly over a surface: every second sample takes that of the one before.
    if (sample % 2 == 0 || hit.part != lit_part) {
      light = world.LightAt(point, hit.normal, key, sample);
      lit_part = hit.part;
    }
    const Material& material = world.material(surface.material);
    const float mirrored = MirroredShare(material.gloss, -ray.direction.dot(hit.normal));
    for (int g = 0; g < groups_; ++g) {
      const auto group = static_cast<std::size_t>(g);
      sums.diffuse[group] +=
          (1 - mirrored) * light[group] * surface.color.cwiseProduct(world.GroupColor(g));
    }
    // Every second sample mirrors for two.
    if (mirrored > 0 && sample % 2 == 0) {
      const std::uint64_t turn = Hash(key, sample);
      const Ray onwards{point + 2e-3F * hit.normal,
                        MirroredDirection(ray.direction, hit.normal, material.roughness_rad,
                                          UpperUnit(turn), LowerUnit(turn))};
      AddMirrored(world, onwards, world.solid().Trace(onwards), 2 * mirrored, key, sample,
                  sums.mirrored);
    }
  }
}

Ray FixedView::MirroredRay(const FixedWorld& world, const PixelRays& rays, int x, int y) const {
  const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(rays.width()) +
                            static_cast<std::size_t>(x);
  const Ray ray = rays.Through(x, y);
  const Vector3f point = ray.origin_m + points_[pixel].t_m * ray.direction;
  const std::uint64_t turn = PixelKey(x, y);
  return {point + 2e-3F * Vector3f::UnitZ(),
          MirroredDirection(ray.direction, Vector3f::UnitZ(),
                            world.material(ground_material_[pixel]).roughness_rad, UpperUnit(turn),
                            LowerUnit(turn))};
}

Vector3f FixedView::Sum(const std::vector<std::uint16_t>& layers, std::size_t pixel,
                        const GroupShares& weights) const {
  Vector3f sum(0, 0, 0);
  const std::uint16_t* code = layers.data() + pixel * static_cast<std::size_t>(groups_) * 3;
  for (int g = 0; g < groups_; ++g) {
    for (Eigen::Index channel = 0; channel < 3; ++channel) {
      sum[channel] += weights[static_cast<std::size_t>(g)] * Decode(*code++);
    }
  }
  return sum;
}

}  // namespace vantage::simulation::internal
