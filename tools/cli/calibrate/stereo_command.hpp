// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn calibrate stereo RECORDING…`: both eyes of side-by-side pictures. `calibrate`: the command that it belongs
/// to.
void add_calibrate_stereo(app::Commands& commands, CLI::App& calibrate);

}  // namespace cairn::cli
