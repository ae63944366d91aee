// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/wheel_bridge.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hal/symmetric_eigen.hpp"

namespace cairn::odometry {
namespace {

DriveState wheels_at(double x, double yaw, double variance) {
  DriveState state;
  state.T_odom_base.mean = SE3::from_xyz_rpy((Vector6() << x, 0, 0, 0, 0, yaw).finished());
  state.T_odom_base.covariance = variance * Matrix6::Identity();
  state.v = 1.5;
  state.w = -0.3;
  return state;
}

/// The last scan was followed `then`, and another comes `now`.
WheelBridge between(const DriveState& then, const DriveState& now) {
  WheelBridge bridge;
  bridge.note(&then);
  bridge.followed();
  bridge.note(&now);
  return bridge;
}

TEST(WheelBridge, SaysNothingWithoutWheelsNowOrThen) {
  WheelBridge bridge;
  const DriveState state = wheels_at(1, 0, 0.01);
  EXPECT_FALSE(bridge.since_followed());
  bridge.note(&state);
  EXPECT_FALSE(bridge.since_followed()) << "no wheels at a followed scan";
  bridge.followed();
  EXPECT_TRUE(bridge.since_followed());
  bridge.note(nullptr);
  EXPECT_FALSE(bridge.since_followed()) << "no wheels now";
}

TEST(WheelBridge, GivesTheMotionSinceTheLastFollowedScan) {
  const DriveState then = wheels_at(3, 0.2, 0.01), now = wheels_at(5, 0.9, 0.02);
  const WheelBridge bridge = between(then, now);
  const auto motion = bridge.since_followed();
  ASSERT_TRUE(motion);
  const SE3 wanted = then.T_odom_base.mean.inverse() * now.T_odom_base.mean;
  EXPECT_LT((motion->mean.inverse() * wanted).log().norm(), 1e-12);
  EXPECT_EQ(bridge.twist(), (Vector6() << 1.5, 0, 0, 0, 0, -0.3).finished());
}

/// The error of the way before the last followed scan is in both states. It is no error of the motion between.
TEST(WheelBridge, OldErrorsOfTheWheelsDoNotCount) {
  WheelBridge bridge;
  DriveState then = wheels_at(0, 0, 0);
  then.T_odom_base.covariance = 4.0 * Matrix6::Identity();
  DriveState now = then;
  bridge.note(&then);
  bridge.followed();
  bridge.note(&now);
  const Matrix6 standing = bridge.since_followed()->covariance;
  EXPECT_LT(standing.diagonal().maxCoeff(), 0.011) << "only what wheels do not measure";
  now.T_odom_base.covariance(0, 0) += 0.01;
  bridge.note(&now);
  EXPECT_NEAR(bridge.since_followed()->covariance(0, 0) - standing(0, 0), 0.04, 1e-12) << "distrusted twice";
  EXPECT_GT(symmetric_eigen(bridge.since_followed()->covariance).values[0], 0);
}

/// It drove 30 m ahead, was seen, and drove 5 m back: the way back is uncertain by its own length alone.
TEST(WheelBridge, AScaleIsWrongInBothDirections) {
  constexpr double kScale = 0.02;
  const auto driven = [](double x) {
    DriveState state = wheels_at(x, 0, 0);
    state.scale_errors(0, 0) = kScale * x;
    state.T_odom_base.covariance = state.scale_errors * state.scale_errors.transpose();
    return state;
  };
  WheelBridge bridge;
  const DriveState then = driven(30), now = driven(25);
  bridge.note(&then);
  bridge.followed();
  const double standing = bridge.since_followed()->covariance(0, 0);
  bridge.note(&now);
  EXPECT_NEAR(bridge.since_followed()->covariance(0, 0) - standing, 4 * std::pow(5 * kScale, 2), 1e-12);
}

/// 4.04 standard deviations of one of three directions are as unlikely as 0.1 %.
TEST(WheelBridge, ExcludesWhatItsWayAndHeadingMakeUnlikely) {
  const DriveState then = wheels_at(0, 0, 0), now = wheels_at(3, 0.4, 0.01);
  const WheelBridge bridge = between(then, now);
  const UncertainPose told = *bridge.since_followed();
  const auto off_by = [&](int axis, double sigmas) {
    Vector6 change = Vector6::Zero();
    change[axis] = sigmas * std::sqrt(told.covariance(axis, axis));
    return told.mean * SE3::exp(change);
  };
  for (const int axis : {0, 1, 5}) {
    EXPECT_TRUE(bridge.allow(off_by(axis, -3.9))) << axis;
    EXPECT_FALSE(bridge.allow(off_by(axis, 4.2))) << axis;
  }
  for (const int axis : {2, 3, 4}) EXPECT_TRUE(bridge.allow(off_by(axis, 10))) << axis << ": wheels do not measure it";
}

}  // namespace
}  // namespace cairn::odometry
