// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/odometry.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/onboard/odometry/ride.hpp"

namespace cairn::odometry {
namespace {

SE3 drive(double t) {
  return SE3::from_xyz_rpy(
      (Vector6() << 5 + 0.9 * t, 4 + 0.3 * std::sin(t), 0, 0, 0, 0.15 * std::sin(0.8 * t)).finished());
}

TEST(Odometry, FollowsARideThroughALobbyToCentimetres) {
  Ride ride(support::lobby().world, drive);
  OdometryUpdate last;
  for (int i = 0; i < 40; ++i) last = ride.step();
  const Vector6 error = ride.error(last);
  EXPECT_LT(error.head<3>().norm(), 0.05) << error.transpose();
  EXPECT_LT(error.tail<3>().norm(), 0.01);
  EXPECT_FALSE(last.lost);
  EXPECT_EQ(last.degenerate_directions, 0);
}

TEST(Odometry, ATurnThatEndsWhileNoScanComesIsFollowed) {
  for (const double rate : {-1.2, 0.9, 1.2}) {
    const auto turning = [rate](double t) {  // gently faster for 0.8 s, then evenly, and at 1.6 s it stands at once
      const double even = std::clamp(t, 0.8, 1.6) - 0.8, early = std::min(t, 0.8);
      return SE3::from_xyz_rpy((Vector6() << 5, 4, 0, 0, 0, rate * (early * early / 1.6 + even)).finished());
    };
    Ride ride(support::lobby().world, turning);
    OdometryUpdate last;
    for (int i = 0; i < 15; ++i) last = ride.step();
    ASSERT_LT(ride.error(last).norm(), 0.08) << rate << ": the first scan was taken while it began to turn";
    ride.lose(3);  // until 1.8 s: it has been standing for 0.2 s
    EXPECT_FALSE(ride.step_with_the_end_of_a_scan(0.3)) << "too little to find the way back with";
    for (int i = 0; i < 5; ++i) last = ride.step();
    EXPECT_LT(ride.error(last).tail<3>().norm(), 0.01) << rate;
    EXPECT_LT(ride.error(last).head<3>().norm(), 0.08) << rate;
  }
}

/// Drives on at 1.5 m/s; from 1 s on turns at 2.1 rad/s (120°/s) for 1.5 s, with an onset of 0.1 s.
SE3 sharp_turn(double t) {
  constexpr double kOnset = 0.1, kRate = 2.1, kFrom = 1.0, kUntil = 2.5;
  const auto turned = [](double since) {
    return since <= 0 ? 0.0 : since < kOnset ? since * since / (2 * kOnset) : since - kOnset / 2;
  };
  const double yaw = kRate * (turned(t - kFrom) - turned(t - kUntil));
  return SE3::from_xyz_rpy((Vector6() << 8 + 0.5 * t, 4 + 0.2 * t, 0, 0, 0, yaw).finished());
}

TEST(Odometry, ATurnOf120DegreesPerSecondThatBeginsAndEndsAtOnceIsFollowed) {
  Ride ride(support::lobby().world, sharp_turn);
  for (int i = 0; i < 35; ++i) {
    const OdometryUpdate update = ride.step();
    EXPECT_FALSE(update.lost) << i;
    const double most = i == 10 || i == 25 ? 0.06 : 0.02;  // a scan in which a turn begins or ends is bent
    EXPECT_LT(ride.error(update).tail<3>().norm(), most) << i;
  }
}

TEST(Odometry, BeginsInAFastTurn) {
  const auto turning = [](double t) {
    return SE3::from_xyz_rpy((Vector6() << 20 + 2.0 * std::sin(t), 4 + 0.5 * t, 0, 0, 0, 2.0 * t).finished());
  };
  Ride ride(support::lobby().world, turning);
  OdometryUpdate last;
  for (int i = 0; i < 20; ++i) {
    last = ride.step();
    EXPECT_FALSE(last.lost) << i;
  }
  EXPECT_LT(ride.error(last).norm(), 0.05);
  EXPECT_NEAR(last.twist[5], 2.0, 0.05) << "scans that are skewed alike fit with a twist of zero, too";
}

/// Scans that are skewed alike fit as well as straight ones: what belies them is the way between them.
TEST(Odometry, KnowsItsTwistFromTheSecondScanOn) {
  const support::World world = support::carpark().world;
  for (const int place : {2, 5, 7}) {
    const auto turning = [place](double t) {
      const double yaw = 0.5 * place - 0.32 * t;
      return SE3::from_xyz_rpy((Vector6() << 4.0 + place, 6.0 + 0.5 * place, 0, 0, 0, yaw).finished()) *
             SE3::exp((Vector6() << 1.4 * t, 0, 0, 0, 0, 0).finished());
    };
    Ride ride(world, turning);
    ride.step();
    const OdometryUpdate second = ride.step();
    EXPECT_NEAR(second.twist[0], 1.4, 0.3) << place;
    EXPECT_NEAR(second.twist[5], -0.32, 0.1) << place;
  }
}

TEST(Odometry, BeginsAmongTreesWhileItNods) {
  const auto nodding = [](double t) {
    return SE3::from_xyz_rpy((Vector6() << 8 + 1.5 * t, 6 + 0.1 * t, 0, 0.03, 0.6 * t, 0).finished());
  };
  Ride ride(support::forest().world, nodding);
  for (int i = 0; i < 4; ++i)
    EXPECT_LT(ride.error(ride.step()).head<3>().norm(), 0.035) << i << ": repeating alone leaves 0.056 m";
}

TEST(Odometry, KeyFramesTwiceASecondAreFollowed) {
  support::Scene scene = support::office();
  scene.ride.max_turn = 1.2;
  const support::RidePath path(scene.ride, 31);
  Ride ride(scene.world, path);
  for (int i = 0; i < 60; ++i) {
    const OdometryUpdate update = ride.step();
    ride.lose(4);
    EXPECT_FALSE(update.lost) << i;
    EXPECT_LT(ride.error(update).head<3>().norm(), 0.15) << i;
  }
}

TEST(Odometry, ALostRobotIsFoundWithinThreeScans) {
  for (const double turned : {-0.5, 0.5}) {  // 29°, while nothing was seen
    const auto jerked = [turned](double t) {
      const double share = std::clamp((t - 2.0) / 0.3, 0.0, 1.0);
      return SE3::from_xyz_rpy((Vector6() << 8, 4 + 0.5 * share, 0, 0, 0, turned * share).finished());
    };
    Ride ride(support::lobby().world, jerked);
    for (int i = 0; i < 20; ++i) ride.step();
    Scan blind;
    for (int i = 0; i < 4; ++i) {
      ride.lose(1);
      blind.valid = {Time{from_seconds(2.0 + 0.1 * i)}, Time{from_seconds(2.1 + 0.1 * i)}};
      EXPECT_TRUE(ride.feed(blind).lost);
    }
    OdometryUpdate last;
    for (int i = 0; i < 3; ++i) last = ride.step();
    EXPECT_FALSE(last.lost);
    EXPECT_LT(ride.error(last).norm(), 0.05) << turned;
  }
}

TEST(Odometry, StandingStillItStays) {
  Ride ride(support::lobby().world, [](double) { return drive(0); });
  OdometryUpdate last;
  for (int i = 0; i < 30; ++i) last = ride.step();
  EXPECT_LT(last.T_odom_base.mean.translation().norm(), 0.02);
  EXPECT_LT(rotation_angle(last.T_odom_base.mean), 0.003);
}

/// A wall that is near has many points, whose noise is larger than their distance from each other.
TEST(Odometry, StandingStillInASmallRoomItDoesNotTurn) {
  for (const double heading : {0.0, 0.4, 0.8, 1.2}) {
    support::World room;
    room.box({0, 0, 0}, {6, 4.5, 3});
    Ride ride(room, [&](double) { return SE3::from_xyz_rpy((Vector6() << 2.5, 2, 0, 0, 0, heading).finished()); });
    double sum = 0;
    for (int i = 0; i < 20; ++i) sum += ride.error(ride.step())[5];
    EXPECT_LT(std::abs(sum / 20), 0.001) << heading;
  }
}

TEST(Odometry, WhatTheMapWasMadeWithIsNotForgottenByStandingStill) {
  Ride ride(support::lobby().world, [](double) { return drive(0); });
  ride.step();
  const Matrix6 second = ride.step().T_odom_base.covariance;
  OdometryUpdate last;
  for (int i = 0; i < 20; ++i) last = ride.step();
  for (Eigen::Index k = 0; k < 6; ++k) EXPECT_GE(last.T_odom_base.covariance(k, k), 0.9 * second(k, k)) << k;
}

TEST(Odometry, GivesTheSameBitsForAnyNumberOfThreads) {
  const auto trace = [](unsigned threads) {
    Ride ride(support::lobby().world, drive, threads);
    std::vector<double> bits;
    for (int i = 0; i < 8; ++i) {
      const OdometryUpdate u = ride.step();
      const Eigen::Matrix4d T = u.T_odom_base.mean.matrix();
      bits.insert(bits.end(), T.data(), T.data() + 16);
      bits.insert(bits.end(), u.T_odom_base.covariance.data(), u.T_odom_base.covariance.data() + 36);
      for (const auto& p : u.points_base) bits.push_back(static_cast<double>(p.sum()));
    }
    return bits;
  };
  const auto one = trace(1);
  EXPECT_EQ(one, trace(2));
  EXPECT_EQ(one, trace(4));
}

TEST(Odometry, InAnEndlessCorridorItSaysThatItDoesNotKnowHowFar) {
  const auto path = [](double t) {
    const double x = t < 1 ? 0 : 0.4 * (t - 1) * (t - 1);
    return SE3::from_xyz_rpy((Vector6() << x, 2.2, 0, 0, 0, 0).finished());
  };
  Ride ride(support::endless_corridor().world, path);
  OdometryUpdate last;
  int degenerate = 0;
  for (int i = 0; i < 30; ++i) {
    last = ride.step();
    degenerate += last.degenerate_directions > 0 ? 1 : 0;
    const Vector6 error = ride.error(last);
    EXPECT_LE(std::abs(error[0]), 3 * std::sqrt(last.T_odom_base.covariance(0, 0)) + 0.01) << "scan " << i;
  }
  EXPECT_GT(degenerate, 20);
  EXPECT_GT(std::sqrt(last.T_odom_base.covariance(0, 0)), 0.3) << "along the corridor";
  EXPECT_LT(std::abs(ride.error(last)[1]), 0.03) << "across it is known";
}

TEST(Odometry, NoiseIsRefusedAndTheRideGoesOnAfterwards) {
  Ride ride(support::lobby().world, drive);
  for (int i = 0; i < 15; ++i) ride.step();
  Scan noise;
  noise.valid = {Time{from_seconds(1.5)}, Time{from_seconds(1.59)}};
  std::mt19937 random(1);
  std::uniform_real_distribution<float> at(-20, 20);
  for (int i = 0; i < 20000; ++i)
    noise.cloud.push_back({at(random), at(random), at(random)}, 1, 0, 0, ReturnType::kStrongest);
  Budget budget = Budget::steps(12);
  const auto lost = ride.odometry().update(noise, budget);
  ASSERT_TRUE(lost);
  EXPECT_TRUE(lost->lost);
  EXPECT_LE(lost->iterations, 12);
  OdometryUpdate last;
  for (int i = 0; i < 10; ++i) last = ride.step();
  EXPECT_FALSE(last.lost);
  EXPECT_LT(ride.error(last).head<3>().norm(), 0.05);
}

TEST(Odometry, BadScansAreErrorsAndChangeNothing) {
  Ride ride(support::lobby().world, drive);
  const OdometryUpdate before = ride.step();
  Budget budget = Budget::steps(3);
  Scan late;
  late.valid = {before.stamp, before.stamp};
  EXPECT_EQ(ride.odometry().update(late, budget).error().code, Errc::kMalformed) << "not later than the last one";
  Scan uneven;
  uneven.valid = {before.stamp + Duration{1}, before.stamp + Duration{2}};
  uneven.cloud.xyz.resize(3);
  EXPECT_EQ(ride.odometry().update(uneven, budget).error().code, Errc::kMalformed);
  EXPECT_FALSE(ride.step().lost);
}

TEST(Odometry, PointsThatAreNotFiniteDoNoHarm) {
  Ride clean(support::lobby().world, drive);
  clean.step();
  support::Vlp16 lidar(kMount, 0.02, 3);
  Scan scan = lidar.scan(support::lobby().world, drive, 0.1);
  for (std::size_t i = 0; i < scan.cloud.size(); i += 50)
    scan.cloud.xyz[i].x() = i % 100 == 0 ? std::numeric_limits<float>::quiet_NaN() : 1e30F;
  const OdometryUpdate update = clean.feed(scan);
  EXPECT_TRUE(update.T_odom_base.covariance.allFinite());
  EXPECT_FALSE(update.lost);
}

}  // namespace
}  // namespace cairn::odometry
