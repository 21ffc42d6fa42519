// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/moving.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/simulation/hash.h"
#include "vantage/simulation/texture.h"

namespace vantage::simulation::internal {
namespace {

using Eigen::Vector3f;

/// Things farther apart than this neither shade nor dim each other.
constexpr float kShadeReach_m = 2.5F;
/// Others dim the ambient light from within this distance.
constexpr float kDimReach_m = 0.6F;
constexpr int kRays = 4;  // to each lamp, and for the ambient light

std::uint64_t KeyOf(const Thing& thing) {
  static_assert(sizeof(Limb) == 36 && sizeof(Block) == 32, "hashed as they are: no padding");
  const std::uint64_t limbs = HashObjects(1, thing.limbs.data(), thing.limbs.size());
  return HashObjects(limbs, thing.blocks.data(), thing.blocks.size());
}

Vector3f MiddleOf(const Thing& thing, std::size_t part) {
  if (part < thing.limbs.size()) return (thing.limbs[part].a_m + thing.limbs[part].b_m) / 2;
  return thing.blocks[part - thing.limbs.size()].center_m;
}

/// Shadows of the fixed world on moving things, from a few points of the lamps to the middle of
/// each part: they are soft, and parts are small.
std::vector<GroupShares> OpenShares(const FixedWorld& world, const Thing& thing) {
  std::vector<GroupShares> open(thing.limbs.size() + thing.blocks.size());
  constexpr int kSide = 2;
  for (std::size_t part = 0; part < open.size(); ++part) {
    open[part][0] = 1;
    const Vector3f middle = MiddleOf(thing, part);
    for (std::size_t lamp = 0; lamp < world.lighting().lamps.size(); ++lamp) {
      int seen = 0;
      for (int sample = 0; sample < kSide * kSide; ++sample) {
        const float u = (static_cast<float>(sample % kSide) + 0.5F) / kSide;
        const float v = (static_cast<float>(sample / kSide) + 0.5F) / kSide;
        const Vector3f goal = LampPoint(world.lighting().lamps[lamp], u, v);
        if (!world.solid().Blocks(RayTowards(middle, Vector3f::Zero(), goal))) ++seen;
      }
      open[part][1 + lamp] = static_cast<float>(seen) / (kSide * kSide);
    }
  }
  return open;
}

Result<std::shared_ptr<const PreparedThing>> PrepareThing(RTCDevice device, const FixedWorld& world,
                                                          Thing thing, std::uint64_t key) {
  auto prepared = std::make_shared<PreparedThing>();
  VANTAGE_ASSIGN_OR_RETURN(prepared->solid, Solid::Build(device, thing.limbs, thing.blocks));
  prepared->key = key;
  prepared->bounds = BoundsOf(thing.limbs, thing.blocks);
  prepared->open = OpenShares(world, thing);
  prepared->thing = std::move(thing);
  return prepared;
}

}  // namespace

Result<Moving> Moving::Prepare(RTCDevice device, const FixedWorld& world, std::vector<Thing> things,
                               const Moving& last) {
  Moving moving;
  std::size_t before = 0;
  std::vector<const Solid*> solids;
  for (Thing& thing : things) {
    const std::uint64_t key = KeyOf(thing);
    while (before < last.size() && last[before].thing.id < thing.id) ++before;
    const bool known = before < last.size() && last[before].thing.id == thing.id &&
                       last[before].key == key && last[before].thing.kind == thing.kind &&
                       last[before].thing.foreground == thing.foreground;
    if (known) {
      moving.things_.push_back(last.things_[before]);
    } else {
      VANTAGE_ASSIGN_OR_RETURN(auto prepared, PrepareThing(device, world, std::move(thing), key));
      moving.things_.push_back(std::move(prepared));
    }
    solids.push_back(&moving.things_.back()->solid);
  }
  VANTAGE_ASSIGN_OR_RETURN(moving.together_, JoinSolids(device, solids));
  for (std::size_t i = 0; i < moving.size(); ++i) {
    std::uint64_t key = moving[i].key;
    for (std::size_t j = 0; j < moving.size(); ++j) {
      if (j == i || moving[i].bounds.exteriorDistance(moving[j].bounds) > kShadeReach_m) continue;
      key = Hash(key, moving[j].key);
    }
    moving.lit_keys_.push_back(key);
  }
  return moving;
}

GroupShares Moving::LightAt(const FixedWorld& world, std::size_t i, const Hit& hit,
                            const Vector3f& point_m, std::uint64_t key) const {
  const GroupShares& open = things_[i]->open[hit.part - 1];
  GroupShares light = {};
  const float shift_u = UpperUnit(key);
  const float shift_v = LowerUnit(key);
  // Shifted pattern of four: one in each quarter.
  const auto place = [&](int ray) {
    const float u = (static_cast<float>(ray % 2) + 0.5F) / 2 + shift_u;
    const float v = (static_cast<float>(ray / 2) + 0.5F) / 2 + shift_v;
    return std::pair(u - std::floor(u), v - std::floor(v));
  };
  // All rays of the point at once: their group, and what each adds to it.
  std::array<Ray, kRays * kMaxGroups> rays;
  std::array<std::pair<std::size_t, float>, rays.size()> gains;
  std::size_t count = 0;
  for (int ray = 0; ray < kRays; ++ray) {
    const auto [u, v] = place(ray);
    rays[count] = {point_m + 2e-3F * hit.normal, CosineDirection(hit.normal, u, v), kDimReach_m};
    gains[count++] = {0, AmbientShare(hit.normal) / kRays};
  }
  for (std::size_t lamp = 0; lamp < world.lighting().lamps.size(); ++lamp) {
    if (open[1 + lamp] <= 0) continue;
    for (int ray = 0; ray < kRays; ++ray) {
      const auto [u, v] = place(ray);
      Ray& way = rays[count];
      way = RayTowards(point_m, hit.normal, LampPoint(world.lighting().lamps[lamp], u, v));
      way.far_m = std::min(way.far_m, kShadeReach_m);
      const float cosine = way.direction.dot(hit.normal);
      if (cosine > 0) gains[count++] = {1 + lamp, open[1 + lamp] * cosine / kRays};
    }
  }
  const std::uint32_t blocked = BlockedRays(together_.get(), std::span(rays).first(count));
  for (std::size_t ray = 0; ray < count; ++ray) {
    if ((blocked >> ray & 1U) == 0) light[gains[ray].first] += gains[ray].second;
  }
  return light;
}

GroupShares Moving::OpenLightAt(const FixedWorld& world, std::size_t i, const Hit& hit) const {
  const PreparedThing& prepared = *things_[i];
  GroupShares light = {};
  light[0] = 0.8F * AmbientShare(hit.normal);  // about what its own parts leave
  const Vector3f middle = MiddleOf(prepared.thing, hit.part - 1);
  for (std::size_t lamp = 0; lamp < world.lighting().lamps.size(); ++lamp) {
    const Vector3f way = (world.lighting().lamps[lamp].center_m - middle).normalized();
    light[1 + lamp] = prepared.open[hit.part - 1][1 + lamp] * std::max(0.0F, way.dot(hit.normal));
  }
  return light;
}

Vector3f Moving::Radiance(const FixedWorld& world, std::size_t i, const Hit& hit,
                          const Vector3f& point_m, const Vector3f& direction,
                          const GroupShares& light, const GroupShares& gains) const {
  const Thing& thing = things_[i]->thing;
  const std::size_t part = hit.part - 1;
  MaterialIndex index = 0;
  Eigen::Vector2f place;
  if (part < thing.limbs.size()) {
    index = thing.limbs[part].material;
    place = PlaceOnLimb(thing.limbs[part], point_m);
  } else {
    const Block& block = thing.blocks[part - thing.limbs.size()];
    index = block.material;
    const Eigen::AngleAxisf turn(-block.yaw_rad, Vector3f::UnitZ());
    place = PlaceOnPlane(turn * (point_m - block.center_m), turn * hit.normal);
  }
  const Material& material = world.material(index);
  Vector3f irradiance(0, 0, 0);
  for (int g = 0; g < world.groups(); ++g) {
    const auto group = static_cast<std::size_t>(g);
    irradiance += gains[group] * light[group] * world.GroupColor(g);
  }
  const float mirrored = MirroredShare(material.gloss, -direction.dot(hit.normal));
  Vector3f radiance = (1 - mirrored) * irradiance.cwiseProduct(TextureColor(material, place));
  if (mirrored > 0) radiance += mirrored * gains[0] * world.lighting().sky;
  return radiance;
}

}  // namespace vantage::simulation::internal
