// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/result.hpp"
#include "onboard/app/profile/run_options.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::app {

/// The tasks of the run that the options describe, and the channels between them: two tables in plain text. Reads the
/// profile and the index of the recording. No device is opened and nothing is written. Errors: those of
/// checked_profile(), of the index, and of open_sight().
[[nodiscard]] Result<std::string> print_tasks(const RunOptions& options);
/// The same as an object with the arrays "tasks" and "channels".
[[nodiscard]] Result<report::Json> tasks_as_json(const RunOptions& options);

}  // namespace cairn::app
