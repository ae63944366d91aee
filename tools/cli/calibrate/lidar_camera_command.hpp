// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn calibrate lidar-camera RECORDING…`: where the camera is on the robot, by boards that the LiDAR sees, too.
/// `calibrate`: the command that it belongs to.
void add_calibrate_lidar_camera(app::Commands& commands, CLI::App& calibrate);
/// `cairn calibrate thermal RECORDING…`: the same for the thermal camera and a heated board.
void add_calibrate_thermal(app::Commands& commands, CLI::App& calibrate);

}  // namespace cairn::cli
