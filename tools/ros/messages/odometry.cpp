// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/odometry.hpp"

#include <string>

namespace cairn::ros {
namespace {

geometry_msgs_msg_dds__Quaternion_ quaternion_of(const Eigen::Quaterniond& q) {
  return {.x = q.x(), .y = q.y(), .z = q.z(), .w = q.w()};
}

geometry_msgs_msg_dds__Vector3_ vector_of(const Eigen::Vector3d& v) { return {.x = v.x(), .y = v.y(), .z = v.z()}; }

TransformStamped transform_of(const SE3& T_parent_child, const Header& header, char* child) {
  return {.header = header,
          .child_frame_id = child,
          .transform = {.translation = vector_of(T_parent_child.translation()),
                        .rotation = quaternion_of(T_parent_child.quaternion())}};
}

}  // namespace

Matrix6 covariance_in_header_frame(const UncertainPose& T) {
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = T.mean.rotation();
  return turn * T.covariance * turn.transpose();
}

Odometry odometry_of(const clients::PoseMessage& pose, const Frames& frames, Duration utc_offset, Arena& arena) {
  Odometry message{};
  message.header = header_of(pose.stamp, utc_offset, frames.odom, arena);
  message.child_frame_id = arena.text(frames.base_link);
  const SE3& T = pose.T_odom_base.mean;
  const Eigen::Vector3d& p = T.translation();
  message.pose.pose = {.position = {.x = p.x(), .y = p.y(), .z = p.z()}, .orientation = quaternion_of(T.quaternion())};
  // Row by row; a covariance is its own transpose.
  Eigen::Map<Matrix6>(message.pose.covariance) = covariance_in_header_frame(pose.T_odom_base);
  message.twist.twist = {.linear = vector_of(pose.twist.head<3>()), .angular = vector_of(pose.twist.tail<3>())};
  return message;
}

TfMessage tf_of(const clients::PoseMessage& pose, const std::optional<SE3>& T_team_odom, const Frames& frames,
                Duration utc_offset, Arena& arena) {
  TfMessage message{};
  const auto transforms = arena.sequence(message.transforms, T_team_odom ? 2 : 1);
  transforms[0] = transform_of(pose.T_odom_base.mean, header_of(pose.stamp, utc_offset, frames.odom, arena),
                               arena.text(frames.base_link));
  if (T_team_odom)
    transforms[1] =
        transform_of(*T_team_odom, header_of(pose.stamp, utc_offset, frames.team, arena), arena.text(frames.odom));
  return message;
}

TfMessage tf_static_of(std::span<const clients::HelloMessage::Sensor> sensors, const Frames& frames, Time now,
                       Duration utc_offset, Arena& arena) {
  TfMessage message{};
  const auto transforms = arena.sequence(message.transforms, sensors.size());
  const Header header = header_of(now, utc_offset, frames.base_link, arena);
  for (std::size_t i = 0; i < sensors.size(); ++i)
    transforms[i] = transform_of(sensors[i].T_base_sensor, header, arena.text(frames.prefix + sensors[i].name));
  return message;
}

}  // namespace cairn::ros
