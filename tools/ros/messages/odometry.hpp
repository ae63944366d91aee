// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "drivers/clients/messages/hello.hpp"
#include "drivers/clients/messages/pose.hpp"
#include "tools/ros/messages/header.hpp"

namespace cairn::ros {

/// The covariance that ROS gives a pose: of the position in the header's frame (m), and of a small rotation about the
/// fixed axes of that frame (rad), in the order x y z, about x y z. Cairn's is of a right perturbation T·exp(ξ), in
/// base_link, in the same order. With R = rotation(T), to first order both parts turn with R.
[[nodiscard]] Matrix6 covariance_in_header_frame(const UncertainPose& T);

/// The pose in odom, and the twist of base_link in base_link. The twist's covariance is all zeros: unknown.
[[nodiscard]] Odometry odometry_of(const clients::PoseMessage& pose, const Frames& frames, Duration utc_offset,
                                   Arena& arena);

/// odom → base_link and, if it is known, team → odom, at the same time.
[[nodiscard]] TfMessage tf_of(const clients::PoseMessage& pose, const std::optional<SE3>& T_team_odom,
                              const Frames& frames, Duration utc_offset, Arena& arena);
/// base_link → each sensor, in one message.
[[nodiscard]] TfMessage tf_static_of(std::span<const clients::HelloMessage::Sensor> sensors, const Frames& frames,
                                     Time now, Duration utc_offset, Arena& arena);

}  // namespace cairn::ros
