// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include "tools/ros/messages/types.hpp"

namespace cairn::ros {

/// How ROS knows a type of message.
struct RosType {
  const char* name;  ///< as in ROS: "std_msgs/msg/Bool"
  const char* hash;  ///< RIHS01: SHA-256 over the type's description; ROS from Iron on compares it
  const dds_topic_descriptor_t* descriptor;
};

/// The type of a generated struct, for each that is sent or received.
template <class Message>
[[nodiscard]] const RosType& ros_type();

template <>
const RosType& ros_type<BoolMessage>();
template <>
const RosType& ros_type<CameraInfo>();
template <>
const RosType& ros_type<CompressedImage>();
template <>
const RosType& ros_type<DiagnosticArray>();
template <>
const RosType& ros_type<JointState>();
template <>
const RosType& ros_type<MarkerArray>();
template <>
const RosType& ros_type<OccupancyGrid>();
template <>
const RosType& ros_type<Octomap>();
template <>
const RosType& ros_type<Odometry>();
template <>
const RosType& ros_type<PointCloud2>();
template <>
const RosType& ros_type<PoseWithCovarianceStamped>();
template <>
const RosType& ros_type<TfMessage>();
template <>
const RosType& ros_type<Twist>();
template <>
const RosType& ros_type<TwistStamped>();

}  // namespace cairn::ros
