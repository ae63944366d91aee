// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn map pull`: the map of a running core. Adds itself to `map`.
void add_map_pull_command(app::Commands& commands, CLI::App& map);

}  // namespace cairn::cli
