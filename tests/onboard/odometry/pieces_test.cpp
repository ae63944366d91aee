// SPDX-License-Identifier: Apache-2.0
// Revolutions that come in pieces: a stall of the network cuts them.
#include <cmath>
#include <vector>

#include "tests/onboard/odometry/ride.hpp"

namespace cairn::odometry {
namespace {

constexpr int kScans = 45;

SE3 curve(double t) {
  return SE3::from_xyz_rpy(
      (Vector6() << 5 + 1.2 * t, 4 + 0.5 * std::sin(t), 0, 0, 0, 0.3 * std::sin(0.8 * t)).finished());
}

std::vector<OdometryUpdate> in_whole_revolutions() {
  Ride ride(support::lobby().world, curve);
  std::vector<OdometryUpdate> out;
  while (out.size() < kScans) out.push_back(ride.step());
  return out;
}

/// Where the first piece ends, as a share of the revolution.
class Pieces : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Odometry, Pieces, ::testing::Values(0.004, 0.12, 0.5, 0.88, 0.992));

/// From the 20th scan on every sixth one comes in two pieces.
Result<OdometryUpdate> step(Ride& ride, int scan, double share) {
  if (scan <= 20 || scan % 6 != 0) return ride.step();
  return ride.step_in_two(share)[1];
}

TEST_P(Pieces, TellNoMotionThatWholeRevolutionsDoNotTell) {
  static const std::vector<OdometryUpdate> usual = in_whole_revolutions();
  Ride ride(support::lobby().world, curve);
  int left_out = 0;
  for (int i = 0; i < kScans; ++i) {
    const auto update = step(ride, i, GetParam());
    if (!update) {
      EXPECT_EQ(update.error().code, Errc::kTruncated) << i;
      ++left_out;
      continue;
    }
    const OdometryUpdate& expected = usual[static_cast<std::size_t>(i)];
    EXPECT_LT((expected.T_odom_base.mean.inverse() * update->T_odom_base.mean).translation().norm(), 0.02) << i;
    EXPECT_LT((expected.twist - update->twist).norm(), 0.1) << i;
  }
  EXPECT_TRUE(left_out == 0 || GetParam() > 0.99) << "only a few dozen points may not show that they fit";
}

/// The second scan of a map says how the first one is skewed.
TEST(Odometry, AMapsFirstMotionIsThatOfAWholeRevolution) {
  static const std::vector<OdometryUpdate> usual = in_whole_revolutions();
  for (const double share : {0.3, 0.5, 0.72, 0.85}) {
    Ride ride(support::lobby().world, curve);
    ride.step();
    for (const auto& piece : ride.step_in_two(share)) EXPECT_FALSE(piece) << share;
    for (int i = 2; i < kScans; ++i) {
      const OdometryUpdate update = ride.step(), &expected = usual[static_cast<std::size_t>(i)];
      EXPECT_LT((expected.T_odom_base.mean.inverse() * update.T_odom_base.mean).translation().norm(), 0.02) << i;
    }
  }
}

TEST(Odometry, ScansThatBecomeShorterAfterTheFirstOneAreFollowed) {
  Ride ride(support::lobby().world, curve);
  ride.step();
  OdometryUpdate last;
  for (int i = 1; i < 20; ++i)
    for (const auto& half : ride.step_in_two(0.5)) {
      EXPECT_TRUE(half || i <= 3) << i;
      EXPECT_TRUE(!half || i >= 3) << i;
      if (half) last = *half;
    }
  EXPECT_LT(ride.error(last).norm(), 0.1);
}

}  // namespace
}  // namespace cairn::odometry
