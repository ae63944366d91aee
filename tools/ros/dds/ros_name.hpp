// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace cairn::ros {

/// What keeps a text from being the name of a namespace of ROS, such as "husky" or "team/husky"; empty: nothing does.
[[nodiscard]] std::string namespace_fault(std::string_view text);

/// A robot's name as a namespace of ROS: other characters than letters, digits and _ become _, and a digit in front
/// gets "robot_" before it. An empty name becomes "robot".
[[nodiscard]] std::string namespace_of(std::string_view robot);

/// The DDS topic of a topic of ROS, such as "/husky/odom".
[[nodiscard]] std::string dds_topic_of(std::string_view ros_topic);

}  // namespace cairn::ros
