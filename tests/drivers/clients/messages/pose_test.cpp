// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/pose.hpp"

#include <limits>

#include "tests/drivers/clients/messages/message_checks.hpp"

namespace cairn::clients {
namespace {

PoseMessage some_pose() {
  PoseMessage pose;
  pose.stamp = Time{Duration{123'456'789}};
  pose.predicted = true;
  pose.degenerate_directions = 2;
  pose.epoch = 4;
  pose.T_odom_base.mean = SE3::from_xyz_rpy((Vector6() << 1, -2, 0.5, 0.1, -0.2, 3).finished());
  const Matrix6 root = Matrix6::Random();
  pose.T_odom_base.covariance = root * root.transpose();
  pose.twist << 1, 2, 3, 4, 5, 6;
  return pose;
}

TEST(PoseMessage, ComesBackAsItWasSent) {
  const PoseMessage sent = some_pose();
  const auto body = test::body_of(sent);
  EXPECT_EQ(body.size(), 288U);
  const auto got = decode_pose(body);
  ASSERT_TRUE(got) << to_string(got.error());
  EXPECT_EQ(got->stamp, sent.stamp);
  EXPECT_TRUE(got->predicted);
  EXPECT_FALSE(got->lost);
  EXPECT_EQ(got->degenerate_directions, 2);
  EXPECT_EQ(got->epoch, 4U);
  EXPECT_EQ(got->T_odom_base.mean.translation(), sent.T_odom_base.mean.translation());
  EXPECT_LT((got->T_odom_base.mean.inverse() * sent.T_odom_base.mean).log().norm(), 1e-12);
  EXPECT_EQ(got->T_odom_base.covariance, Matrix6(sent.T_odom_base.covariance.selfadjointView<Eigen::Upper>()));
  EXPECT_EQ(got->twist, sent.twist);
  test::expect_exact(body, decode_pose);
}

TEST(PoseMessage, NoVarianceIsNegative) {
  auto body = test::body_of(some_pose());
  constexpr std::size_t kHighestByteOfRoll = 72 + 15 * 8 + 7;
  body[kHighestByteOfRoll] |= std::byte{0x80};
  EXPECT_FALSE(decode_pose(body));
}

TEST(PoseMessage, AVarianceThatRoundingLeftBelowZeroIsSentAsZero) {
  PoseMessage pose = some_pose();
  pose.T_odom_base.covariance(3, 3) = -1e-18;
  const auto got = decode_pose(test::body_of(pose));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->T_odom_base.covariance(3, 3), 0);
  pose.T_odom_base.covariance(3, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(decode_pose(test::body_of(pose)));
}

TEST(PoseMessage, UnknownFlagsAndDirectionsAreRefused) {
  auto body = test::body_of(some_pose());
  body[8] = std::byte{4};
  EXPECT_FALSE(decode_pose(body));
  body = test::body_of(some_pose());
  body[9] = std::byte{7};
  EXPECT_FALSE(decode_pose(body));
}

}  // namespace
}  // namespace cairn::clients
