// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn map check MAP MAP…`: whether parts of one robot's map, made one after the other, agree where they overlap.
void add_map_check_command(app::Commands& commands, CLI::App& map);

}  // namespace cairn::cli
