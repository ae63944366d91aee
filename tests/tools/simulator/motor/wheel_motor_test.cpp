// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motor/wheel_motor.hpp"

#include <gtest/gtest.h>

namespace cairn::simulator {
namespace {

TEST(WheelMotor, ReachesItsGoalAtTheRateAndStaysThere) {
  WheelMotor wheel;
  for (int i = 0; i < 100; ++i) wheel.move(5, 10, 0.01);
  EXPECT_DOUBLE_EQ(wheel.speed(), 5);
  EXPECT_NEAR(wheel.angle(), 0.5 * 5 * 0.5 + 5 * 0.5, 1e-9);  // half a second of ramp, half a second of goal
}

TEST(WheelMotor, TheAngleDoesNotDependOnTheStep) {
  WheelMotor coarse, fine;
  coarse.move(-5, 10, 0.5);
  for (int i = 0; i < 500; ++i) fine.move(-5, 10, 0.001);
  EXPECT_NEAR(coarse.angle(), fine.angle(), 1e-9);
  EXPECT_NEAR(coarse.speed(), fine.speed(), 1e-9);
}

TEST(WheelMotor, StopsWithoutGoingBackwards) {
  WheelMotor wheel;
  wheel.move(1, 100, 1);
  wheel.move(0, 1000, 1);
  EXPECT_EQ(wheel.speed(), 0);
}

TEST(WheelMotor, OneThatFollowsTheWorldIsWhereTheWorldSays) {
  WheelMotor wheel;
  EXPECT_FALSE(wheel.followed());
  wheel.follow(7, -2);
  EXPECT_TRUE(wheel.followed());
  EXPECT_EQ(wheel.angle(), 7);
  EXPECT_EQ(wheel.speed(), -2);
}

}  // namespace
}  // namespace cairn::simulator
