// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/dds/ros_name.hpp"

#include <gtest/gtest.h>

namespace cairn::ros {
namespace {

TEST(RosName, OfARobotHasOnlyWhatRosAllows) {
  EXPECT_EQ(namespace_of("husky"), "husky");
  EXPECT_EQ(namespace_of("Husky-1 (blue)"), "Husky_1_blue_");
  EXPECT_EQ(namespace_of("7"), "robot_7");
  EXPECT_EQ(namespace_of(""), "robot");
  for (const char* robot : {"husky", "Husky-1 (blue)", "7", "", "ä", "a__b", "/", "--"})
    EXPECT_EQ(namespace_fault(namespace_of(robot)), "") << robot;
}

TEST(RosName, FaultsOfNamespacesAreNamed) {
  EXPECT_EQ(namespace_fault("team/husky_1"), "");
  for (const char* wrong : {"", "/husky", "husky/", "a//b", "1husky", "a/1", "a b", "a-b", "a__b", "~"})
    EXPECT_NE(namespace_fault(wrong), "") << wrong;
  EXPECT_NE(namespace_fault(std::string(500, 'a')), "");
}

TEST(RosName, OfATopicHasRosPrefixOnTheWire) { EXPECT_EQ(dds_topic_of("/husky/odom"), "rt/husky/odom"); }

}  // namespace
}  // namespace cairn::ros
