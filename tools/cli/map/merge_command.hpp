// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn merge A B --pose x,y,z,roll,pitch,yaw --policy P --out C`: the fused map in the frame of A.
void add_merge_command(app::Commands& commands);

}  // namespace cairn::cli
