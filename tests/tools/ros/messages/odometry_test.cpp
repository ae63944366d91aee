// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/odometry.hpp"

#include <gtest/gtest.h>

namespace cairn::ros {
namespace {

constexpr Duration kPoseUtc = std::chrono::seconds(1'700'000'000);

clients::PoseMessage turned_pose() {
  clients::PoseMessage pose;
  pose.stamp = Time{Duration{1'500'000'000}};
  Vector6 place;
  place << 3, -2, 0.5, 0.2, -0.3, 2.1;
  pose.T_odom_base.mean = SE3::from_xyz_rpy(place);
  Matrix6 root = Matrix6::Zero();
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k <= i; ++k) root(i, k) = 0.01 * (1 + i) + 0.002 * k * k;
  pose.T_odom_base.covariance = root * root.transpose();
  pose.twist << 1, 2, 3, 4, 5, 6;
  return pose;
}

/// How position and orientation change in ROS's sense with each direction of a right perturbation, by differences.
Matrix6 numeric_turn(const SE3& T) {
  constexpr double kStep = 1e-6;
  Matrix6 turn;
  for (int i = 0; i < 6; ++i) {
    const SE3 moved = T * SE3::exp(kStep * Vector6::Unit(i));
    const SE3 fixed_axes(moved.rotation() * T.rotation().transpose(), Eigen::Vector3d::Zero());
    turn.col(i) << (moved.translation() - T.translation()) / kStep, fixed_axes.log().tail<3>() / kStep;
  }
  return turn;
}

TEST(RosOdometry, CovarianceIsOfPositionAndFixedAxesInTheHeadersFrame) {
  const auto pose = turned_pose();
  const Matrix6 turn = numeric_turn(pose.T_odom_base.mean);
  const Matrix6 expected = turn * pose.T_odom_base.covariance * turn.transpose();
  EXPECT_LT((covariance_in_header_frame(pose.T_odom_base) - expected).norm(), 1e-6 * expected.norm());
}

/// A robot that has turned left by a quarter and is unsure along its own x axis is unsure along odom's y axis.
TEST(RosOdometry, UncertaintyAheadOfATurnedRobotIsAcrossInOdom) {
  UncertainPose T;
  Vector6 place = Vector6::Zero();
  place[5] = M_PI / 2;
  T.mean = SE3::from_xyz_rpy(place);
  T.covariance(0, 0) = 4;
  T.covariance(3, 3) = 9;
  const Matrix6 ros = covariance_in_header_frame(T);
  EXPECT_NEAR(ros(1, 1), 4, 1e-12);
  EXPECT_NEAR(ros(0, 0), 0, 1e-12);
  EXPECT_NEAR(ros(4, 4), 9, 1e-12);
}

TEST(RosOdometry, HasPoseInOdomAndTwistInBaseLink) {
  Arena arena;
  const auto pose = turned_pose();
  const Odometry message = odometry_of(pose, Frames("a/"), kPoseUtc, arena);
  EXPECT_STREQ(message.header.frame_id, "a/odom");
  EXPECT_STREQ(message.child_frame_id, "a/base_link");
  EXPECT_EQ(message.header.stamp.sec, 1'700'000'001);
  EXPECT_EQ(message.header.stamp.nanosec, 500'000'000U);
  EXPECT_EQ(message.pose.pose.position.y, -2);
  const auto& q = pose.T_odom_base.mean.quaternion();
  EXPECT_EQ(message.pose.pose.orientation.w, q.w());
  EXPECT_EQ(message.pose.pose.orientation.x, q.x());
  EXPECT_EQ(message.pose.pose.orientation.z, q.z());
  const Matrix6 covariance = covariance_in_header_frame(pose.T_odom_base);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column)
      EXPECT_NEAR(message.pose.covariance[6 * row + column], covariance(row, column), 1e-15);
  EXPECT_EQ(message.twist.twist.linear.y, 2);
  EXPECT_EQ(message.twist.twist.angular.z, 6);
  EXPECT_EQ(message.twist.covariance[0], 0);
}

TEST(RosTf, IsFromOdomToBaseLink) {
  Arena arena;
  const auto pose = turned_pose();
  const TfMessage message = tf_of(pose, {}, Frames(), kPoseUtc, arena);
  ASSERT_EQ(message.transforms._length, 1U);
  const TransformStamped& transform = message.transforms._buffer[0];
  EXPECT_STREQ(transform.header.frame_id, "odom");
  EXPECT_STREQ(transform.child_frame_id, "base_link");
  EXPECT_EQ(transform.transform.translation.x, 3);
  EXPECT_EQ(transform.transform.rotation.y, pose.T_odom_base.mean.quaternion().y());
}

TEST(RosTf, HasTheTeamsFrameAboveOdomIfItIsKnown) {
  Arena arena;
  const SE3 T_team_odom(Eigen::Quaterniond(0.8, 0, 0, 0.6), {5, 6, 7});
  const TfMessage message = tf_of(turned_pose(), T_team_odom, Frames("a/"), kPoseUtc, arena);
  ASSERT_EQ(message.transforms._length, 2U);
  const TransformStamped& transform = message.transforms._buffer[1];
  EXPECT_STREQ(transform.header.frame_id, "team");
  EXPECT_STREQ(transform.child_frame_id, "a/odom");
  EXPECT_EQ(transform.transform.translation.z, 7);
  EXPECT_EQ(transform.transform.rotation.z, 0.6);
  EXPECT_EQ(transform.header.stamp.nanosec, message.transforms._buffer[0].header.stamp.nanosec);
}

TEST(RosTf, StaticHasAllSensorsInOneMessage) {
  Arena arena;
  const std::vector<clients::HelloMessage::Sensor> sensors{
      {"lidar", SE3(Eigen::Quaterniond::Identity(), {0.1, 0, 0.4})}, {"camera", SE3()}};
  const TfMessage message = tf_static_of(sensors, Frames("a/"), Time{}, kPoseUtc, arena);
  ASSERT_EQ(message.transforms._length, 2U);
  EXPECT_STREQ(message.transforms._buffer[0].header.frame_id, "a/base_link");
  EXPECT_STREQ(message.transforms._buffer[0].child_frame_id, "a/lidar");
  EXPECT_EQ(message.transforms._buffer[0].transform.translation.z, 0.4);
  EXPECT_STREQ(message.transforms._buffer[1].child_frame_id, "a/camera");
  EXPECT_EQ(message.transforms._buffer[1].transform.rotation.w, 1);
}

}  // namespace
}  // namespace cairn::ros
