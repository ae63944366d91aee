// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/clock.hpp"
#include "hal/result.hpp"
#include "onboard/app/door/door.hpp"
#include "onboard/app/profile/robot_profile.hpp"

namespace cairn {

/// Opens the door to the robot's peer process, as one more input. `clock` must outlive the door. Errors: kInvalidConfig
/// (the profile names no place in a team), those of the socket.
Result<void> join_team(const RobotProfile& profile, const Clock& clock, Door& door);

}  // namespace cairn
