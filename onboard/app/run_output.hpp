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

/// What the output of a run is made of.
struct RunFacts {
  const RunOptions& options;
  const RobotProfile& profile;
  const RobotTasks& tasks;
  const Door& door;  ///< where the packets came from
  const Monitor& monitor;
};

/// Makes the folder and a file in it, before the run: a run must not end with "permission denied". Error kIo.
Result<void> prepare_output(const std::filesystem::path& out);
/// Writes trajectory, maps, reports and configuration into options.out and returns the report. Error kIo.
Result<report::RunReport> write_output(const RunFacts& facts);

}  // namespace cairn::app
