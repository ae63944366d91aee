// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/wheel_history.hpp"

#include <gtest/gtest.h>

namespace cairn::odometry {
namespace {

using namespace std::chrono_literals;

DriveState rolling(Time stamp, double x, double v, double w = 0) {
  DriveState state;
  state.stamp = stamp;
  state.T_odom_base.mean = SE3::from_xyz_rpy((Vector6() << x, 0, 0, 0, 0, 0).finished());
  state.v = v;
  state.w = w;
  return state;
}

TEST(WheelHistory, GivesTheStateBeforeATimeMovedOn) {
  WheelHistory history;
  const Time begin{100s};
  EXPECT_FALSE(history.at(begin)) << "nothing was heard yet";
  for (int i = 0; i < 50; ++i) history.add(rolling(begin + i * 20ms, 0.02 * i, 1.0));
  const auto state = history.at(begin + 410ms);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->stamp, begin + 410ms);
  EXPECT_NEAR(state->T_odom_base.mean.translation().x(), 0.41, 1e-12);
  EXPECT_FALSE(history.at(begin - 1ns));
}

TEST(WheelHistory, AnOldStateSaysNothing) {
  WheelHistory history;
  const Time begin{100s};
  history.add(rolling(begin, 0, 1));
  EXPECT_TRUE(history.at(begin + WheelHistory::kMaxAge));
  EXPECT_FALSE(history.at(begin + WheelHistory::kMaxAge + 1ns));
}

TEST(WheelHistory, KeepsASecondAndTimeThatAdvances) {
  WheelHistory history;
  const Time begin{100s};
  for (int i = 0; i <= 200; ++i) history.add(rolling(begin + i * 20ms, i, 0));
  history.add(rolling(begin, -1, 0));  // goes back: left out
  EXPECT_FALSE(history.at(begin + 2900ms)) << "more than a second old";
  EXPECT_NEAR(history.at(begin + 3500ms)->T_odom_base.mean.translation().x(), 175, 1e-9);
}

TEST(WheelHistory, TurnsAsItGoesOn) {
  WheelHistory history;
  history.add(rolling(Time{1s}, 0, 0, 0.5));
  EXPECT_NEAR(rotation_angle(history.at(Time{1s} + 100ms)->T_odom_base.mean), 0.05, 1e-9);
}

/// An error of the heading moves the place that lies ahead sideways.
TEST(WheelHistory, TakesItsErrorsAlong) {
  DriveState state = rolling(Time{1s}, 0, 2);
  state.T_odom_base.covariance.setZero();
  state.T_odom_base.covariance(5, 5) = 0.01;
  state.scale_errors(5, 1) = 0.1;
  WheelHistory history;
  history.add(state);
  const DriveState later = *history.at(Time{1s} + 50ms);
  EXPECT_NEAR(later.T_odom_base.covariance(1, 1), 0.01 * 0.1 * 0.1, 1e-12);
  EXPECT_NEAR(later.T_odom_base.covariance(1, 5), 0.01 * 0.1, 1e-12);
  EXPECT_NEAR(later.scale_errors(1, 1), 0.1 * 0.1, 1e-12);
  EXPECT_NEAR(later.scale_errors(5, 1), 0.1, 1e-12);
}

}  // namespace
}  // namespace cairn::odometry
