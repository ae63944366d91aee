// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn doctor`: what is wrong with this computer, a robot's devices or a recording, in one line each, and the
/// remedy.
void add_doctor_command(app::Commands& commands);

}  // namespace cairn::cli
