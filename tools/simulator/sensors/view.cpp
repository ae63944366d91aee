// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/view.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::simulator {

using Eigen::Vector3d;

namespace {

/// From the world into the frame of where somebody stands.
Vector3d into(const Placement& stand, const Vector3d& p) {
  const double c = std::cos(stand.yaw), s = std::sin(stand.yaw);
  const double x = p.x() - stand.x, y = p.y() - stand.y;
  return {c * x + s * y, c * y - s * x, p.z() - stand.z};
}

/// Goes on behind clear glass. `s` gets the light that comes through; the distance of the nearest pane.
double look_through(const Tracer& tracer, const Ray& ray, Surface& surface, Sighting& s) {
  constexpr int kMostPanes = 4;
  constexpr double kBehind = 1e-4;  // m
  const double nearest = surface.distance;
  for (int pane = 0; pane < kMostPanes && std::isfinite(surface.distance); ++pane) {
    const double through = transmission(surface.material, std::abs(surface.normal.dot(ray.direction)));
    if (through == 0) break;
    if (pane == 0) s.pane = surface.normal;
    s.through *= through;
    const double gone = surface.distance + kBehind;
    tracer.trace(ray.origin + gone * ray.direction, {&ray.direction, 1}, kSight, {&surface, 1});
    surface.distance += gone;
  }
  return nearest;
}

}  // namespace

Vector3d Lens::direction(int u, int v) const {
  return Vector3d(1.0, -(u + 0.5 - cx) / fx, -(v + 0.5 - cy) / fy).normalized();
}

bool Instant::sunlit(const Vector3d& from, const Vector3d& normal, const Vector3d& sun) const {
  const Ray ray{from + 2e-3 * normal, sun};
  return !tracer.blocked(ray.origin, sun, kSight) && !trace(people, ray, kSight);
}

void look(const Instant& instant, const Lens& lens, const SE3& T_world_camera, int row, std::span<Sighting> out,
          ClearGlass glass) {
  const Vector3d eye = T_world_camera.translation();
  const Eigen::Matrix3d turn = T_world_camera.quaternion().toRotationMatrix();
  std::vector<Vector3d> directions(out.size());
  for (std::size_t u = 0; u < out.size(); ++u) directions[u] = turn * lens.direction(static_cast<int>(u), row);
  std::vector<Surface> surfaces(out.size());
  instant.tracer.trace(eye, directions, kSight, surfaces);
  for (std::size_t u = 0; u < out.size(); ++u) {
    Sighting& s = out[u];
    s = {.direction = directions[u], .point = eye, .pattern = eye};
    const double pane = glass == ClearGlass::kClear ? look_through(instant.tracer, {eye, directions[u]}, surfaces[u], s)
                                                    : surfaces[u].distance;
    s.distance = surfaces[u].distance;
    s.normal = surfaces[u].normal;
    s.material = surfaces[u].material;
    const auto body = trace(instant.people, {eye, directions[u]}, std::min(s.distance, kSight));
    if (body && body->distance < pane) s.through = 1;
    if (body) {
      s.distance = body->distance;
      s.normal = body->normal;
      s.material = body->part->material;
      s.person = body->figure->person;
    }
    if (s.sky()) continue;
    s.point = eye + s.distance * s.direction;
    s.pattern = body ? into(body->figure->stand, s.point) : s.point;
  }
}

}  // namespace cairn::simulator
