// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "hal/point_cloud.hpp"
#include "hal/se3.hpp"

namespace cairn::support {

/// Worlds whose ray intersections have closed forms, so that every range is exact before noise. Independent of
/// tools/simulator on purpose: two simulators that agree check each other.
class World {
 public:
  /// Axis-aligned; hit from outside and from inside (a room is a box seen from inside).
  struct Box {
    Eigen::Vector3d low, high;
  };
  /// Vertical, infinitely high.
  struct Trunk {
    double x, y, radius;
  };
  /// Points with normal·p = offset.
  struct Plane {
    Eigen::Vector3d normal;
    double offset;
  };

  World& box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    boxes_.push_back({low, high});
    return *this;
  }
  World& trunk(double x, double y, double radius) {
    trunks_.push_back({x, y, radius});
    return *this;
  }
  World& plane(const Eigen::Vector3d& normal, double offset) {
    planes_.push_back({normal.normalized(), offset});
    return *this;
  }

  /// Distance along the unit vector `d` to the nearest surface; infinity when there is none.
  [[nodiscard]] double cast(const Eigen::Vector3d& o, const Eigen::Vector3d& d) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Box& b : boxes_) nearest = std::min(nearest, hit(b, o, d));
    for (const Trunk& t : trunks_) nearest = std::min(nearest, hit(t, o, d));
    for (const Plane& p : planes_) {
      const double t = (p.offset - p.normal.dot(o)) / p.normal.dot(d);
      if (t > kEpsilon) nearest = std::min(nearest, t);
    }
    return nearest;
  }

 private:
  static constexpr double kEpsilon = 1e-6;
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  static double hit(const Box& b, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
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
  static double hit(const Trunk& t, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
    const double x = o.x() - t.x, y = o.y() - t.y;
    const double a = d.x() * d.x() + d.y() * d.y(), b = x * d.x() + y * d.y();
    const double discriminant = b * b - a * (x * x + y * y - t.radius * t.radius);
    if (discriminant < 0 || a == 0) return kNone;
    const double s = (-b - std::sqrt(discriminant)) / a;
    return s > kEpsilon ? s : kNone;
  }

  std::vector<Box> boxes_;
  std::vector<Trunk> trunks_;
  std::vector<Plane> planes_;
};

/// A pose for every time in seconds from the start.
using Path = std::function<SE3(double)>;

/// Sixteen lasers, 0.2° at 10 Hz, fired one after the other while the base moves (VLP-16 user manual, firing sequence).
class Vlp16 {
 public:
  static constexpr int kRings = 16;
  static constexpr int kFirings = 1808;
  static constexpr double kFiringSeconds = 55.296e-6;
  static constexpr double kLaserSeconds = 2.304e-6;
  static constexpr double kScanSeconds = kFirings * kFiringSeconds;

  Vlp16(const SE3& T_base_lidar, double noise_m, unsigned seed)
      : T_base_lidar_(T_base_lidar), noise_(0.0, noise_m), random_(seed), noisy_(noise_m > 0) {}

  /// The revolution that starts at `start_s`, seen by a base on `path`. Hits beyond 100 m are missing, as with the real
  /// one.
  Scan scan(const World& world, const Path& path, double start_s) {
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

 private:
  void shoot(const World& world, const SE3& T_world_lidar, double azimuth, int ring, double offset, PointCloud& cloud) {
    const double elevation = (2.0 * ring - 15.0) * std::numbers::pi / 180.0;
    const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                            std::sin(elevation));
    const double range = world.cast(T_world_lidar.translation(), T_world_lidar.rotation() * d);
    if (!(range < 100.0)) return;
    const double measured = range + (noisy_ ? noise_(random_) : 0.0);
    const auto ns = static_cast<std::uint32_t>(1e9 * (offset + ring * kLaserSeconds));
    cloud.push_back((measured * d).cast<float>(), 100.0F, ns, static_cast<std::uint8_t>(ring), ReturnType::kStrongest);
  }

  SE3 T_base_lidar_;
  std::normal_distribution<double> noise_;
  std::mt19937 random_;
  bool noisy_;
};

}  // namespace cairn::support
