// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn arm`, `stop`, `disarm`, `drive` and `place`: clients of a running core's command.sock.
void add_drive_commands(app::Commands& commands);

}  // namespace cairn::cli
