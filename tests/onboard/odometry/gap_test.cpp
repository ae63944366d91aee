// SPDX-License-Identifier: Apache-2.0
// Times in which no scan comes, or none that fits.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/onboard/odometry/ride.hpp"

namespace cairn::odometry {
namespace {

/// From 1.5 s on: 3.6 m ahead in 3 s, half a turn in 2 s, and 3.6 m on in the new direction.
SE3 there_and_back(double t) {
  const double since = std::clamp(t - 1.5, 0.0, 8.0);
  const double x = since < 3 ? 1.2 * since : since < 5 ? 3.6 : 3.6 - 1.2 * (since - 5);
  const double yaw = std::clamp((since - 3) / 2, 0.0, 1.0) * std::numbers::pi;
  return SE3::from_xyz_rpy((Vector6() << 8 + x, 4, 0, 0, 0, yaw).finished());
}

Scan blind(double t) {
  Scan scan;
  scan.valid = {Time{from_seconds(t - 0.1)}, Time{from_seconds(t)}};
  return scan;
}

TEST(Gap, FiveSecondsWithATurnAreBridgedByTheWheels) {
  for (const auto& scene : {support::lobby(), support::office()}) {
    Ride ride(scene.world, there_and_back);
    ride.roll([&](double t) { return ride.true_wheels(t); });
    for (int i = 0; i < 25; ++i) ride.step();
    ride.lose(50);
    OdometryUpdate last;
    for (int i = 0; i < 3; ++i) {
      last = ride.step();
      EXPECT_FALSE(last.lost) << i;
    }
    EXPECT_LT(ride.error(last).head<3>().norm(), 0.1);
    EXPECT_LT(ride.error(last).tail<3>().norm(), 0.03);
  }
}

/// Without wheels the robot may be found or not. It is never taken for somewhere else.
TEST(Gap, WithoutWheelsAPlaceThatLooksAlikeIsNotBelieved) {
  for (const auto& scene : {support::office(), support::corridor()}) {
    Ride ride(scene.world, there_and_back);
    for (int i = 0; i < 25; ++i) ride.step();
    ride.lose(50);
    for (int i = 0; i < 3; ++i) {
      const OdometryUpdate update = ride.step();
      const Eigen::Vector2d sigma = update.T_odom_base.covariance.diagonal().head<2>().cwiseSqrt();
      const Vector6 error = ride.error(update);
      EXPECT_LT(std::abs(error[0]), 3 * sigma[0] + 0.05) << i << " lost: " << update.lost;
      EXPECT_LT(std::abs(error[1]), 3 * sigma[1] + 0.05) << i << " lost: " << update.lost;
    }
  }
}

/// For ten seconds nothing tells its way. A robot that stood meanwhile goes on. One that moved may be at any place that
/// looks alike: it begins a map of its own, at once. Where the scan fits in the map before is told as a guess.
TEST(Gap, AfterALongSilenceOnlyARobotThatStoodGoesOn) {
  for (const bool stands : {true, false}) {
    Ride ride(support::lobby().world, [stands](double t) { return there_and_back(stands ? std::min(t, 2.0) : t); });
    for (int i = 0; i < 25; ++i) ride.step();
    ride.lose(100);
    OdometryUpdate update;
    int scans = 0;
    do update = ride.step();
    while (++scans < 10 && update.lost && !update.reinitialised);
    EXPECT_EQ(update.apart(), !stands);
    EXPECT_EQ(scans, stands ? 1 : OdometryConfig{}.second_look.blind_patience);
    if (stands) {
      EXPECT_LT(ride.error(update).head<3>().norm(), 0.05);
    } else {
      const SE3 off = ride.error_of_guess(update);
      EXPECT_LT(off.translation().norm(), 0.2);
      EXPECT_LT(rotation_angle(off), 0.02);
    }
  }
}

/// It went round a circle unseen, and drives by where it was last seen.
TEST(Gap, ARobotThatDrivesByItsLastPlaceDidNotStand) {
  const auto round = [](double t) {
    const double yaw = 2 * std::numbers::pi * t / 8;
    return SE3::from_xyz_rpy((Vector6() << 12 + 1.5 * std::sin(yaw), 4 - 1.5 * std::cos(yaw), 0, 0, 0, yaw).finished());
  };
  Ride ride(support::lobby().world, round);
  for (int i = 0; i < 25; ++i) ride.step();
  ride.lose(78);
  OdometryUpdate update;
  do update = ride.step();
  while (update.lost && !update.reinitialised);
  EXPECT_TRUE(update.apart());
}

/// The wheels spin on the spot while the robot stands.
TEST(Gap, WheelsThatSpinAreFoundOut) {
  Ride ride(support::lobby().world, [](double) { return there_and_back(2); });
  const auto spinning = [&](double t) {
    DriveState state = ride.true_wheels(t);
    const double spun = std::max(t - 2, 0.0);
    state.T_odom_base.mean = state.T_odom_base.mean * SE3::exp((Vector6() << spun, 0, 0, 0, 0, 0).finished());
    return state;
  };
  ride.roll(spinning);
  for (int i = 0; i < 20; ++i) ride.step();
  ride.lose(20);
  OdometryUpdate last;
  for (int i = 0; i < 3; ++i) last = ride.step();
  EXPECT_FALSE(last.lost);
  EXPECT_LT(ride.error(last).norm(), 0.05);
}

/// Two rooms alike. The robot drives from one into the other unseen, and only its wheels tell. If it is seen where they
/// exclude that it is, the map that begins is one of its own.
TEST(Gap, AfterALongSilenceAPlaceThatTheWheelsExcludeIsNotBelieved) {
  constexpr double kApart_m = 12;
  support::World world;
  world.plane(Eigen::Vector3d::UnitZ(), 0);
  for (const double y : {0.0, kApart_m}) {
    world.box({0, y, -0.5}, {8, y + 6, 3})
        .box({1, y + 1, 0}, {1.8, y + 2.2, 1.5})
        .box({6, y + 4, 0}, {6.6, y + 4.5, 2});
    world.trunk(3, y + 5, 0.2);
  }
  const auto into_the_other = [](double t) {
    const double gone = std::clamp((t - 2.5) / 10, 0.0, 1.0);
    const double x = 3 + 0.5 * std::min(t, 2.5) - 2 * gone, y = 2.5 + kApart_m * gone;
    return SE3::from_xyz_rpy((Vector6() << x, y, 0, 0, 0, 0.3).finished());
  };
  Ride ride(world, into_the_other);
  ride.roll([&](double t) { return ride.true_wheels(t); });
  for (int i = 0; i < 25; ++i) ride.step();
  ride.lose(100);
  OdometryUpdate update;
  do {
    update = ride.step();
    EXPECT_LT(ride.error(update).head<3>().norm(), 0.3);
  } while (update.lost && !update.reinitialised);
  EXPECT_TRUE(update.apart());
  EXPECT_LT(ride.error_of_guess(update).translation().norm(), 0.3) << "the guess is the wheels'";
}

/// It has driven into another room, and sees the one before through the door alone: a tenth of its points. That says
/// less than the wheels.
TEST(Gap, AfterALongSilenceFewPointsThatFitSayNothing) {
  support::World world;
  world.plane(Eigen::Vector3d::UnitZ(), 0).box({0, 0, -0.5}, {20, 6, 3});
  world.box({7.9, 0, 0}, {8.1, 2.5, 3}).box({7.9, 3.5, 0}, {8.1, 6, 3}).box({2, 5, 0}, {3, 6, 2});
  const auto through_the_door = [](double t) {
    const double gone = std::clamp((t - 2.5) / 10, 0.0, 1.0);
    const double x = 3 + 0.5 * std::min(t, 2.5) + 10 * gone;
    return SE3::from_xyz_rpy((Vector6() << x, 3 + gone, 0, 0, 0, 0).finished());
  };
  Ride ride(world, through_the_door);
  ride.roll([&](double t) {
    DriveState state = ride.true_wheels(t);
    state.T_odom_base.covariance = 0.01 * (1 + t) * Matrix6::Identity();
    return state;
  });
  for (int i = 0; i < 25; ++i) ride.step();
  ride.lose(100);
  const OdometryUpdate update = ride.step();
  EXPECT_TRUE(update.lost);
  EXPECT_LT(ride.error(update).head<3>().norm(), 0.05) << "where the wheels say";
}

/// Where wheels say how the new map lies to the one before, it goes on. Where nothing does, it is a map of its own.
TEST(Gap, AMapThatBeginsSomewhereUnknownIsApart) {
  for (const bool wheels : {false, true}) {
    Ride ride(support::lobby().world, there_and_back);
    if (wheels) ride.roll([&](double t) { return ride.true_wheels(t); });
    for (int i = 0; i < 30; ++i) ride.step();
    int lost = 0;
    OdometryUpdate update;
    for (; !update.reinitialised && lost < 100; ++lost) update = ride.feed(blind(3.1 + 0.1 * lost));
    EXPECT_EQ(lost, wheels ? OdometryConfig{}.reinitialise_after : OdometryConfig{}.give_up_after);
    EXPECT_EQ(update.apart(), !wheels);
  }
}

/// The base drives over a bump when the scans cease. The new map would lean by as much, and the next by more.
TEST(Gap, AMapThatBeginsAfterALongSilenceDoesNotKeepTheTiltOfTheOneBefore) {
  const auto onto_a_bump = [](double t) {
    const double up = std::clamp(t - 1.5, 0.0, 1.0);
    return SE3::from_xyz_rpy((Vector6() << 8 + t, 4, 0.1 * up, 0, -0.12 * up, 0).finished());
  };
  Ride ride(support::lobby().world, onto_a_bump);
  OdometryUpdate update;
  for (int i = 0; i < 25; ++i) update = ride.step();
  EXPECT_NEAR(update.T_odom_base.mean.xyz_rpy()[4], -0.12, 0.02);
  for (int lost = 0; !update.reinitialised && lost < 100; ++lost) update = ride.feed(blind(12.5 + 0.1 * lost));
  EXPECT_TRUE(update.apart());
  EXPECT_LT(std::abs(update.T_odom_base.mean.xyz_rpy()[4]), 0.01);
  EXPECT_LT(std::abs(update.T_odom_base.mean.translation().z()), 0.5) << "ten seconds uphill would be 1.2 m";
}

}  // namespace
}  // namespace cairn::odometry
