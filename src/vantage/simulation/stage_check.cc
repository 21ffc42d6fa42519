// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/stage_check.h"

#include <cmath>
#include <string>

namespace vantage::simulation::internal {
namespace {

using Eigen::Vector3f;

constexpr float kFarthest_m = 10'000;
constexpr std::size_t kMostLamps = 4;
constexpr std::size_t kMostCameras = 1000;
constexpr std::size_t kMostThings = 10'000;
constexpr std::size_t kMostParts = 1'000'000;

bool IsPlace(const Vector3f& point_m) {
  return point_m.allFinite() && point_m.cwiseAbs().maxCoeff() <= kFarthest_m;
}

/// A colour or radiance.
bool IsLight(const Vector3f& color) {
  return color.allFinite() && color.minCoeff() >= 0 && color.maxCoeff() <= 1000;
}

Status CheckMaterial(const Material& material, std::size_t index) {
  if (!IsLight(material.color) || !IsLight(material.second)) {
    return Fail("stage: material {}: a colour is not between 0 and 1000", index);
  }
  if (!(material.scale_m > 0 && material.scale_m <= kFarthest_m)) {
    return Fail("stage: material {}: scale_m is {}; it must be above 0 and at most 10000", index,
                material.scale_m);
  }
  if (!(material.gloss >= 0 && material.gloss <= 1)) {
    return Fail("stage: material {}: gloss is {}; it must be between 0 and 1", index,
                material.gloss);
  }
  if (!(material.roughness_rad >= 0 && material.roughness_rad <= 0.5F)) {
    return Fail("stage: material {}: roughness_rad is {}; it must be between 0 and 0.5", index,
                material.roughness_rad);
  }
  return {};
}

Status CheckMaterialIndex(const Stage& stage, const std::string& owner, MaterialIndex index) {
  if (index >= 0 && static_cast<std::size_t>(index) < stage.materials.size()) return {};
  return Fail("{}: material {} is out of range; there are {}", owner, index,
              stage.materials.size());
}

Status CheckParts(const Stage& stage, const std::string& owner, std::span<const Limb> limbs,
                  std::span<const Block> blocks) {
  if (limbs.size() + blocks.size() > kMostParts) {
    return Fail("{}: {} limbs and blocks; at most {} are allowed", owner,
                limbs.size() + blocks.size(), kMostParts);
  }
  for (const Limb& limb : limbs) {
    VANTAGE_RETURN_IF_ERROR(CheckMaterialIndex(stage, owner, limb.material));
    if (!IsPlace(limb.a_m) || !IsPlace(limb.b_m)) {
      return Fail("{}: a limb's end is not a place within 10 km", owner);
    }
    if (!(limb.a_radius_m > 0 && limb.a_radius_m <= kFarthest_m) ||
        !(limb.b_radius_m > 0 && limb.b_radius_m <= kFarthest_m)) {
      return Fail("{}: a limb's radii are {} and {} m; they must be above 0 and at most 10 km",
                  owner, limb.a_radius_m, limb.b_radius_m);
    }
  }
  for (const Block& block : blocks) {
    VANTAGE_RETURN_IF_ERROR(CheckMaterialIndex(stage, owner, block.material));
    if (!IsPlace(block.center_m) || !std::isfinite(block.yaw_rad)) {
      return Fail("{}: a block's centre or yaw is not a finite number within 10 km", owner);
    }
    if (!IsPlace(block.half_m) || block.half_m.minCoeff() < 0) {
      return Fail("{}: half of a block's side is not between 0 and 10 km", owner);
    }
  }
  return {};
}

Status CheckLamp(const Lamp& lamp, std::size_t index) {
  if (!IsLight(lamp.color)) return Fail("stage: lamp {}: its colour is not 0 to 1000", index);
  if (!IsPlace(lamp.center_m) || !IsPlace(lamp.half_u_m) || !IsPlace(lamp.half_v_m)) {
    return Fail("stage: lamp {}: it is not within 10 km", index);
  }
  if (!(lamp.center_m.z() > 0)) {
    return Fail("stage: lamp {}: it is at a height of {} m; it must be above the ground", index,
                lamp.center_m.z());
  }
  if (!(lamp.half_u_m.norm() > 0 && lamp.half_v_m.norm() > 0)) {
    return Fail("stage: lamp {}: a side has no length", index);
  }
  return {};
}

Status CheckCamera(const StageCamera& camera) {
  if (!(camera.exposure > 0 && camera.exposure <= 1000)) {
    return Fail("stage: camera {}: exposure is {}; it must be above 0 and at most 1000",
                camera.name, camera.exposure);
  }
  if (!IsLight(camera.balance)) {
    return Fail("stage: camera {}: the balance is not between 0 and 1000", camera.name);
  }
  if (!(camera.noise >= 0 && camera.noise <= 1)) {
    return Fail("stage: camera {}: noise is {}; it must be between 0 and 1", camera.name,
                camera.noise);
  }
  if (!(camera.vignetting >= 0 && camera.vignetting <= 1)) {
    return Fail("stage: camera {}: vignetting is {}; it must be between 0 and 1", camera.name,
                camera.vignetting);
  }
  return {};
}

}  // namespace

Status CheckStage(const Stage& stage) {
  if (stage.cameras.empty()) return Fail("stage: no camera; one at least is needed");
  if (stage.cameras.size() > kMostCameras) {
    return Fail("stage: {} cameras; at most {} are allowed", stage.cameras.size(), kMostCameras);
  }
  if (!stage.script) return Fail("stage: no script");
  if (stage.lighting.lamps.size() > kMostLamps) {
    return Fail("stage: {} lamps; at most {} are allowed", stage.lighting.lamps.size(), kMostLamps);
  }
  if (!IsLight(stage.lighting.ambient) || !IsLight(stage.lighting.sky)) {
    return Fail("stage: the ambient light or the sky is not between 0 and 1000");
  }
  for (std::size_t i = 0; i < stage.lighting.lamps.size(); ++i) {
    VANTAGE_RETURN_IF_ERROR(CheckLamp(stage.lighting.lamps[i], i));
  }
  for (std::size_t i = 0; i < stage.materials.size(); ++i) {
    VANTAGE_RETURN_IF_ERROR(CheckMaterial(stage.materials[i], i));
  }
  for (const StageCamera& camera : stage.cameras) VANTAGE_RETURN_IF_ERROR(CheckCamera(camera));
  return CheckParts(stage, "stage", stage.limbs, stage.blocks);
}

Status CheckThings(const Stage& stage, FrameIndex frame, std::span<const Thing> things) {
  if (things.size() > kMostThings) {
    return Fail("frame {}: {} things; at most {} are allowed", frame, things.size(), kMostThings);
  }
  int last = 0;
  for (const Thing& thing : things) {
    if (thing.id <= last) {
      return Fail("frame {}: thing {} follows {}; ids must ascend from 1", frame, thing.id, last);
    }
    last = thing.id;
    VANTAGE_RETURN_IF_ERROR(CheckParts(stage, fmt::format("frame {}: thing {}", frame, thing.id),
                                       thing.limbs, thing.blocks));
  }
  return {};
}

Status CheckGains(const Stage& stage, FrameIndex frame, std::span<const float> gains) {
  const std::size_t groups = 1 + stage.lighting.lamps.size();
  if (gains.size() != groups) {
    return Fail("frame {}: {} gains for {} groups of light", frame, gains.size(), groups);
  }
  for (const float gain : gains) {
    if (!(gain >= 0 && gain <= 1000)) {
      return Fail("frame {}: a gain is {}; it must be between 0 and 1000", frame, gain);
    }
  }
  return {};
}

}  // namespace vantage::simulation::internal
