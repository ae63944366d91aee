// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// Every command but `run`, which belongs to the onboard program.
void add_tool_commands(app::Commands& commands);

}  // namespace cairn::cli
