// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/driven_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/tools/simulator/live/live_robot.hpp"

namespace cairn::simulator {
namespace {

constexpr double kSeparation = 0.67;

class DrivenBodyTest : public testing::Test {
 protected:
  /// `v` metres and `w` radians, in steps as small as a millisecond's.
  static void drive(DrivenBody& body, double v, double w, int steps = 1000) {
    for (int i = 0; i < steps; ++i) body.roll(drive::wheel_speeds({v / steps, w / steps}, kSeparation), kSeparation);
  }
  World world = test::hall();
  FloorPlan plan{world};
};

TEST_F(DrivenBodyTest, FollowsAnArc) {
  DrivenBody body(world, plan, {4, 3, 0.3});
  drive(body, 2, 1.5);
  const double radius = 2 / 1.5;
  EXPECT_NEAR(body.at().x, 4 + radius * (std::sin(1.8) - std::sin(0.3)), 1e-6);
  EXPECT_NEAR(body.at().y, 3 + radius * (std::cos(0.3) - std::cos(1.8)), 1e-6);
  EXPECT_NEAR(body.at().yaw, 1.8, 1e-9);
  EXPECT_NEAR(body.distance(), 2, 1e-9);
}

TEST_F(DrivenBodyTest, TheYawDoesNotJump) {
  DrivenBody body(world, plan, {4, 3, 0});
  drive(body, 0, 20);
  EXPECT_NEAR(body.pose()[5], 20, 1e-9);
}

TEST_F(DrivenBodyTest, StopsAtAWallAndLeavesIt) {
  DrivenBody body(world, plan, {3, 3, std::numbers::pi});
  drive(body, 5, 0);
  EXPECT_TRUE(body.touches());
  EXPECT_EQ(body.contacts(), 1);
  EXPECT_NEAR(body.at().x, 0.5 * Body::kLength + DrivenBody::kNearest, 0.08);
  const double stopped = body.at().x;
  drive(body, 1, 0);
  EXPECT_EQ(body.at().x, stopped) << "the wheels slip";
  EXPECT_EQ(body.contacts(), 1) << "the same contact";
  drive(body, -1, 0);
  EXPECT_NEAR(body.at().x, stopped + 1, 1e-6);
  EXPECT_FALSE(body.touches());
  drive(body, 3, 0);
  EXPECT_EQ(body.contacts(), 2);
}

TEST_F(DrivenBodyTest, DoesNotTurnItsCornersIntoAWall) {
  DrivenBody body(world, plan, {10, 0.5 * Body::kWidth + 0.08, 0});
  drive(body, 0, 1.5);
  EXPECT_TRUE(body.touches());
  EXPECT_LT(body.at().yaw, 0.5);
  EXPECT_GT(plan.body_clearance(body.at().x, body.at().y, body.at().yaw), 0);
}

TEST_F(DrivenBodyTest, StandsOnTheGround) {
  world.ground = [](double x, double) { return 0.1 * x; };
  const DrivenBody body(world, plan, {4, 3, 0});
  EXPECT_NEAR(body.pose()[2], 0.4 + Body::kBaseHeight, 1e-9);
  EXPECT_NEAR(body.pose()[4], -std::atan(0.1), 1e-9) << "uphill the nose goes up";
}

}  // namespace
}  // namespace cairn::simulator
