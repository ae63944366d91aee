// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <vector>

#include "hal/time.hpp"

// A yard that can be computed by hand: flat ground, a wall 12 m ahead, a pole, people as upright cylinders, legs as
// thin ones.
namespace cairn::people::test {

using Eigen::Vector2d;
using Eigen::Vector3f;

inline constexpr Duration kScan = std::chrono::milliseconds(100);
inline constexpr double kSensorHeight = 0.6, kPersonRadius = 0.22, kPersonHeight = 1.75;

struct Cylinder {
  Vector2d place{0, 0};
  double radius = kPersonRadius, height = kPersonHeight, bottom = 0;
};

inline Cylinder leg(const Vector2d& place) { return {place, 0.07, 0.6}; }

/// Hangs before what is behind it, but for its legs.
inline Cylinder screen(const Vector2d& place, double radius) { return {place, radius, 2.2, 0.65}; }

/// Distance along a ray of unit length to the cylinder's side; infinite: it passes.
inline double meet(const Cylinder& body, const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) {
  const Vector2d d = ray.head<2>(), o = eye.head<2>() - body.place;
  const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - body.radius * body.radius;
  const double root = b * b - a * c;
  if (root < 0 || a < 1e-9) return std::numeric_limits<double>::infinity();
  const double t = (-b - std::sqrt(root)) / a, z = eye.z() + t * ray.z();
  return t > 0 && z > body.bottom && z < body.height ? t : std::numeric_limits<double>::infinity();
}

/// What a LiDAR with 16 rings over the origin sees of it.
inline std::vector<Vector3f> scan_of(const std::vector<Cylinder>& bodies, double wall_x = 12) {
  const Eigen::Vector3d eye(0, 0, kSensorHeight);
  std::vector<Vector3f> points;
  for (int ring = -15; ring <= 15; ring += 2) {
    for (int step = 0; step < 1800; ++step) {
      const double up = ring * M_PI / 180, around = step * M_PI / 900;
      const Eigen::Vector3d ray(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up));
      double t = ray.z() < 0 ? -eye.z() / ray.z() : std::numeric_limits<double>::infinity();
      if (ray.x() > 0 && eye.z() + wall_x / ray.x() * ray.z() < 4) t = std::min(t, wall_x / ray.x());
      for (const Cylinder& body : bodies) t = std::min(t, meet(body, eye, ray));
      if (t < 40) points.push_back((eye + t * ray).cast<float>());
    }
  }
  return points;
}

inline Vector3f sensor() { return {0, 0, static_cast<float>(kSensorHeight)}; }

}  // namespace cairn::people::test
