// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn calibrate camera-thermal`: where the thermal camera is beside the colour camera, by boards that both see.
void add_calibrate_camera_thermal(app::Commands& commands, CLI::App& calibrate);

}  // namespace cairn::cli
