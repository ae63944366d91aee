// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace cairn::simulator {
namespace {

constexpr Time kStart = Time(std::chrono::seconds(10));

/// A circle of 2 m radius at 1 m/s.
Vector6 on_circle(double t) {
  Vector6 v;
  v << 2 * std::sin(0.5 * t), 2 - 2 * std::cos(0.5 * t), 0.1, 0.01 * std::sin(t), 0.02 * std::cos(t), 0.5 * t;
  return v;
}

Trajectory circle(int knots) {
  std::vector<Vector6> poses;
  for (int i = 0; i < knots; ++i) poses.push_back(on_circle(0.01 * i));
  return {kStart, poses};
}

TEST(Trajectory, PassesThroughItsKnots) {
  const Trajectory trajectory = circle(100);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_TRUE(trajectory.xyz_rpy(trajectory.knot_time(i)).isApprox(trajectory.knots()[i], 1e-12));
  }
}

TEST(Trajectory, FollowsASmoothMotionBetweenKnots) {
  const Trajectory trajectory = circle(300);
  for (double t = 0.02; t < 2.97; t += 0.00137) {
    const Vector6 error = trajectory.xyz_rpy(kStart + from_seconds(t)) - on_circle(t);
    ASSERT_LT(error.cwiseAbs().maxCoeff(), 1e-7) << t;
  }
}

TEST(Trajectory, VelocityIsContinuousAtKnots) {
  const Trajectory trajectory = circle(50);
  constexpr double h = 1e-5;
  for (std::size_t i = 1; i < 49; ++i) {
    const Time t = trajectory.knot_time(i);
    const Vector6 before = (trajectory.xyz_rpy(t) - trajectory.xyz_rpy(t - from_seconds(h))) / h;
    const Vector6 after = (trajectory.xyz_rpy(t + from_seconds(h)) - trajectory.xyz_rpy(t)) / h;
    ASSERT_LT((after - before).cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST(Trajectory, RestsBeforeAndAfter) {
  const Trajectory trajectory = circle(10);
  EXPECT_EQ(trajectory.xyz_rpy(kStart - std::chrono::seconds(1)), trajectory.knots().front());
  EXPECT_EQ(trajectory.xyz_rpy(trajectory.end() + std::chrono::seconds(1)), trajectory.knots().back());
  EXPECT_EQ(trajectory.end(), kStart + std::chrono::milliseconds(90));
}

TEST(Trajectory, LengthIsThatOfThePath) { EXPECT_NEAR(circle(301).length(), 3.0, 1e-3); }

}  // namespace
}  // namespace cairn::simulator
