// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn calibrate camera RECORDING…`: intrinsics of one camera. `calibrate`: the command that it belongs to.
void add_calibrate_camera(app::Commands& commands, CLI::App& calibrate);

}  // namespace cairn::cli
