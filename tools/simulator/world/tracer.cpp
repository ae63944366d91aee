// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/tracer.hpp"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace cairn::simulator {

using Eigen::Vector3d;

struct Tracer::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

void Tracer::Release::operator()(Embree* embree) const {
  if (embree->scene != nullptr) rtcReleaseScene(embree->scene);
  if (embree->device != nullptr) rtcReleaseDevice(embree->device);
  delete embree;
}

namespace {

Error out_of_memory() { return {Errc::kLimit, "the ray tracer ran out of memory", "simulator"}; }

/// Vertices are not shared: triangle i has the vertices 3i, 3i+1, 3i+2.
bool attach(RTCDevice device, RTCScene scene, const std::vector<Triangle>& triangles) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), 3 * triangles.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), triangles.size()));
  if (vertices == nullptr || indices == nullptr) {
    rtcReleaseGeometry(geometry);
    return false;
  }
  unsigned index = 0;
  for (const Triangle& t : triangles) {
    for (const Eigen::Vector3f* corner : {&t.a, &t.b, &t.c}) {
      std::memcpy(vertices, corner->data(), 3 * sizeof(float));
      vertices += 3;
      *indices++ = index++;
    }
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  return true;
}

/// Where the ray meets the triangle's plane. Embree has decided that it is inside the triangle.
Hit meet(const Ray& ray, const Triangle& t) {
  const Vector3d a = t.a.cast<double>();
  const Vector3d normal = (t.b.cast<double>() - a).cross(t.c.cast<double>() - a).normalized();
  const double cosine = normal.dot(ray.direction);
  return {normal.dot(a - ray.origin) / cosine, std::abs(cosine), t.material};
}

void load(RTCRayHit4& query, std::size_t i, const Vector3d& origin, const Vector3d& direction, double max_distance) {
  query.ray.org_x[i] = static_cast<float>(origin.x());
  query.ray.org_y[i] = static_cast<float>(origin.y());
  query.ray.org_z[i] = static_cast<float>(origin.z());
  query.ray.dir_x[i] = static_cast<float>(direction.x());
  query.ray.dir_y[i] = static_cast<float>(direction.y());
  query.ray.dir_z[i] = static_cast<float>(direction.z());
  query.ray.tnear[i] = 1e-3F;
  query.ray.tfar[i] = static_cast<float>(max_distance);
  query.ray.mask[i] = ~0U;
  query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
}

/// As meet() has it; where that is ill-conditioned, Embree's distance.
Surface surface(const Ray& ray, const Triangle& t, double embree_distance) {
  const Vector3d a = t.a.cast<double>();
  const Vector3d normal = (t.b.cast<double>() - a).cross(t.c.cast<double>() - a).normalized();
  const double cosine = normal.dot(ray.direction);
  const double distance = normal.dot(a - ray.origin) / cosine;
  const bool sound = std::abs(distance - embree_distance) <= 1e-2 * distance + 1e-3;
  return {sound ? distance : embree_distance, cosine > 0 ? Vector3d(-normal) : normal, t.material};
}

}  // namespace

Tracer::Tracer(std::unique_ptr<Embree, Release> embree, std::vector<Triangle> triangles)
    : embree_(std::move(embree)), triangles_(std::move(triangles)) {}

Result<Tracer> Tracer::build(const Mesh& mesh) {
  std::unique_ptr<Embree, Release> embree(new Embree);
  // One instruction set and the robust (Plücker) test on every machine: the same triangle is found everywhere.
  embree->device = rtcNewDevice("isa=sse4.2,max_isa=sse4.2,threads=1,set_affinity=0");
  if (embree->device == nullptr) return Error{Errc::kUnsupported, "Embree does not start here", "simulator"};
  embree->scene = rtcNewScene(embree->device);
  rtcSetSceneFlags(embree->scene, RTC_SCENE_FLAG_ROBUST);
  if (!attach(embree->device, embree->scene, mesh.triangles())) return out_of_memory();
  rtcCommitScene(embree->scene);
  if (rtcGetDeviceError(embree->device) != RTC_ERROR_NONE) return out_of_memory();
  return Tracer(std::move(embree), mesh.triangles());
}

std::optional<Hit> Tracer::trace(const Ray& ray, double min_distance, double max_distance) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray.org_x = static_cast<float>(ray.origin.x());
  query.ray.org_y = static_cast<float>(ray.origin.y());
  query.ray.org_z = static_cast<float>(ray.origin.z());
  query.ray.dir_x = static_cast<float>(ray.direction.x());
  query.ray.dir_y = static_cast<float>(ray.direction.y());
  query.ray.dir_z = static_cast<float>(ray.direction.z());
  query.ray.tnear = static_cast<float>(min_distance);
  query.ray.tfar = static_cast<float>(max_distance);
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const Hit hit = meet(ray, triangles_[query.hit.primID]);
  // At grazing incidence the plane's distance is ill-conditioned; trust it only where both agree.
  if (!(std::abs(hit.distance - static_cast<double>(query.ray.tfar)) <= 1e-2 * hit.distance + 1e-3))
    return std::nullopt;
  return hit;
}

void Tracer::trace(const Vector3d& origin, std::span<const Vector3d> directions, double max_distance,
                   std::span<Surface> out) const {
  constexpr std::size_t kPacket = 4;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (std::size_t first = 0; first < directions.size(); first += kPacket) {
    const std::size_t count = std::min(kPacket, directions.size() - first);
    alignas(16) std::array<int, kPacket> valid{};
    RTCRayHit4 query{};
    for (std::size_t i = 0; i < count; ++i) {
      valid[i] = -1;
      load(query, i, origin, directions[first + i], max_distance);
    }
    rtcIntersect4(valid.data(), embree_->scene, &context, &query);
    for (std::size_t i = 0; i < count; ++i) {
      out[first + i] = {};
      if (query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      out[first + i] = surface({origin, directions[first + i]}, triangles_[query.hit.primID[i]],
                               static_cast<double>(query.ray.tfar[i]));
    }
  }
}

bool Tracer::blocked(const Vector3d& from, const Vector3d& direction, double max_distance) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  ray.org_x = static_cast<float>(from.x());
  ray.org_y = static_cast<float>(from.y());
  ray.org_z = static_cast<float>(from.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tfar = static_cast<float>(max_distance);
  ray.mask = ~0U;
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar < 0;
}

}  // namespace cairn::simulator
