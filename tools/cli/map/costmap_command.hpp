// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn map costmap`: what a running robot can drive on, as a picture that Nav2's map server reads.
void add_costmap_command(app::Commands& commands, CLI::App& map);

}  // namespace cairn::cli
