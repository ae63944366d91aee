// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/clients/messages/wheels.hpp"
#include "tools/ros/messages/header.hpp"

namespace cairn::ros {

/// The wheels as joints that turn: angles (rad) since the core's run began, and their rates (rad/s). Their names are
/// `prefix` and "left_wheel_joint", "front_left_wheel_joint" and so on. `wheels.radius_m` > 0.
[[nodiscard]] JointState joint_state_of(const clients::WheelsMessage& wheels, const Frames& frames, Duration utc_offset,
                                        Arena& arena);

}  // namespace cairn::ros
