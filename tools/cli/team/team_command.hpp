// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// cairn team: several robots on this machine, each with its own processes, over an emulated radio.
void add_team_command(app::Commands& commands);

}  // namespace cairn::cli
