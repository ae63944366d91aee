// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn inspect FILE|DIR`: what is in a capture, recording, map, trajectory or point cloud.
void add_inspect_command(Commands& commands);

}  // namespace cairn::cli
