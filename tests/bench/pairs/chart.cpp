// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/pairs/chart.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fusion/matching/evidence/judge.hpp"
#include "fusion/matching/matcher.hpp"

namespace cairn::pairs {
namespace {

using simulator::Random;
using Stops = simulator::Path;

// What is measured, not tuned.
constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr double kSuccess_m = 0.6, kSuccess_rad = 6 * kDegree_rad;
constexpr std::size_t kMostStops = 40;

}  // namespace

Stops part(const simulator::World& world, double heading, double from, double to, Random& random) {
  Stops all = world.places;
  const Eigen::Vector2d u(std::cos(heading), std::sin(heading));
  std::ranges::stable_sort(all, {}, [&](const Eigen::Vector2d& p) { return p.dot(u); });
  const auto n = static_cast<double>(all.size());
  Stops some(all.begin() + static_cast<std::ptrdiff_t>(std::clamp(from, 0.0, 1.0) * n),
             all.begin() + static_cast<std::ptrdiff_t>(std::clamp(to, 0.0, 1.0) * n));
  while (some.size() > kMostStops) some.erase(some.begin() + static_cast<std::ptrdiff_t>(random.below(some.size())));
  for (Eigen::Vector2d& p : some) p += Eigen::Vector2d(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
  return some;
}

SE3 frame(Random& random, double height_m, double lean_deg, const Eigen::Vector3d& about) {
  Vector6 v;
  v << random.uniform(-10, 10), random.uniform(-10, 10), random.uniform(-height_m, height_m), 0, 0,
      random.uniform(-std::numbers::pi, std::numbers::pi);
  const double turn = random.uniform(0, 2 * std::numbers::pi);
  const Eigen::Vector3d axis(std::cos(turn), std::sin(turn), 0);
  const double lean = random.uniform(0.5, 1) * lean_deg * kDegree_rad;
  return SE3::from_xyz_rpy(v) * SE3(Eigen::Quaterniond(Eigen::AngleAxisd(lean, axis)), Eigen::Vector3d::Zero()) *
         SE3(Eigen::Quaterniond::Identity(), -about);
}

Chart chart(const Ground& ground, const Stops& stops, const Survey& how) {
  Chart c{.map = survey(ground, stops, how), .features = nullptr, .T_map_world = how.T_map_world};
  c.features = std::make_unique<matching::MapFeatures>(*matching::MapFeatures::build(*c.map));
  for (const Eigen::Vector2d& p : stops)
    c.middle += Eigen::Vector3d(p.x(), p.y(), ground.world.ground(p.x(), p.y())) / static_cast<double>(stops.size());
  return c;
}

bool is_right(const Chart& a, const Chart& b, const SE3& T_a_b) {
  const SE3 truth = a.T_map_world * b.T_map_world.inverse();
  const Eigen::Vector3d at = b.T_map_world * b.middle;
  return (T_a_b * at - truth * at).norm() <= kSuccess_m && rotation_angle(T_a_b.inverse() * truth) <= kSuccess_rad;
}

double overlap(const Chart& a, const Chart& b) {
  const SE3 truth = a.T_map_world * b.T_map_world.inverse();
  return matching::Judge(*a.features, *b.features).look(truth, matching::anywhere().covariance).evidence.overlap;
}

UncertainPose guess(const Chart& a, const Chart& b, Random& random) {
  Vector6 off;
  off << random.uniform(-2, 2), random.uniform(-2, 2), 0, 0, 0, random.uniform(-15, 15) * kDegree_rad;
  return {a.T_map_world * b.T_map_world.inverse() * SE3::from_xyz_rpy(off), matching::default_prior_covariance()};
}

}  // namespace cairn::pairs
