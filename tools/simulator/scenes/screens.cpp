// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/scenes/screens.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

#include "tools/simulator/motion/path.hpp"
#include "tools/simulator/motion/route.hpp"
#include "tools/simulator/world/floor_plan.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

constexpr std::size_t kMost = 12;
constexpr int kTries = 4000;
constexpr double kLength = 3.0, kStep = 0.25;                    // m
constexpr double kRoom = 1.0;                                    // m around a screen: a robot passes there
constexpr double kApart = 5.0;                                   // m between the middles of two screens
constexpr double kPane = 2.2, kAboveFloor = 0.05, kPost = 0.06;  // m
constexpr double kRail = 1.8, kBar = 0.02, kBars = 0.11;         // m

void glass(Mesh& m, const Placement& from) {
  for (const double x : {0.0, kLength}) m.box(from.at(x, 0), kPost, kPost, kPane, Material::kMetal);
  const double left = 0.5 * kPost, right = kLength - left;
  m.quad(from * Eigen::Vector3d(left, 0, kAboveFloor), from * Eigen::Vector3d(right, 0, kAboveFloor),
         from * Eigen::Vector3d(right, 0, kPane), from * Eigen::Vector3d(left, 0, kPane), Material::kClearGlass);
}

void fence(Mesh& m, const Placement& from) {
  for (const double up : {0.1, kRail - 0.1})
    m.box(from.at(0.5 * kLength, 0, up), kLength, 0.03, 0.04, Material::kFence);
  for (double x = 0; x <= kLength; x += kBars) m.box(from.at(x, 0, 0.05), kBar, kBar, kRail - 0.05, Material::kFence);
}

/// Whether robots and people can walk around it, and nobody's place is taken.
bool has_room(const World& world, const FloorPlan& plan, const Placement& from) {
  for (double x = 0; x <= kLength; x += kStep) {
    const Eigen::Vector2d p = (from * Eigen::Vector3d(x, 0, 0)).head<2>();
    if (plan.clearance(p) < kRoom) return false;
    if (std::ranges::any_of(world.places, [&](const auto& place) { return (place - p).norm() < kRoom; })) return false;
  }
  return true;
}

}  // namespace

Screens screens_of(std::string_view name) {
  return static_cast<Screens>(std::ranges::find(kScreens, name) - kScreens.begin());
}

std::size_t add_screens(World& world, Screens kind) {
  if (kind == Screens::kNone) return 0;
  const FloorPlan plan(world);
  const Path places = RoutePlanner(world, plan, 1).places();
  if (places.empty()) return 0;
  Random random(static_cast<std::uint64_t>(world.places.size()), 40);
  const Eigen::Vector3d low = world.bounds.min(), size = world.bounds.sizes();
  std::vector<Eigen::Vector2d> middles;
  for (int i = 0; i < kTries && middles.size() < kMost; ++i) {
    Placement from{.x = low.x() + random.uniform() * size.x(), .y = low.y() + random.uniform() * size.y()};
    from.yaw = random.uniform() < 0.5 ? 0 : 0.5 * std::numbers::pi;
    const Eigen::Vector2d middle = (from * Eigen::Vector3d(0.5 * kLength, 0, 0)).head<2>();
    if (std::ranges::any_of(middles, [&](const auto& other) { return (other - middle).norm() < kApart; })) continue;
    if (!has_room(world, plan, from) || !find_path(plan, places.front(), middle)) continue;
    middles.push_back(middle);
    from.z = world.ground(middle.x(), middle.y());
    kind == Screens::kGlass ? glass(world.mesh, from) : fence(world.mesh, from);
  }
  world.bounds.extend(world.mesh.bounds());
  return middles.size();
}

}  // namespace cairn::simulator
