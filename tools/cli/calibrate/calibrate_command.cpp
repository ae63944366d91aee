// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/calibrate_command.hpp"

#include <CLI/CLI.hpp>

#include "tools/cli/calibrate/camera_command.hpp"
#include "tools/cli/calibrate/camera_thermal_command.hpp"
#include "tools/cli/calibrate/lidar_camera_command.hpp"
#include "tools/cli/calibrate/stereo_command.hpp"

namespace cairn::cli {

void add_calibrate_command(app::Commands& commands) {
  CLI::App* sub = commands.app.add_subcommand("calibrate", "calibrations from recordings of a checkerboard");
  sub->require_subcommand(1);
  add_calibrate_camera(commands, *sub);
  add_calibrate_stereo(commands, *sub);
  add_calibrate_lidar_camera(commands, *sub);
  add_calibrate_thermal(commands, *sub);
  add_calibrate_camera_thermal(commands, *sub);
}

}  // namespace cairn::cli
