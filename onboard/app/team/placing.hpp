// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "drivers/clients/messages/command.hpp"
#include "fusion/team/team.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"

// What a person says of where the robot is, for the team.
namespace cairn::app {

/// Where the robot's odom frame lies in the placement's frame, if base_link is at `T_odom_base` at that moment. Height
/// is taken to be known to a metre, and both frames to be level to 1.7°.
[[nodiscard]] UncertainPose T_frame_odom(const clients::Placement& place, const SE3& T_odom_base);

/// The robot whose odom the placement's frame is; 0: the frame of the team's start poses. Error kNotFound: no such
/// teammate was heard of, or the frame is the robot's own.
[[nodiscard]] Result<peers::RobotId> robot_of_frame(const clients::Placement& place, const team::Team& team);

/// What was said, for people, such as "it was placed at (1.50, -2.00), 90 degrees, in odom of robot_1".
[[nodiscard]] std::string to_string(const clients::Placement& place);

}  // namespace cairn::app
