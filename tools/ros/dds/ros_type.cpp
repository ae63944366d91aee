// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/dds/ros_type.hpp"

// tests/tools/ros/dds/type_hash_test.cpp computes the hashes from idl/ros2.idl.
namespace cairn::ros {

template <>
const RosType& ros_type<BoolMessage>() {
  static const RosType type{"std_msgs/msg/Bool",
                            "RIHS01_feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9",
                            &std_msgs_msg_dds__Bool__desc};
  return type;
}

template <>
const RosType& ros_type<CameraInfo>() {
  static const RosType type{"sensor_msgs/msg/CameraInfo",
                            "RIHS01_b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275",
                            &sensor_msgs_msg_dds__CameraInfo__desc};
  return type;
}

template <>
const RosType& ros_type<CompressedImage>() {
  static const RosType type{"sensor_msgs/msg/CompressedImage",
                            "RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a",
                            &sensor_msgs_msg_dds__CompressedImage__desc};
  return type;
}

template <>
const RosType& ros_type<DiagnosticArray>() {
  static const RosType type{"diagnostic_msgs/msg/DiagnosticArray",
                            "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e",
                            &diagnostic_msgs_msg_dds__DiagnosticArray__desc};
  return type;
}

template <>
const RosType& ros_type<JointState>() {
  static const RosType type{"sensor_msgs/msg/JointState",
                            "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e",
                            &sensor_msgs_msg_dds__JointState__desc};
  return type;
}

template <>
const RosType& ros_type<MarkerArray>() {
  static const RosType type{"visualization_msgs/msg/MarkerArray",
                            "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf",
                            &visualization_msgs_msg_dds__MarkerArray__desc};
  return type;
}

template <>
const RosType& ros_type<OccupancyGrid>() {
  static const RosType type{"nav_msgs/msg/OccupancyGrid",
                            "RIHS01_8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7",
                            &nav_msgs_msg_dds__OccupancyGrid__desc};
  return type;
}

template <>
const RosType& ros_type<Octomap>() {
  static const RosType type{"octomap_msgs/msg/Octomap",
                            "RIHS01_9891a19a05b70ec20aa8f45db3f8300b9ab80afff32c61c549d25087da9625b0",
                            &octomap_msgs_msg_dds__Octomap__desc};
  return type;
}

template <>
const RosType& ros_type<Odometry>() {
  static const RosType type{"nav_msgs/msg/Odometry",
                            "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0",
                            &nav_msgs_msg_dds__Odometry__desc};
  return type;
}

template <>
const RosType& ros_type<PointCloud2>() {
  static const RosType type{"sensor_msgs/msg/PointCloud2",
                            "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5",
                            &sensor_msgs_msg_dds__PointCloud2__desc};
  return type;
}

template <>
const RosType& ros_type<PoseWithCovarianceStamped>() {
  static const RosType type{"geometry_msgs/msg/PoseWithCovarianceStamped",
                            "RIHS01_26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e",
                            &geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc};
  return type;
}

template <>
const RosType& ros_type<TfMessage>() {
  static const RosType type{"tf2_msgs/msg/TFMessage",
                            "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
                            &tf2_msgs_msg_dds__TFMessage__desc};
  return type;
}

template <>
const RosType& ros_type<Twist>() {
  static const RosType type{"geometry_msgs/msg/Twist",
                            "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a",
                            &geometry_msgs_msg_dds__Twist__desc};
  return type;
}

template <>
const RosType& ros_type<TwistStamped>() {
  static const RosType type{"geometry_msgs/msg/TwistStamped",
                            "RIHS01_5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64",
                            &geometry_msgs_msg_dds__TwistStamped__desc};
  return type;
}

}  // namespace cairn::ros
