// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn calibrate camera|stereo|lidar-camera|thermal RECORDING…`: calibrations from recordings of a checkerboard.
void add_calibrate_command(app::Commands& commands);

}  // namespace cairn::cli
