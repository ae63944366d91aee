// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/floor_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cairn::simulator {
namespace {

World room_with_pillar() {
  World world;
  world.mesh.box({5, 4, 0, 0}, 10, 8, 3, Material::kPlaster);
  world.mesh.cylinder({5, 4, 0, 0}, 0.5, 0.5, 3, 64, Material::kConcrete);
  world.bounds = world.mesh.bounds();
  world.ground = [](double, double) { return 0.0; };
  return world;
}

TEST(FloorPlan, ClearanceIsTheDistanceToTheNearestObstacle) {
  const FloorPlan plan(room_with_pillar());
  const double diagonal = FloorPlan::kCell * std::sqrt(2.0);
  for (double x = 0.3; x < 9.8; x += 0.37) {
    for (double y = 0.3; y < 7.8; y += 0.29) {
      const double pillar = std::hypot(x - 5, y - 4) - 0.5;
      const double expected = std::min({x, 10 - x, y, 8 - y, pillar});
      if (expected < 0.1) continue;
      EXPECT_NEAR(plan.clearance({x, y}), expected, diagonal) << x << ' ' << y;
    }
  }
}

TEST(FloorPlan, NothingIsFreeOutsideOfTheWorld) {
  const FloorPlan plan(room_with_pillar());
  EXPECT_EQ(plan.clearance({-1, 4}), 0.0);
  EXPECT_EQ(plan.clearance({5, 9}), 0.0);
}

TEST(FloorPlan, OnlyWhatTheBodyCouldHitIsAnObstacle) {
  World world = room_with_pillar();
  world.mesh.box({2, 2, 1.5, 0}, 1, 1, 0.5, Material::kMetal);    // above
  world.mesh.box({8, 2, 0, 0}, 1, 1, 0.05, Material::kConcrete);  // below
  world.mesh.box({2, 6, 0.7, 0}, 1, 1, 0.04, Material::kWood);    // a table top
  const FloorPlan plan(world);
  EXPECT_GT(plan.clearance({2, 2}), 1.0);
  EXPECT_GT(plan.clearance({8, 2}), 1.0);
  EXPECT_LT(plan.clearance({2.45, 6}), 0.1);
}

TEST(FloorPlan, BodyClearanceDependsOnTheHeading) {
  const FloorPlan plan(room_with_pillar());
  // Along the wall the side is nearest, across it the front.
  EXPECT_NEAR(plan.body_clearance(3, 1, 0), 1 - 0.5 * Body::kWidth, 0.08);
  EXPECT_NEAR(plan.body_clearance(3, 1, -1.5708), 1 - 0.5 * Body::kLength, 0.08);
  EXPECT_EQ(plan.body_clearance(3, 0.3, -1.5708), 0.0);
}

}  // namespace
}  // namespace cairn::simulator
