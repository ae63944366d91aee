// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn match A B [--initial x,y,z,roll,pitch,yaw]`: relative pose of two maps. A pose that is refused is
/// printed with its reason, `accepted` is false, and the exit code is 1.
void add_match_command(app::Commands& commands);

}  // namespace cairn::cli
