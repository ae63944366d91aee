// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/initial_pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace cairn::ros {
namespace {

/// As rviz writes it.
PoseWithCovarianceStamped estimate(std::string& frame) {
  PoseWithCovarianceStamped message{};
  message.header.frame_id = frame.data();
  message.pose.pose.position = {1.5, -2, 0};
  message.pose.pose.orientation.z = std::sin(0.25);
  message.pose.pose.orientation.w = std::cos(0.25);
  message.pose.covariance[0] = message.pose.covariance[7] = 0.25;
  message.pose.covariance[35] = 0.0685;
  return message;
}

TEST(InitialPose, OfRvizIsAPlacement) {
  std::string frame = "husky_1/odom";
  std::string_view why;
  const auto place = placement_from(estimate(frame), why);
  ASSERT_TRUE(place) << why;
  EXPECT_EQ(place->frame.view(), "husky_1");
  EXPECT_EQ(place->x, 1.5);
  EXPECT_EQ(place->y, -2);
  EXPECT_NEAR(place->yaw, 0.5, 1e-12);
  EXPECT_EQ(place->sigma_m, 0.5);
  EXPECT_NEAR(place->sigma_rad, std::sqrt(0.0685), 1e-12);
}

TEST(InitialPose, FramesHaveTheNamesThatUsersSee) {
  const std::pair<const char*, const char*> frames[] = {
      {"team", "team"}, {"map", ""}, {"site", ""}, {"husky_1", "husky_1"}, {"/husky_1/odom", "husky_1"}};
  std::string_view why;
  for (const auto& [ros, cairn] : frames) {
    std::string frame = ros;
    const auto place = placement_from(estimate(frame), why);
    ASSERT_TRUE(place) << ros;
    EXPECT_EQ(place->frame.view(), cairn);
  }
  for (const char* own : {"odom", "/odom", ""}) {
    std::string frame = own;
    EXPECT_FALSE(placement_from(estimate(frame), why)) << own;
    EXPECT_NE(why.find("robot_1/odom"), std::string_view::npos);
  }
}

TEST(InitialPose, WithoutACovarianceIsAsSureAsRviz) {
  std::string frame = "team";
  auto message = estimate(frame);
  for (double& value : message.pose.covariance) value = 0;
  std::string_view why;
  const auto place = placement_from(message, why);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->sigma_m, kGuessedSigma_m);
  EXPECT_EQ(place->sigma_rad, kGuessedSigma_rad);
}

TEST(InitialPose, ThatCannotBeIsRefused) {
  std::string frame = "team";
  std::string_view why;
  auto message = estimate(frame);
  message.pose.pose.position.x = std::nan("");
  EXPECT_FALSE(placement_from(message, why));
  message = estimate(frame);
  message.pose.pose.orientation.w = 0.1;
  EXPECT_FALSE(placement_from(message, why)) << "a quaternion of another length";
  EXPECT_EQ(why, "it is no possible pose");
}

}  // namespace
}  // namespace cairn::ros
