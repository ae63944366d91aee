// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/style.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr std::uint64_t kBumpStream = 91, kGaitStream = 92;
constexpr double kKnot_s = to_seconds(Trajectory::kKnotPeriod);
constexpr double kCalm_s = 1.0;  // before it nothing shakes, as the robot rests

/// m/s at knot i, over a tenth of a second to each side: what shakes a body follows its speed smoothly.
double speed_at(const std::vector<Vector6>& knots, std::size_t i) {
  constexpr std::size_t kSpan = 10;
  const std::size_t before = i < kSpan ? 0 : i - kSpan, after = std::min(i + kSpan, knots.size() - 1);
  return (knots[after] - knots[before]).head<2>().norm() / (kKnot_s * static_cast<double>(after - before));
}

/// Adds one bump that begins at knot `first`: sin², so that it begins and ends at rest.
void add_bump(std::vector<Vector6>& knots, std::size_t first, double share, const Bumps& bumps, Random& random) {
  const double pitch = share * bumps.pitch_rad * random.uniform(-1, 1);
  const double roll = share * bumps.roll_rad * random.uniform(-1, 1);
  const double height = share * bumps.height_m * random.uniform(0, 1);
  const auto count = static_cast<std::size_t>(bumps.duration_s / kKnot_s);
  for (std::size_t k = 0; k <= count && first + k < knots.size(); ++k) {
    const double s = std::sin(std::numbers::pi * static_cast<double>(k) / static_cast<double>(count));
    knots[first + k].segment<3>(2) += s * s * Eigen::Vector3d(height, roll, pitch);
  }
}

void add_bumps(std::vector<Vector6>& knots, const std::vector<Vector6>& smooth, const MotionStyle& style,
               std::uint64_t seed) {
  Random random(seed, kBumpStream);
  const auto shortest = static_cast<std::size_t>(style.bumps.duration_s / kKnot_s);
  auto at = static_cast<std::size_t>(kCalm_s / kKnot_s);
  while (true) {
    at += shortest + static_cast<std::size_t>(-std::log(1.0 - random.uniform()) * style.bumps.every_s / kKnot_s);
    if (at >= knots.size()) return;
    add_bump(knots, at, std::min(1.0, speed_at(smooth, at) / style.limits.speed), style.bumps, random);
  }
}

/// What a hand adds at `t` seconds, walking at `walk` (1: 1 m/s): along x, y, z, roll, pitch, yaw of the body.
Vector6 carried(const Gait& gait, double t, double walk, double phase) {
  const double step = kTwoPi * gait.steps_hz * t + phase, stride = 0.5 * step;
  const double ready = std::clamp(t - kCalm_s, 0.0, 1.0);
  const double look = ready * std::sin(kTwoPi * 0.31 * (t - kCalm_s)), tilt = kTwoPi * 0.17 * (t - kCalm_s);
  Vector6 added;
  added << 0, walk * gait.sway_m * std::sin(stride), gait.carried_m + walk * gait.bob_m * std::sin(step),
      walk * gait.roll_rad * std::sin(stride + 0.6) + ready * gait.look_tilt_rad * std::sin(tilt),
      walk * gait.nod_rad * std::sin(step + 1.1) + ready * gait.look_tilt_rad * std::sin(1.3 * tilt),
      gait.look_yaw_rad * look;
  return added;
}

void carry(std::vector<Vector6>& knots, const Gait& gait, std::uint64_t seed) {
  const double phase = Random(seed, kGaitStream).uniform(0, kTwoPi);
  const std::vector<Vector6> smooth = knots;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const double t = kKnot_s * static_cast<double>(i), yaw = smooth[i][5];
    Vector6 added = carried(gait, t, std::min(1.5, speed_at(smooth, i)), phase);
    added.head<2>() = added.y() * Eigen::Vector2d(-std::sin(yaw), std::cos(yaw));
    knots[i] += added;
  }
}

}  // namespace

Motion motion_of(std::string_view name) {
  return static_cast<Motion>(std::ranges::find(kMotions, name) - kMotions.begin());
}

MotionStyle style_of(Motion motion) {
  MotionStyle style;
  switch (motion) {
    case Motion::kGentle:
      break;
    case Motion::kBrisk:
      style.limits = {.speed = 2.0, .acceleration = 2.0, .yaw_rate = 1.75, .yaw_acceleration = 9.0};
      style.bumps = {.every_s = 3, .pitch_rad = 0.02, .roll_rad = 0.02, .height_m = 0.01, .duration_s = 0.25};
      break;
    case Motion::kAggressive:
      style.limits = {.speed = 3.0, .acceleration = 4.0, .yaw_rate = 2.33, .yaw_acceleration = 23.0};
      style.stops = {.every_s = 10, .rest_s = 1.0, .braking = 6.0};
      style.bumps = {.every_s = 1.5, .pitch_rad = 0.07, .roll_rad = 0.06, .height_m = 0.03, .duration_s = 0.2};
      break;
    case Motion::kHandheld:
      style.limits = {.speed = 1.4, .acceleration = 2.0, .yaw_rate = 2.0, .yaw_acceleration = 8.0};
      style.gait.carried_m = 0.8;
      break;
  }
  return style;
}

Trajectory shaken(const Trajectory& smooth, const MotionStyle& style, std::uint64_t seed) {
  std::vector<Vector6> knots = smooth.knots();
  if (style.bumps.every_s > 0) add_bumps(knots, smooth.knots(), style, seed);
  if (style.gait.carried_m > 0) carry(knots, style.gait, seed);
  return {smooth.start(), std::move(knots)};
}

}  // namespace cairn::simulator
