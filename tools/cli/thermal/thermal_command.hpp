// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn thermal`: the points of a recording, or of a running core, with what the thermal camera measured there.
void add_thermal_command(app::Commands& commands);

}  // namespace cairn::cli
