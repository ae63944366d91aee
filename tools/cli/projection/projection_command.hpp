// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn evaluate projection RECORDING`: how well the LiDAR's depth edges meet the camera's picture edges. `evaluate`:
/// the command that it belongs to.
void add_projection_command(app::Commands& commands, CLI::App& evaluate);

}  // namespace cairn::cli
