// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/wheels.hpp"

#include <gtest/gtest.h>

namespace cairn::ros {
namespace {

TEST(RosWheels, AreJointsThatTurn) {
  clients::WheelsMessage wheels{.stamp = Time{std::chrono::seconds(1)}, .radius_m = 0.2};
  wheels.wheels = {{clients::WheelPlace::kLeft, 1, 0.4}, {clients::WheelPlace::kRight, -2, -0.1}};
  Arena arena;
  const JointState joints = joint_state_of(wheels, Frames("h1/"), std::chrono::seconds(7), arena);
  EXPECT_EQ(joints.header.stamp.sec, 8);
  EXPECT_STREQ(joints.header.frame_id, "");
  ASSERT_EQ(joints.name._length, 2U);
  EXPECT_STREQ(joints.name._buffer[0], "h1/left_wheel_joint");
  EXPECT_STREQ(joints.name._buffer[1], "h1/right_wheel_joint");
  ASSERT_EQ(joints.position._length, 2U);
  EXPECT_EQ(joints.position._buffer[0], 5);
  EXPECT_EQ(joints.position._buffer[1], -10);
  EXPECT_EQ(joints.velocity._buffer[0], 2);
  EXPECT_EQ(joints.effort._length, 0U);
}

}  // namespace
}  // namespace cairn::ros
