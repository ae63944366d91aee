// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn match A B [--initial x,y,z,roll,pitch,yaw]`: relative pose of two maps. A match that is not accepted is a
/// result, not a failure: exit code 0 and `accepted` false.
void add_match_command(app::Commands& commands);

}  // namespace cairn::cli
