// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/wheel_odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drivers/drive/chassis/differential.hpp"
#include "tests/drivers/drive/virtual_bus.hpp"
#include "tests/support/rounds.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::drive {
namespace {

using namespace std::chrono_literals;

TEST(Differential, WheelsAndBodyAreInverse) {
  simulator::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Velocity body{random.uniform(-3, 3), random.uniform(-3, 3)};
    const Velocity back = body_velocity(wheel_speeds(body, 0.6), 0.6);
    EXPECT_NEAR(back.v, body.v, 1e-12);
    EXPECT_NEAR(back.w, body.w, 1e-12);
    const Velocity slow = limited(body, 1, 0.5);
    EXPECT_LE(std::abs(slow.v), 1 + 1e-12);
    EXPECT_LE(std::abs(slow.w), 0.5 + 1e-12);
    EXPECT_NEAR(slow.v * body.w, slow.w * body.v, 1e-12) << "curvature";
  }
  EXPECT_EQ(limited({NAN, 1}, 1, 1).w, 0);
}

TEST(Differential, SteeringMeetsTheCentreOfTheTurn) {
  EXPECT_NEAR(inner_steering({1, 0.5}, 0.65, 0.6), std::atan2(0.65, 1.7), 1e-12);
  EXPECT_NEAR(inner_steering({1, -0.5}, 0.65, 0.6), -std::atan2(0.65, 1.7), 1e-12);
  EXPECT_NEAR(inner_steering({-1, 0.5}, 0.65, 0.6), -std::atan2(0.65, 1.7), 1e-12);
  EXPECT_EQ(inner_steering({0, 0.5}, 0.65, 0.6), 0);
}

TEST(WheelCounter, WrapsWithoutAJump) {
  WheelCounter counter;
  EXPECT_FALSE(counter.update(INT32_MAX - 5));
  EXPECT_EQ(counter.update(INT32_MIN + 4), 10);
  EXPECT_EQ(counter.update(INT32_MAX - 5), -10);
  counter.forget();
  EXPECT_FALSE(counter.update(0));
}

/// Drives both sides at constant speeds.
DriveState driven(WheelOdometry& odometry, double left, double right, Duration duration, Duration dt = 10ms) {
  Time t = odometry.state().stamp;
  for (const Time end = t + duration; t < end;) {
    t += dt;
    odometry.update({t, left * to_seconds(dt), right * to_seconds(dt), 0, 1e-5});
  }
  return odometry.state();
}

TEST(WheelOdometry, ACircleEndsWhereItBegan) {
  WheelOdometry odometry(test::two_nodes());
  odometry.start(Time{1s});
  const Velocity body{0.5, 0.5};
  const WheelSpeeds wheels = wheel_speeds(body, 0.5);
  const DriveState state = driven(odometry, wheels.left, wheels.right, from_seconds(4 * std::numbers::pi), 10ms);
  EXPECT_LT(state.T_odom_base.mean.translation().norm(), 0.01);
  EXPECT_NEAR(state.v, 0.5, 1e-9);
  EXPECT_NEAR(state.w, 0.5, 1e-9);
}

TEST(WheelOdometry, CovarianceDoesNotDependOnTheRate) {
  WheelOdometry fast(test::two_nodes()), slow(test::two_nodes());
  fast.start(Time{1s});
  slow.start(Time{1s});
  const Matrix6 a = driven(fast, 0.4, 0.6, 10s, 10ms).T_odom_base.covariance;
  const Matrix6 b = driven(slow, 0.4, 0.6, 10s, 50ms).T_odom_base.covariance;
  EXPECT_LT((a - b).norm(), 0.02 * a.norm());
}

TEST(WheelOdometry, ScaleGrowsWithTheWayAndNoiseWithItsRoot) {
  Config config = test::two_nodes();
  config.travel_noise_m = config.ground_noise_m = config.ground_noise_rad = config.lateral_slip = 0;
  WheelOdometry scale(config);
  scale.start(Time{1s});
  EXPECT_NEAR(std::sqrt(driven(scale, 1, 1, 10s).T_odom_base.covariance(0, 0)), 0.1, 0.002);
  EXPECT_NEAR(std::sqrt(driven(scale, 1, 1, 10s).T_odom_base.covariance(0, 0)), 0.2, 0.002);
  config.travel_noise_m = 0.02;
  config.travel_scale = config.rotation_scale = 0;
  WheelOdometry noise(config);
  noise.start(Time{1s});
  EXPECT_NEAR(driven(noise, 1, 1, 10s).T_odom_base.covariance(0, 0), 0.0004 * 10 / 2, 1e-4);
}

TEST(WheelOdometry, WhatTheScalesMoveIsAPartOfTheCovariance) {
  Config config = test::two_nodes();
  config.travel_noise_m = config.ground_noise_m = config.ground_noise_rad = config.lateral_slip = config.slip_factor =
      0;
  WheelOdometry odometry(config);
  odometry.start(Time{1s});
  driven(odometry, 0.4, 0.6, 10s);
  const DriveState state = driven(odometry, -0.5, -0.2, 10s);
  EXPECT_GT(state.scale_errors.norm(), 0.01);
  const Matrix6 scales = state.scale_errors * state.scale_errors.transpose();
  EXPECT_LT((state.T_odom_base.covariance - scales - WheelOdometry::kFloor * Matrix6::Identity()).norm(), 1e-12);
}

TEST(WheelOdometry, RestCostsNothing) {
  WheelOdometry odometry(test::two_nodes());
  odometry.start(Time{1s});
  const Matrix6 before = driven(odometry, 0.5, 0.5, 1s).T_odom_base.covariance;
  EXPECT_EQ(driven(odometry, 0, 0, 100s).T_odom_base.covariance, before);
}

TEST(WheelOdometry, SpinningWheelsAreNoticedAndDoubted) {
  WheelOdometry grip(test::two_nodes()), spin(test::two_nodes());
  for (WheelOdometry* odometry : {&grip, &spin}) {
    odometry->start(Time{1s});
    driven(*odometry, 0.2, 0.2, 1s);
  }
  EXPECT_FALSE(driven(grip, 0.2, 0.2, 200ms).slipping);
  Time t = spin.state().stamp;
  bool seen = false;
  for (int i = 0; i < 20; ++i) {
    t += 10ms;
    seen |= spin.update({t, i >= 5 ? 0.012 : 0.002, 0.002, 0, 1e-5}).slipping;  // left: 0.2 → 1.2 m/s at once
  }
  EXPECT_TRUE(seen);
  EXPECT_GT(spin.state().T_odom_base.covariance(0, 0), 2 * grip.state().T_odom_base.covariance(0, 0));
}

TEST(WheelOdometry, WheelsOfOneSideThatDisagreeSlip) {
  WheelOdometry odometry(test::two_nodes());
  odometry.start(Time{1s});
  Time t{1s};
  for (int i = 0; i < 20; ++i) odometry.update({t += 10ms, 0.005, 0.005, 0.002, 1e-5});
  EXPECT_TRUE(odometry.state().slipping);
}

TEST(WheelOdometry, AnImpossibleJumpIsBridged) {
  WheelOdometry odometry(test::two_nodes());
  odometry.start(Time{1s});
  const DriveState before = driven(odometry, 0.5, 0.5, 1s);
  odometry.update({before.stamp + 10ms, 1000, 0.005, 0, 1e-5});
  EXPECT_NEAR(odometry.state().T_odom_base.mean.translation().x(), before.T_odom_base.mean.translation().x() + 0.005,
              1e-6);
  EXPECT_TRUE(odometry.state().slipping);
  const DriveState now = odometry.state();
  odometry.update({now.stamp, 0.1, 0.1, 0, 1e-5});
  EXPECT_EQ(odometry.state().stamp, now.stamp) << "time does not stand still";
}

/// The truth lies within 3 σ at 95 % of the stamps when the world errs as the model says.
TEST(WheelOdometry, CovarianceIsHonest) {
  int inside = 0, total = 0;
  for (int seed = 1; seed <= support::rounds(100, 30); ++seed) {
    simulator::Random random(static_cast<std::uint64_t>(seed));
    const Config config = test::two_nodes();
    WheelOdometry odometry(config);
    odometry.start(Time{1s});
    const double scale = 1 + config.travel_scale * random.normal_pair().first;
    const double rotation = 1 + config.rotation_scale * random.normal_pair().first;
    SE3 truth;
    Time t{1s};
    for (int i = 0; i < 3000; ++i) {
      const double turn = 0.5 * std::sin(i * 0.01), left = 0.01 * (1 - turn), right = 0.01 * (1 + turn);
      const auto [nl, nr] = random.normal_pair();
      odometry.update({t += 10ms, left, right, 0, 1e-5});
      Vector6 delta = Vector6::Zero();
      const double sigma = config.travel_noise_m;
      const double l = left + sigma * std::sqrt(std::abs(left)) * nl,
                   r = right + sigma * std::sqrt(std::abs(right)) * nr;
      delta[0] = (l + r) / 2 + (left + right) / 2 * (scale - 1);
      delta[1] = config.lateral_slip * std::sqrt(std::abs(right - left) * config.wheel_separation_m) *
                 random.normal_pair().first;
      delta[5] = ((r - l) + (right - left) * (rotation - 1)) / config.wheel_separation_m;
      truth = truth * SE3::exp(delta);
      if (i % 300 != 299) continue;
      const Vector6 error = (odometry.state().T_odom_base.mean.inverse() * truth).log();
      const Eigen::Vector3d planar(error[0], error[1], error[5]);
      Eigen::Matrix3d covariance;
      constexpr int kPlanar[] = {0, 1, 5};
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) covariance(a, b) = odometry.state().T_odom_base.covariance(kPlanar[a], kPlanar[b]);
      inside += planar.dot(covariance.inverse() * planar) < 14.16 ? 1 : 0;  // χ², 3 degrees of freedom, 99.73 %
      ++total;
    }
  }
  EXPECT_GT(inside, total * 97 / 100);
}

}  // namespace
}  // namespace cairn::drive
