// SPDX-License-Identifier: Apache-2.0
// What wheels add where scans leave a direction open, and where they do not.
#include <algorithm>
#include <cmath>

#include "tests/onboard/odometry/ride.hpp"

namespace cairn::odometry {
namespace {

constexpr double kTrack_m = 0.55;

/// A corridor without an end and without a feature.
support::World endless_corridor() {
  return support::World().plane({0, 0, 1}, 0).plane({0, 0, 1}, 2.5).plane({0, 1, 0}, -1.5).plane({0, 1, 0}, 1.5);
}

/// Stands for a second, drives on at 1.2 m/s with a slow weave, and stops after ten more.
SE3 weave(double t) {
  const double since = std::clamp(t - 1, 0.0, 10.0);
  const double x = 1.2 * (since - std::sin(since * std::numbers::pi / 5) * 5 / std::numbers::pi / 2);
  return SE3::from_xyz_rpy((Vector6() << x, 0.1 * std::sin(x), 0, 0, 0, 0.1 * std::cos(x) - 0.1).finished());
}

/// The largest error along the corridor of a ride of 12 s, in m.
double worst_along(Ride& ride) {
  double worst = 0;
  for (int i = 0; i < 120; ++i) {
    const OdometryUpdate update = ride.step();
    EXPECT_FALSE(update.lost) << i;
    worst = std::max(worst, std::abs(ride.error(update)[0]));
  }
  return worst;
}

TEST(Wheels, TellTheWayAlongACorridorWithoutFeatures) {
  Ride alone(endless_corridor(), weave), aided(endless_corridor(), weave);
  aided.roll([&](double t) { return aided.true_wheels(t); });
  EXPECT_GT(worst_along(alone), 1) << "the corridor has features: the test shows nothing";
  EXPECT_LT(worst_along(aided), 0.05);
}

TEST(Wheels, TheirOwnErrorIsInTheCovariance) {
  Ride ride(endless_corridor(), weave);
  ride.roll([&](double t) {
    DriveState state = ride.true_wheels(t);
    const double way = state.T_odom_base.mean.translation().x();
    state.T_odom_base.mean = state.T_odom_base.mean * SE3::exp((Vector6() << 0.03 * way, 0, 0, 0, 0, 0).finished());
    return state;
  });
  for (int i = 0; i < 120; ++i) {
    const OdometryUpdate update = ride.step();
    EXPECT_LT(std::abs(ride.error(update)[0]), 3 * std::sqrt(update.T_odom_base.covariance(0, 0)) + 0.02) << i;
  }
}

/// Of two wheels the right one turns half as fast again, from 5 s to 7 s.
class SlippingWheels {
 public:
  explicit SlippingWheels(const Ride& ride) : ride_(ride) {}
  DriveState operator()(double t) {
    DriveState state = ride_.true_wheels(t);
    const double slipped_m = 0.6 * std::clamp(t - 5, 0.0, 2.0);
    const double more_m = slipped_m - slipped_m_;
    const SE3 base = state.T_odom_base.mean;
    if (last_) T_odom_base_ = T_odom_base_ * (last_->inverse() * base);
    T_odom_base_ = T_odom_base_ * SE3::exp((Vector6() << more_m / 2, 0, 0, 0, 0, more_m / kTrack_m).finished());
    last_ = base;
    slipped_m_ = slipped_m;
    state.T_odom_base.mean = T_odom_base_;
    return state;
  }

 private:
  const Ride& ride_;
  std::optional<SE3> last_;
  SE3 T_odom_base_;
  double slipped_m_ = 0;
};

TEST(Wheels, OneThatSlipsDoesNoHarm) {
  Ride sound(endless_corridor(), weave), slipping(endless_corridor(), weave);
  sound.roll([&](double t) { return sound.true_wheels(t); });
  slipping.roll(SlippingWheels(slipping));
  EXPECT_LT(worst_along(slipping), worst_along(sound) + 0.15) << "the wheels were off by 0.6 m";
}

TEST(Wheels, ChangeNothingWhereScansTellEverything) {
  const support::Scene scene = support::lobby();
  const auto path = [](double t) { return SE3::from_xyz_rpy((Vector6() << 6 + 0.8 * t, 4, 0, 0, 0, 0).finished()); };
  Ride alone(scene.world, path), aided(scene.world, path);
  aided.roll(SlippingWheels(aided));
  for (int i = 0; i < 70; ++i) {
    const SE3 a = alone.step().T_odom_base.mean, b = aided.step().T_odom_base.mean;
    EXPECT_EQ(a.translation(), b.translation()) << i;
  }
}

}  // namespace
}  // namespace cairn::odometry
