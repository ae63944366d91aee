// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn faults`: copies a recording with faults: lost, late, repeated or damaged packets.
void add_faults_command(app::Commands& commands);

}  // namespace cairn::cli
