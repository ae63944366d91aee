// SPDX-License-Identifier: Apache-2.0
#include "tests/support/box_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cairn::support {
namespace {

constexpr double kEpsilon = 1e-6;  // m
constexpr double kNone = std::numeric_limits<double>::infinity();

double hit(const World::Box& b, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  double enter = -kNone, leave = kNone;
  for (int k = 0; k < 3; ++k) {
    const double inverse = 1.0 / d[k];
    const double a = (b.low[k] - o[k]) * inverse, c = (b.high[k] - o[k]) * inverse;
    enter = std::max(enter, std::min(a, c));
    leave = std::min(leave, std::max(a, c));
  }
  if (enter > leave || leave < kEpsilon) return kNone;
  return enter > kEpsilon ? enter : leave;
}

double hit(const World::Trunk& t, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  const double x = o.x() - t.x, y = o.y() - t.y;
  const double a = d.x() * d.x() + d.y() * d.y(), b = x * d.x() + y * d.y();
  const double discriminant = b * b - a * (x * x + y * y - t.radius * t.radius);
  if (discriminant < 0 || a == 0) return kNone;
  const double s = (-b - std::sqrt(discriminant)) / a;
  return s > kEpsilon ? s : kNone;
}

}  // namespace

double World::cast(const Eigen::Vector3d& o, const Eigen::Vector3d& d) const {
  double nearest = kNone;
  for (const Box& b : boxes_) nearest = std::min(nearest, hit(b, o, d));
  for (const Trunk& t : trunks_) nearest = std::min(nearest, hit(t, o, d));
  for (const Plane& p : planes_) {
    const double t = (p.offset - p.normal.dot(o)) / p.normal.dot(d);
    if (t > kEpsilon) nearest = std::min(nearest, t);
  }
  return nearest;
}

Scan Vlp16::scan(const World& world, const Path& path, double start_s) {
  Scan out;
  out.valid = {Time{from_seconds(start_s)}, Time{from_seconds(start_s + kScanSeconds)}};
  out.cloud.reserve(kRings * kFirings);
  for (int firing = 0; firing < kFirings; ++firing) {
    const double offset = firing * kFiringSeconds;
    const SE3 T_world_lidar = path(start_s + offset) * T_base_lidar_;
    const double azimuth = std::numbers::pi - 2 * std::numbers::pi * firing / kFirings;
    for (int ring = 0; ring < kRings; ++ring) shoot(world, T_world_lidar, azimuth, ring, offset, out.cloud);
  }
  return out;
}

void Vlp16::shoot(const World& world, const SE3& T_world_lidar, double azimuth, int ring, double offset,
                  PointCloud& cloud) {
  const double elevation = (2.0 * ring - 15.0) * std::numbers::pi / 180.0;
  const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                          std::sin(elevation));
  const double range = world.cast(T_world_lidar.translation(), T_world_lidar.rotation() * d);
  if (!(range < 100.0)) return;
  const double measured = range + (noisy_ ? noise_(random_) : 0.0);
  const auto ns = static_cast<std::uint32_t>(1e9 * (offset + ring * kLaserSeconds));
  cloud.push_back((measured * d).cast<float>(), 100.0F, ns, static_cast<std::uint8_t>(ring), ReturnType::kStrongest);
}

}  // namespace cairn::support
