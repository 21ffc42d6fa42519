// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/simulation/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "vantage/base/parallel.h"

namespace vantage::simulation::internal {
namespace {

using Eigen::Vector3f;

const char* ErrorName(RTCError error) {
  switch (error) {
    case RTC_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "this processor is not supported (it needs SSE2)";
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_CANCELLED:
      return "cancelled";
    default:
      return "unknown error";
  }
}

struct Sphere {
  Vector3f center;
  float radius;
};

/// A limb whose one end lies within the other is that other end alone; Embree's cones need two.
bool IsSphere(const Limb& limb, Sphere& sphere) {
  const float length = (limb.b_m - limb.a_m).norm();
  if (length > std::abs(limb.a_radius_m - limb.b_radius_m) + 1e-4F) return false;
  const bool a = limb.a_radius_m >= limb.b_radius_m;
  sphere = a ? Sphere{limb.a_m, limb.a_radius_m} : Sphere{limb.b_m, limb.b_radius_m};
  return true;
}

void Store(float* vertex, const Vector3f& point, float radius) {
  vertex[0] = point.x();
  vertex[1] = point.y();
  vertex[2] = point.z();
  vertex[3] = radius;
}

template <class T>
T* NewBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t width,
             std::size_t count) {
  return static_cast<T*>(
      rtcSetNewGeometryBuffer(geometry, type, 0, format, width * sizeof(T), count));
}

constexpr std::size_t kTriangles = 12;  // of a block
// Two triangles a face, corners as BlockCorners numbers them.
constexpr std::array<std::array<unsigned, 3>, kTriangles> kFaces = {{{0, 1, 3},
                                                                     {0, 3, 2},
                                                                     {4, 5, 7},
                                                                     {4, 7, 6},
                                                                     {0, 1, 5},
                                                                     {0, 5, 4},
                                                                     {2, 3, 7},
                                                                     {2, 7, 6},
                                                                     {0, 2, 6},
                                                                     {0, 6, 4},
                                                                     {1, 3, 7},
                                                                     {1, 7, 5}}};

Geometry CurvesOf(RTCDevice device, std::span<const Limb> limbs,
                  const std::vector<std::uint32_t>& parts) {
  Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE));
  auto* vertices = NewBuffer<float>(geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4,
                                    2 * parts.size());
  auto* indices =
      NewBuffer<unsigned>(geometry.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, 1, parts.size());
  if (vertices == nullptr || indices == nullptr) return nullptr;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Limb& limb = limbs[parts[i] - 1];
    Store(vertices + 8 * i, limb.a_m, limb.a_radius_m);
    Store(vertices + 8 * i + 4, limb.b_m, limb.b_radius_m);
    indices[i] = static_cast<unsigned>(2 * i);
  }
  return geometry;
}

Geometry SpheresOf(RTCDevice device, const std::vector<Sphere>& spheres) {
  Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT));
  auto* vertices = NewBuffer<float>(geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4,
                                    spheres.size());
  if (vertices == nullptr) return nullptr;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    Store(vertices + 4 * i, spheres[i].center, spheres[i].radius);
  }
  return geometry;
}

Geometry TrianglesOf(RTCDevice device, std::span<const Block> blocks) {
  Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* vertices = NewBuffer<float>(geometry.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3,
                                    8 * blocks.size());
  auto* indices = NewBuffer<unsigned>(geometry.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3,
                                      kTriangles * blocks.size());
  if (vertices == nullptr || indices == nullptr) return nullptr;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const std::array<Vector3f, 8> corners = BlockCorners(blocks[i]);
    for (std::size_t corner = 0; corner < 8; ++corner) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) *vertices++ = corners[corner][axis];
    }
    for (const auto& triangle : kFaces) {
      for (const unsigned corner : triangle) *indices++ = static_cast<unsigned>(8 * i) + corner;
    }
  }
  return geometry;
}

RTCRay MakeRay(const Ray& ray) {
  RTCRay made;
  made.org_x = ray.origin_m.x();
  made.org_y = ray.origin_m.y();
  made.org_z = ray.origin_m.z();
  made.dir_x = ray.direction.x();
  made.dir_y = ray.direction.y();
  made.dir_z = ray.direction.z();
  made.tnear = 0;
  made.tfar = ray.far_m;
  made.time = 0;
  made.mask = ~0U;
  made.id = 0;
  made.flags = 0;
  return made;
}

Result<Scene> NewScene(RTCDevice device) {
  Scene scene(rtcNewScene(device));
  if (!scene) {
    VANTAGE_RETURN_IF_ERROR(CheckDevice(device));
    return Fail("Embree: no scene");
  }
  // Robust: whether a ray meets a surface must not depend on how the others are sorted around it.
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  return scene;
}

}  // namespace

Result<Device> MakeDevice(int threads) {
  // Embree limits all of the process's use of oneTBB to its own number of threads.
  const std::string config =
      fmt::format("threads={},set_affinity=0", std::max(threads, HardwareThreads()));
  Device device(rtcNewDevice(config.c_str()));
  if (!device) return Fail("Embree: no device: {}", ErrorName(rtcGetDeviceError(nullptr)));
  return device;
}

Status CheckDevice(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return {};
  return Fail("Embree: {}", ErrorName(error));
}

Result<Solid> Solid::Build(RTCDevice device, std::span<const Limb> limbs,
                           std::span<const Block> blocks) {
  Solid solid;
  VANTAGE_ASSIGN_OR_RETURN(solid.scene_, NewScene(device));
  std::vector<std::uint32_t> cone_parts;
  std::vector<std::uint32_t> sphere_parts;
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < limbs.size(); ++i) {
    const auto part = static_cast<std::uint32_t>(1 + i);
    if (Sphere sphere; IsSphere(limbs[i], sphere)) {
      sphere_parts.push_back(part);
      spheres.push_back(sphere);
    } else {
      cone_parts.push_back(part);
    }
  }
  std::vector<std::uint32_t> triangle_parts;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    triangle_parts.insert(triangle_parts.end(), kTriangles,
                          static_cast<std::uint32_t>(1 + limbs.size() + i));
  }
  const auto add = [&](auto make, std::vector<std::uint32_t>& parts) -> Status {
    if (parts.empty()) return {};
    Geometry geometry = make();
    if (!geometry) {
      VANTAGE_RETURN_IF_ERROR(CheckDevice(device));
      return Fail("Embree: no geometry");
    }
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(solid.scene_.get(), geometry.get(),
                          static_cast<unsigned>(solid.geometries_.size()));
    solid.geometries_.push_back(std::move(geometry));
    solid.part_of_primitive_.push_back(std::move(parts));
    return {};
  };
  VANTAGE_RETURN_IF_ERROR(add([&] { return CurvesOf(device, limbs, cone_parts); }, cone_parts));
  VANTAGE_RETURN_IF_ERROR(add([&] { return SpheresOf(device, spheres); }, sphere_parts));
  VANTAGE_RETURN_IF_ERROR(add([&] { return TrianglesOf(device, blocks); }, triangle_parts));
  rtcCommitScene(solid.scene_.get());
  VANTAGE_RETURN_IF_ERROR(CheckDevice(device));
  return solid;
}

Hit Solid::Trace(const Ray& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query;
  query.ray = MakeRay(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  Hit hit;
  hit.t_m = query.ray.tfar;
  hit.part = part_of_primitive_[query.hit.geomID][query.hit.primID];
  hit.normal = Vector3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized();
  if (hit.normal.dot(ray.direction) > 0) hit.normal = -hit.normal;
  return hit;
}

bool Solid::Blocks(const Ray& ray) const { return IsBlocked(scene_.get(), ray); }

Result<Scene> JoinSolids(RTCDevice device, std::span<const Solid* const> solids) {
  VANTAGE_ASSIGN_OR_RETURN(Scene scene, NewScene(device));
  for (const Solid* solid : solids) {
    for (const Geometry& geometry : solid->geometries()) {
      rtcAttachGeometry(scene.get(), geometry.get());
    }
  }
  rtcCommitScene(scene.get());
  VANTAGE_RETURN_IF_ERROR(CheckDevice(device));
  return scene;
}

bool IsBlocked(RTCScene scene, const Ray& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay query = MakeRay(ray);
  rtcOccluded1(scene, &context, &query);
  return query.tfar < 0;
}

std::uint32_t BlockedRays(RTCScene scene, std::span<const Ray> rays) {
  constexpr std::size_t kLanes = 8;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  std::uint32_t blocked = 0;
  for (std::size_t first = 0; first < rays.size(); first += kLanes) {
    RTCRay8 query;
    alignas(32) std::array<int, kLanes> valid = {};
    const std::size_t count = std::min(kLanes, rays.size() - first);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const Ray& ray = rays[first + std::min(i, count - 1)];
      valid[i] = i < count ? -1 : 0;
      query.org_x[i] = ray.origin_m.x();
      query.org_y[i] = ray.origin_m.y();
      query.org_z[i] = ray.origin_m.z();
      query.dir_x[i] = ray.direction.x();
      query.dir_y[i] = ray.direction.y();
      query.dir_z[i] = ray.direction.z();
      query.tnear[i] = 0;
      query.tfar[i] = ray.far_m;
      query.time[i] = 0;
      query.mask[i] = ~0U;
      query.id[i] = 0;
      query.flags[i] = 0;
    }
    rtcOccluded8(valid.data(), scene, &context, &query);
    for (std::size_t i = 0; i < count; ++i) {
      if (query.tfar[i] < 0) blocked |= 1U << (first + i);
    }
  }
  return blocked;
}

std::array<Vector3f, 8> BlockCorners(const Block& block) {
  const float c = std::cos(block.yaw_rad);
  const float s = std::sin(block.yaw_rad);
  std::array<Vector3f, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const float x = (i & 1U) != 0 ? block.half_m.x() : -block.half_m.x();
    const float y = (i & 2U) != 0 ? block.half_m.y() : -block.half_m.y();
    const float z = (i & 4U) != 0 ? block.half_m.z() : -block.half_m.z();
    corners[i] = block.center_m + Vector3f(c * x - s * y, s * x + c * y, z);
  }
  return corners;
}

Eigen::AlignedBox3f BoundsOf(std::span<const Limb> limbs, std::span<const Block> blocks) {
  Eigen::AlignedBox3f bounds;
  for (const Limb& limb : limbs) {
    bounds.extend(Vector3f(limb.a_m.array() - limb.a_radius_m));
    bounds.extend(Vector3f(limb.a_m.array() + limb.a_radius_m));
    bounds.extend(Vector3f(limb.b_m.array() - limb.b_radius_m));
    bounds.extend(Vector3f(limb.b_m.array() + limb.b_radius_m));
  }
  for (const Block& block : blocks) {
    for (const Vector3f& corner : BlockCorners(block)) bounds.extend(corner);
  }
  return bounds;
}

}  // namespace vantage::simulation::internal
