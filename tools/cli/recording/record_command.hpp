// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn record --config robot.yaml --out DIR`: raw sensor bytes, until SIGINT, SIGTERM or --seconds.
void add_record_command(app::Commands& commands);

}  // namespace cairn::cli
