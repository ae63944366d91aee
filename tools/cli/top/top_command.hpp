// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn top`: a running core, seen from a terminal.
void add_top_command(Commands& commands);

}  // namespace cairn::cli
