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

/// A base that climbs at 1 m/s with its nose 0.2 rad up, headed 2 rad to the left.
MotionFilter climbing() {
  MotionFilter filter;
  filter.reset({.T_odom_base = SE3::from_xyz_rpy((Vector6() << 3, 4, 5, 0, -0.2, 2).finished()),
                .twist = (Vector6() << 1, 0, 0, 0, 0, 0).finished()},
               {});
  return filter;
}

TEST(MotionPrior, ANewMapIsTheMoreLevelTheLongerNothingWasSeen) {
  const MotionPrior prior({});
  const MotionFilter followed = climbing();
  double tilt = 0.2;
  for (const double dt_s : {0.1, 1.0, 4.0, 10.0, 100.0}) {
    const MotionFilter moved = prior.moved_anyhow(followed, dt_s, false);
    const SE3 at = MotionPrior::levelled(moved, followed, dt_s);
    const SE3& predicted = moved.state().T_odom_base;
    EXPECT_LT(-at.xyz_rpy()[4], tilt) << dt_s;
    tilt = -at.xyz_rpy()[4];
    EXPECT_NEAR(at.xyz_rpy()[3], 0, 1e-9);
    EXPECT_NEAR(at.xyz_rpy()[5], 2, 1e-9) << "the heading stays";
    EXPECT_EQ(at.translation().head<2>(), predicted.translation().head<2>());
    EXPECT_LE(at.translation().z(), predicted.translation().z());
    EXPECT_GE(at.translation().z(), 5);
    EXPECT_LT(at.translation().z(), 5 + 3 * std::sin(0.2)) << "three seconds of climbing at most";
  }
  EXPECT_LT(tilt, 1e-9);
}

TEST(MotionPrior, AtOnceANewMapBeginsWhereTheBaseWas) {
  const MotionFilter followed = climbing();
  const SE3 at = MotionPrior::levelled(followed, followed, 1e-6);
  EXPECT_LT((followed.state().T_odom_base.inverse() * at).log().norm(), 1e-6);
}

}  // namespace
}  // namespace cairn::odometry
