// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn map info|compare|check|render|export FILE…`: what is in a map, how two differ, whether the parts of one
/// agree, a picture, another format.
void add_map_command(Commands& commands);

}  // namespace cairn::cli
