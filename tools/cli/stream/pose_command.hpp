// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn pose`: prints the poses of a running core as they come.
void add_pose_command(app::Commands& commands);

}  // namespace cairn::cli
