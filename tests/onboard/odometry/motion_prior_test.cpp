// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/motion_prior.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cairn::odometry {
namespace {

constexpr int kRoll = 3, kYaw = 5;

/// Standard deviation of the pose along one axis after `dt_s`, as MotionFilter::predict() has it.
double moved(const MotionNoise& noise, int axis, double dt_s) {
  return noise.acceleration[axis] * dt_s * dt_s / std::sqrt(3.0);
}

TEST(MotionPrior, ASteadyRobotIsBelievedToStaySteady) {
  const MotionPrior prior({});
  EXPECT_EQ(prior.usual(true).acceleration, Vector6::Constant(1.0));
  EXPECT_EQ(prior.usual(false).acceleration, Vector6::Constant(3.0)) << "while the map settles";
}

TEST(MotionPrior, WhatWasSeenIsExpectedAgainForAWhile) {
  MotionPrior prior({});
  prior.learn(1.0 * Vector6::Unit(kYaw), 0.1);  // 10 rad/s²
  EXPECT_NEAR(prior.usual(true).acceleration[kYaw], 7.0, 1e-12);
  EXPECT_EQ(prior.usual(true).acceleration[kRoll], 1.0) << "turning is not tilting";
  for (int i = 0; i < 30; ++i) prior.learn(Vector6::Zero(), 0.1);
  EXPECT_EQ(prior.usual(true).acceleration, Vector6::Constant(1.0));
  prior.learn(1.0 * Vector6::Unit(kYaw), 0.1);
  prior.reset();
  EXPECT_EQ(prior.usual(true).acceleration, Vector6::Constant(1.0));
}

TEST(MotionPrior, NoMoreIsExpectedThanARobotCanDo) {
  MotionPrior prior({});
  prior.learn(Vector6::Constant(1e3), 0.1);
  EXPECT_EQ(prior.usual(true).acceleration[0], 10.0);
  EXPECT_EQ(prior.usual(true).acceleration[kYaw], 25.0);
}

TEST(MotionPrior, AnythingMeansMoreTheLongerNothingWasSeenButRobotsStayUpright) {
  const MotionPrior prior({});
  for (const double dt_s : {0.1, 0.5, 1.0}) {
    const MotionNoise noise = prior.anything(dt_s);
    EXPECT_NEAR(moved(noise, 0, dt_s), 0.05 + 1.0 * dt_s, 1e-12);
    EXPECT_NEAR(moved(noise, kYaw, dt_s), 0.06 + 1.2 * dt_s, 1e-12);
    EXPECT_NEAR(moved(noise, kRoll, dt_s), 0.2, 1e-12);
  }
  EXPECT_GT(3 * moved(prior.anything(0.1), kYaw, 0.1), 0.52) << "30°";
}

}  // namespace
}  // namespace cairn::odometry
