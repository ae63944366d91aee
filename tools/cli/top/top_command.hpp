// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn top`: shows a running core in a terminal.
void add_top_command(app::Commands& commands);

}  // namespace cairn::cli
