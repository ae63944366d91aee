// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/clock.hpp"
#include "onboard/app/door/door.hpp"

namespace cairn::app {

/// The command socket of a live run, in the folder of its sockets.
[[nodiscard]] inline std::filesystem::path command_socket(const std::filesystem::path& sockets) {
  return sockets / "command.sock";
}

/// Adds command.sock to the door of a live run, where the robot has a drive that may be armed, or is in a team.
/// Commands of a played recording are forgotten: clients say other things now. `clock` must outlive the door. Errors:
/// those of CommandSocket::open().
Result<void> serve_commands(const std::filesystem::path& sockets, const RobotProfile& profile, const Clock& clock,
                            Door& door);

}  // namespace cairn::app
