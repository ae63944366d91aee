// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn place`: tells a running robot where it is, by command.sock.
void add_place_command(app::Commands& commands);

}  // namespace cairn::cli
