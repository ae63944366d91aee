// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/cli/command.hpp"

namespace cairn::cli {

/// `cairn faults`: a recording with the faults of bad cables, radios and computers, as a new recording.
void add_faults_command(Commands& commands);

}  // namespace cairn::cli
