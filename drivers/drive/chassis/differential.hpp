// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace cairn::drive {

/// Speeds of the wheels' rims in m/s, forward.
struct WheelSpeeds {
  double left = 0, right = 0;
};
/// Velocity of base_link: m/s forward and rad/s to the left.
struct Velocity {
  double v = 0, w = 0;
};

/// Kinematics of a differential drive (Siegwart, Nourbakhsh, "Introduction to autonomous mobile robots", 3.2).
/// `separation` in metres: of skid steering the effective one.
[[nodiscard]] inline WheelSpeeds wheel_speeds(Velocity body, double separation) {
  return {body.v - body.w * separation / 2, body.v + body.w * separation / 2};
}
/// The inverse.
[[nodiscard]] inline Velocity body_velocity(WheelSpeeds wheels, double separation) {
  return {(wheels.left + wheels.right) / 2, (wheels.right - wheels.left) / separation};
}

/// If one of both is above its limit (m/s, rad/s), both are reduced by one factor, so that the path keeps its
/// curvature. A velocity that is not finite becomes zero.
[[nodiscard]] inline Velocity limited(Velocity wanted, double max_v, double max_w) {
  if (!std::isfinite(wanted.v) || !std::isfinite(wanted.w)) return {};
  double share = 1;
  if (std::abs(wanted.v) > max_v) share = max_v / std::abs(wanted.v);
  if (std::abs(wanted.w) > max_w) share = std::min(share, max_w / std::abs(wanted.w));
  return {wanted.v * share, wanted.w * share};
}

/// Angle in radians, to the left, of the inner front wheel of an Ackermann robot that moves with `body`. It is 0 at
/// rest and at most ±π/2. `wheelbase` and `track` in metres.
[[nodiscard]] inline double inner_steering(Velocity body, double wheelbase, double track) {
  if (std::abs(body.v) < 1e-3 || body.w == 0) return 0;
  const double radius = std::abs(body.v / body.w);
  const double angle = std::atan2(wheelbase, std::max(radius - track / 2, 0.0));
  return (body.w > 0) == (body.v > 0) ? angle : -angle;
}

}  // namespace cairn::drive
