// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/result.hpp"
#include "onboard/app/profile/run_options.hpp"

namespace cairn::app {

/// The tasks of the run that the options describe, and the channels between them: two tables in plain text. Reads the
/// profile and the index of the recording. No device is opened and nothing is written. Errors: those of the two files;
/// kInvalidConfig: the profile names no place in a team, and `options.peers` asks for one.
[[nodiscard]] Result<std::string> print_tasks(const RunOptions& options);

}  // namespace cairn::app
