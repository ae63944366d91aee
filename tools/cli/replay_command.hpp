// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/cli/commands.hpp"

namespace cairn::cli {

/// `cairn replay --recording DIR`: a recording's LiDAR, on the wire.
void add_replay_command(Commands& commands);

}  // namespace cairn::cli
