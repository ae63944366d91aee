// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/flight.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

constexpr double kGravity = 9.81;
constexpr double kFreeAir = 0.5;     // m, of free air above and below
constexpr std::size_t kSmooth = 25;  // knots to each side that accelerations are taken over: 0.25 s

/// Acceleration in the world at knot i, from positions kSmooth knots before and after.
Eigen::Vector2d acceleration(const std::vector<Vector6>& knots, std::size_t i) {
  const std::size_t before = i < kSmooth ? 0 : i - kSmooth, after = std::min(i + kSmooth, knots.size() - 1);
  const double dt = to_seconds(Trajectory::kKnotPeriod) * kSmooth;
  return (knots[after] - 2.0 * knots[i] + knots[before]).head<2>() / (dt * dt);
}

/// The mean over kSmooth knots to each side, since a body cannot turn at once.
std::vector<Eigen::Vector2d> smoothed(const std::vector<Eigen::Vector2d>& in) {
  std::vector<Eigen::Vector2d> out(in.size(), Eigen::Vector2d(0, 0));
  for (std::size_t i = 0; i < in.size(); ++i) {
    const std::size_t first = i < kSmooth ? 0 : i - kSmooth, last = std::min(i + kSmooth, in.size() - 1);
    for (std::size_t k = first; k <= last; ++k) out[i] += in[k] / static_cast<double>(last - first + 1);
  }
  return out;
}

}  // namespace

FloorPlan flight_plan(const World& world) {
  return FloorPlan(world, {world.flight.low - kFreeAir, world.flight.high + kFreeAir});
}

Trajectory fly(const World& world, const FloorPlan& plan, const Path& path, Time start, Duration duration,
               const FlightLimits& limits, std::uint64_t seed) {
  std::vector<Vector6> knots = drive(world, plan, path, start, duration, limits.level, seed).knots();
  std::vector<Eigen::Vector2d> lean(knots.size());
  for (std::size_t i = 0; i < knots.size(); ++i) lean[i] = acceleration(knots, i) / kGravity;
  lean = smoothed(lean);
  const double swing = 0.5 * (world.flight.high - world.flight.low);
  const double rate = std::min(limits.climb / std::max(swing, 1e-3), 0.5);  // rad/s of the slow rise and fall
  const double phase = Random(seed, 90).uniform(0, 2 * std::numbers::pi);
  for (std::size_t i = 0; i < knots.size(); ++i) {
    Vector6& k = knots[i];
    const double t = to_seconds(Trajectory::kKnotPeriod) * static_cast<double>(i), yaw = k[5];
    const double forward = std::cos(yaw) * lean[i].x() + std::sin(yaw) * lean[i].y();
    const double left = std::cos(yaw) * lean[i].y() - std::sin(yaw) * lean[i].x();
    k[2] = world.ground(k[0], k[1]) + world.flight.low + swing * (1 + std::sin(rate * t + phase));
    k[3] = -std::atan(left);
    k[4] = std::atan(forward);
  }
  return {start, std::move(knots)};
}

}  // namespace cairn::simulator
