// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/stereo_odometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/support/stereo_view.hpp"

namespace cairn::visual_odometry {
namespace {

const stereo::StereoGeometry kFlightEyes = support::small_eyes();
const SE3 kFlightMount =
    SE3::from_xyz_rpy((Vector6() << 0.1, 0, 0, 0, 0.2, 0).finished()) * cameras::T_camera_optical();
constexpr double kPeriod_s = 1.0 / 15;

VisualOdometryConfig quick() {
  VisualOdometryConfig config;
  config.tracking.features = 120;
  config.tracking.spacing_px = 12;
  return config;
}

/// A flight through the furnished room.
SE3 flown(double t) {
  return SE3::from_xyz_rpy(
      (Vector6() << -3 + 0.5 * t, 0.3 * std::sin(t), 1.5 + 0.1 * std::sin(2 * t), 0.03 * std::sin(3 * t), 0, 0.2 * t)
          .finished());
}

struct Flight {
  std::vector<VisualUpdate> updates;
  std::vector<SE3> truth;  // since the start
};

/// `path`: T_world_base at a time. `dark`: whether the picture is black then.
Flight fly(int pictures, const std::function<SE3(double)>& path, const std::function<bool(double)>& dark = {},
           const VisualOdometryConfig& config = quick()) {
  const support::World world = support::furnished_room();
  support::StereoView view(world, kFlightEyes, 11);
  StereoOdometry odometry(config, kFlightEyes, kFlightMount);
  stereo::StereoPair pair;
  Flight flight;
  for (int i = 0; i < pictures; ++i) {
    const double t = kPeriod_s * i;
    view.shoot(path(t) * kFlightMount, Time{from_seconds(1 + t)}, pair);
    if (dark && dark(t))
      for (Image* eye : {&pair.left, &pair.right}) std::ranges::fill(eye->bytes, std::byte{5});
    Budget budget = Budget::steps(most_steps(config));
    flight.updates.push_back(odometry.update(pair, budget).value());
    flight.truth.push_back(path(0).inverse() * path(t));
  }
  return flight;
}

double error_of(const Flight& flight, std::size_t i) {
  return (flight.updates[i].T_odom_base.mean.translation() - flight.truth[i].translation()).norm();
}

TEST(StereoOdometry, FollowsAFlightThroughARoom) {
  const Flight flight = fly(30, flown);
  EXPECT_TRUE(flight.updates.front().began);
  for (std::size_t i = 1; i < flight.updates.size(); ++i) {
    EXPECT_FALSE(flight.updates[i].lost) << i;
    EXPECT_LT(error_of(flight, i), 0.05) << i;
  }
  const VisualUpdate& last = flight.updates.back();
  const Vector6 error = (last.T_odom_base.mean.inverse() * flight.truth.back()).log();
  for (int k = 0; k < 6; ++k) EXPECT_LT(std::abs(error[k]), 4 * std::sqrt(last.T_odom_base.covariance(k, k))) << k;
  EXPECT_NEAR(last.twist.head<3>().norm(), 0.58, 0.25);
}

/// Of a flight that turns to and fro, by up to 1 rad/s, with a shutter that takes 16 ms; m, root mean square.
double error_with_rolling_shutter(bool known) {
  stereo::StereoGeometry rolling = kFlightEyes;
  rolling.line_time_s = 1e-4;
  const auto turning = [](double t) {  // from rest: how fast a robot begins, no picture tells
    const double to_and_fro = 1 - std::cos(2 * t);
    return SE3::from_xyz_rpy(
        (Vector6() << -3 + 0.4 * to_and_fro, 0, 1.5, 0, 0.1 * to_and_fro, 0.5 * to_and_fro).finished());
  };
  const support::World world = support::furnished_room();
  support::StereoView view(world, rolling, 11);
  StereoOdometry odometry(quick(), known ? rolling : kFlightEyes, kFlightMount);
  stereo::StereoPair pair;
  double squared = 0;
  constexpr int kPictures = 30;
  for (int i = 0; i < kPictures; ++i) {
    const double t = kPeriod_s * i;
    view.shoot([&](double after_s) { return turning(t + after_s) * kFlightMount; }, Time{from_seconds(1 + t)}, pair);
    Budget budget = Budget::steps(most_steps(quick()));
    const SE3 said = odometry.update(pair, budget).value().T_odom_base.mean;
    squared += (said.inverse() * turning(0).inverse() * turning(t)).translation().squaredNorm();
  }
  return std::sqrt(squared / kPictures);
}

TEST(StereoOdometry, ARollingShutterThatIsKnownDoesLittleHarm) {
  const double known = error_with_rolling_shutter(true), ignored = error_with_rolling_shutter(false);
  EXPECT_LT(known, 0.02);
  EXPECT_GT(ignored, 2 * known);
}

TEST(StereoOdometry, StandsStill) {
  const Flight flight = fly(12, [](double) { return flown(0); });
  for (std::size_t i = 0; i < flight.updates.size(); ++i) EXPECT_LT(error_of(flight, i), 0.01);
  EXPECT_LT(flight.updates.back().twist.norm(), 0.05);
}

TEST(StereoOdometry, ADozenLandmarksAreEnough) {
  VisualOdometryConfig few = quick();
  few.tracking.features = 14;  // before a plain wall, there are no more
  const Flight flight = fly(15, flown, {}, few);
  for (std::size_t i = 1; i < flight.updates.size(); ++i) {
    EXPECT_FALSE(flight.updates[i].lost) << i;
    EXPECT_LT(error_of(flight, i), 0.05) << i;
  }
}

TEST(StereoOdometry, AShortDarknessIsSaidAndBridged) {
  const Flight flight = fly(28, flown, [](double t) { return t > 1.0 && t < 1.3; });
  bool lost = false;
  for (const VisualUpdate& u : flight.updates) lost = lost || u.lost;
  EXPECT_TRUE(lost);
  EXPECT_FALSE(flight.updates.back().lost);
  EXPECT_FALSE(flight.updates.back().reinitialised);
  EXPECT_LT(error_of(flight, flight.updates.size() - 1), 0.08);
}

TEST(StereoOdometry, AfterALongDarknessANewMapBeginsAndIsSaid) {
  const auto path = [](double t) {
    return t < 1 ? flown(t) : SE3::from_xyz_rpy((Vector6() << 0, 0, 1.5, 0, 0, 3).finished());
  };
  const Flight flight = fly(45, path, [](double t) { return t > 0.9 && t < 2.7; });
  const auto anew = std::ranges::find_if(flight.updates, [](const VisualUpdate& u) { return u.reinitialised; });
  ASSERT_NE(anew, flight.updates.end());
  EXPECT_TRUE(anew->apart());
  EXPECT_TRUE(anew->lost);
  EXPECT_FALSE(flight.updates.back().lost);
}

/// Its nose is 0.2 rad down when the darkness comes: the new map does not keep all of that.
TEST(StereoOdometry, AMapThatBeginsAfterALongDarknessIsNearlyLevel) {
  const auto path = [](double t) {
    if (t > 1) return SE3::from_xyz_rpy((Vector6() << 0, 0, 1.5, 0, 0, 3).finished());
    const double nod = 0.2 * std::clamp((t - 0.1) / 0.5, 0.0, 1.0);
    return flown(t) * SE3::from_xyz_rpy((Vector6() << 0, 0, 0, 0, nod, 0).finished());
  };
  const auto tilt = [](const VisualUpdate& u) { return std::acos(u.T_odom_base.mean.rotation()(2, 2)); };
  const Flight flight = fly(45, path, [](double t) { return t > 0.9 && t < 2.7; });
  const auto followed = std::ranges::find_if(flight.updates, &VisualUpdate::lost);
  const auto anew = std::ranges::find_if(flight.updates, &VisualUpdate::reinitialised);
  ASSERT_NE(anew, flight.updates.end());
  EXPECT_NEAR(tilt(*std::prev(followed)), 0.2, 0.03);
  EXPECT_LT(tilt(*anew), 0.14);
}

/// An odometry that flies for a second, and what it leaves.
struct Ended {
  std::vector<Keyframe> keyframes;
  VisualUpdate last;
};
Ended fly_and_end(support::StereoView& view) {
  StereoOdometry odometry(quick(), kFlightEyes, kFlightMount);
  stereo::StereoPair pair;
  Ended ended;
  for (int i = 0; i < 15; ++i) {
    view.shoot(flown(kPeriod_s * i) * kFlightMount, Time{from_seconds(1 + kPeriod_s * i)}, pair);
    Budget budget = Budget::steps(most_steps(quick()));
    ended.last = odometry.update(pair, budget).value();
    if (odometry.new_keyframe() != nullptr) ended.keyframes.push_back(*odometry.new_keyframe());
  }
  return ended;
}

TEST(StereoOdometry, GoesOnWhereAnotherOneEnded) {
  const support::World world = support::furnished_room();
  support::StereoView view(world, kFlightEyes, 11);
  const Ended ended = fly_and_end(view);
  StereoOdometry odometry(quick(), kFlightEyes, kFlightMount);
  odometry.resume(ended.last.T_odom_base, ended.last.twist, ended.last.stamp, ended.keyframes);
  EXPECT_TRUE(odometry.resuming());
  stereo::StereoPair pair;
  for (int i = 25; i < 32; ++i) {
    view.shoot(flown(kPeriod_s * i) * kFlightMount, Time{from_seconds(1 + kPeriod_s * i)}, pair);
    Budget budget = Budget::steps(most_steps(quick()));
    const VisualUpdate u = odometry.update(pair, budget).value();
    EXPECT_FALSE(u.lost || u.began || u.apart()) << i;
    EXPECT_FALSE(odometry.resuming());
    const SE3 truth = flown(0).inverse() * flown(kPeriod_s * i);
    EXPECT_LT((u.T_odom_base.mean.translation() - truth.translation()).norm(), 0.05) << i;
  }
}

TEST(StereoOdometry, WhereNoPictureShowsTheSavedPlaceAMapBeginsAnew) {
  const support::World world = support::furnished_room();
  support::StereoView view(world, kFlightEyes, 11);
  const Ended ended = fly_and_end(view);
  StereoOdometry odometry(quick(), kFlightEyes, kFlightMount);
  odometry.resume(ended.last.T_odom_base, ended.last.twist, ended.last.stamp, ended.keyframes);
  const SE3 elsewhere = SE3::from_xyz_rpy((Vector6() << 0, 0, 1.5, 0, 0, 3).finished());
  stereo::StereoPair pair;
  std::vector<VisualUpdate> updates;
  for (int i = 0; i < 26; ++i) {
    view.shoot(elsewhere * kFlightMount, Time{from_seconds(12 + kPeriod_s * i)}, pair);
    Budget budget = Budget::steps(most_steps(quick()));
    updates.push_back(odometry.update(pair, budget).value());
    EXPECT_FALSE(updates.back().began);
    if (updates.back().apart()) break;
  }
  EXPECT_TRUE(updates.back().apart());
  EXPECT_GT(updates.back().stamp - updates.front().stamp, from_seconds(quick().give_up_after_s));
  EXPECT_TRUE(std::ranges::all_of(updates, &VisualUpdate::lost));
  EXPECT_FALSE(odometry.resuming());
}

TEST(StereoOdometry, APictureThatIsNotLaterIsRefused) {
  const support::World world = support::furnished_room();
  support::StereoView view(world, kFlightEyes, 1);
  StereoOdometry odometry(quick(), kFlightEyes, kFlightMount);
  stereo::StereoPair pair;
  view.shoot(flown(0) * kFlightMount, Time{from_seconds(2)}, pair);
  Budget budget = Budget::steps(10);
  ASSERT_TRUE(odometry.update(pair, budget));
  EXPECT_EQ(odometry.update(pair, budget).error().code, Errc::kMalformed);
}

TEST(StereoOdometry, TheSamePicturesGiveTheSameBits) {
  const Flight a = fly(8, flown), b = fly(8, flown);
  for (std::size_t i = 0; i < a.updates.size(); ++i) {
    EXPECT_EQ(a.updates[i].T_odom_base.mean.matrix(), b.updates[i].T_odom_base.mean.matrix());
    EXPECT_EQ(a.updates[i].T_odom_base.covariance, b.updates[i].T_odom_base.covariance);
  }
}

}  // namespace
}  // namespace cairn::visual_odometry
