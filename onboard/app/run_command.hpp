// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::app {

/// `cairn run`: one robot, live or on a recording.
void add_run_command(Commands& commands);
/// Adds the options of `cairn run` to `app`. Its callback leaves the run in `commands.job`. cairn-core has no others.
void add_run_options(CLI::App& app, Commands& commands);

}  // namespace cairn::app
