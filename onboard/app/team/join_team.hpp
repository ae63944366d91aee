// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/clock.hpp"
#include "hal/result.hpp"
#include "onboard/app/door/door.hpp"
#include "onboard/app/profile/robot_profile.hpp"

namespace cairn::app {

/// Error kInvalidConfig: the profile gives the robot no place in a team.
[[nodiscard]] Result<void> check_team_place(const RobotProfile& profile);

/// What peers send, as a source of a recording.
[[nodiscard]] recording::SourceEntry peers_entry();

/// Adds the robot's peer process to the inputs of the door, in place of recorded peers. `clock` must outlive the door.
/// Errors: those of check_team_place() and of the socket.
Result<void> join_team(const RobotProfile& profile, const Clock& clock, Door& door);

}  // namespace cairn::app
