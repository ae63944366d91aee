// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn inspect FILE|DIR`: says what a recording, capture, map, trajectory, point cloud or array holds.
void add_inspect_command(app::Commands& commands);

}  // namespace cairn::cli
