// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn simulate --scene NAME --robots N --seconds S --seed K --out DIR`: recordings with ground truth.
/// `cairn simulate --live --scene NAME`: a simulated world as devices, for a robot's program.
void add_simulate_command(app::Commands& commands);

}  // namespace cairn::cli
