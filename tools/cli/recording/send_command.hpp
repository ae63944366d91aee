// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn send RECORDING --to ADDRESS`: sends the LiDAR datagrams of a recording over UDP.
void add_send_command(app::Commands& commands);

}  // namespace cairn::cli
