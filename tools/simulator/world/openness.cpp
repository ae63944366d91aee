// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/openness.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace cairn::simulator {
namespace {

using Eigen::Vector3d;

using Known = std::function<bool(const Vector3d&)>;

constexpr double kOpen_m = 0.3, kLift_m = 1e-3;  // far beyond a coat of paint; off the surface itself
constexpr int kAround = 4;                       // directions at 45° to the normal, beside the normal itself

double openness_of_side(const Tracer& tracer, const Vector3d& p, const Vector3d& normal, const Known& known) {
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u), from = p + kLift_m * normal;
  const auto open = [&](const Vector3d& direction) {
    return known(from + kOpen_m * direction) && !tracer.blocked(from, direction, kOpen_m);
  };
  int count = open(normal) ? 1 : 0;
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / kAround;
    count += open((normal + std::cos(angle) * u + std::sin(angle) * v).normalized()) ? 1 : 0;
  }
  return static_cast<double>(count) / (kAround + 1);
}

}  // namespace

double openness(const Tracer& tracer, const Vector3d& p, const Vector3d& normal, const Known& known) {
  return std::max(openness_of_side(tracer, p, normal, known), openness_of_side(tracer, p, -normal, known));
}

}  // namespace cairn::simulator
