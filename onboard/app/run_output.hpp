// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/monitor.hpp"
#include "hal/result.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::app {

class RobotTasks;
struct Door;
struct RunOptions;

/// All that is known when a run has ended.
struct RunFacts {
  const RunOptions& options;
  const RobotProfile& profile;
  const RobotTasks& tasks;
  const Door& door;  ///< where the packets came from
  const Monitor& monitor;
};

/// Makes the folder, so that a run does not end with nowhere to go.
Result<void> prepare_output(const std::filesystem::path& out);
/// Writes trajectory, maps, reports and configuration into options.out. Returns what the report says.
Result<report::RunReport> write_output(const RunFacts& facts);

}  // namespace cairn::app
