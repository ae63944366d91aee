// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/path.hpp"

#include <gtest/gtest.h>

namespace cairn::simulator {
namespace {

/// Two rooms side by side; the wall between them has one door of 1.4 m at y = 1.5.
World two_rooms(bool door) {
  World world;
  world.mesh.box({6, 4, 0, 0}, 12, 8, 3, Material::kPlaster);
  if (door) world.mesh.box({6, 0.4, 0, 0}, 0.1, 0.8, 3, Material::kPlaster);
  if (door) world.mesh.box({6, 5.1, 0, 0}, 0.1, 5.8, 3, Material::kPlaster);
  if (!door) world.mesh.box({6, 4, 0, 0}, 0.1, 8, 3, Material::kPlaster);
  world.bounds = world.mesh.bounds();
  world.ground = [](double, double) { return 0.0; };
  return world;
}

TEST(Path, GoesThroughTheDoor) {
  const FloorPlan plan(two_rooms(true));
  const auto path = find_path(plan, {3, 6}, {9, 6});
  ASSERT_TRUE(path);
  EXPECT_EQ(path->front(), Eigen::Vector2d(3, 6));
  EXPECT_EQ(path->back(), Eigen::Vector2d(9, 6));
  for (const Eigen::Vector2d& p : *path) EXPECT_GE(plan.clearance(p), kPassable - FloorPlan::kCell);
  EXPECT_GT(path_length(*path), 9.0);
}

TEST(Path, SaysWhenThereIsNoWay) {
  const FloorPlan plan(two_rooms(false));
  EXPECT_FALSE(find_path(plan, {3, 6}, {9, 6}));
  EXPECT_FALSE(find_path(plan, {3, 6}, {3, 0.1}));
}

TEST(Path, SmoothingKeepsEndsAndClearanceAndTakesOutCorners) {
  const FloorPlan plan(two_rooms(true));
  const Path rough = *find_path(plan, {3, 6}, {9, 6});
  const Path even = smooth(plan, rough);
  EXPECT_LT((even.front() - rough.front()).norm(), 1e-9);
  EXPECT_LT((even.back() - rough.back()).norm(), kPathStep + 1e-9);
  EXPECT_LE(path_length(even), path_length(rough));
  double sharpest = 0;
  for (std::size_t i = 1; i + 1 < even.size(); ++i) {
    EXPECT_GE(plan.clearance(even[i]), kPassable - FloorPlan::kCell);
    EXPECT_LE((even[i] - even[i - 1]).norm(), kPathStep + 1e-9);
    const Eigen::Vector2d u = even[i] - even[i - 1], v = even[i + 1] - even[i];
    sharpest = std::max(sharpest, std::abs(std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v))));
  }
  EXPECT_LT(sharpest, 0.3);  // rad between steps of 0.1 m
}

}  // namespace
}  // namespace cairn::simulator
