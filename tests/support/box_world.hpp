// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <random>
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
  [[nodiscard]] double cast(const Eigen::Vector3d& o, const Eigen::Vector3d& d) const;

 private:
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
  Scan scan(const World& world, const Path& path, double start_s);

 private:
  void shoot(const World& world, const SE3& T_world_lidar, double azimuth, int ring, double offset, PointCloud& cloud);

  SE3 T_base_lidar_;
  std::normal_distribution<double> noise_;
  std::mt19937 random_;
  bool noisy_;
};

}  // namespace cairn::support
