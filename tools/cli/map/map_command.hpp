// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn map info|compare|check|render|export FILE…`: describes, compares, checks, draws and converts
/// maps.
void add_map_command(app::Commands& commands);

}  // namespace cairn::cli
