// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/cli/command.hpp"

namespace cairn::cli {

/// `cairn run`: one robot, live or on a recording.
void add_run_command(Commands& commands);

}  // namespace cairn::cli
