// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros2.h>  // of idl/ros2.idl

/// ROS 2 messages of a running core. The types are generated C structs, whose texts and sequences belong to others.
namespace cairn::ros {

using BoolMessage = std_msgs_msg_dds__Bool_;
using CameraInfo = sensor_msgs_msg_dds__CameraInfo_;
using CompressedImage = sensor_msgs_msg_dds__CompressedImage_;
using DiagnosticArray = diagnostic_msgs_msg_dds__DiagnosticArray_;
using DiagnosticStatus = diagnostic_msgs_msg_dds__DiagnosticStatus_;
using Header = std_msgs_msg_dds__Header_;
using JointState = sensor_msgs_msg_dds__JointState_;
using KeyValue = diagnostic_msgs_msg_dds__KeyValue_;
using Marker = visualization_msgs_msg_dds__Marker_;
using MarkerArray = visualization_msgs_msg_dds__MarkerArray_;
using OccupancyGrid = nav_msgs_msg_dds__OccupancyGrid_;
using Octomap = octomap_msgs_msg_dds__Octomap_;
using Odometry = nav_msgs_msg_dds__Odometry_;
using PointCloud2 = sensor_msgs_msg_dds__PointCloud2_;
using PointField = sensor_msgs_msg_dds__PointField_;
using PoseWithCovarianceStamped = geometry_msgs_msg_dds__PoseWithCovarianceStamped_;
using Stamp = builtin_interfaces_msg_dds__Time_;
using TfMessage = tf2_msgs_msg_dds__TFMessage_;
using TransformStamped = geometry_msgs_msg_dds__TransformStamped_;
using Twist = geometry_msgs_msg_dds__Twist_;
using TwistStamped = geometry_msgs_msg_dds__TwistStamped_;

}  // namespace cairn::ros
