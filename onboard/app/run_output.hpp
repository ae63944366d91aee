// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "hal/files/unfinished_folder.hpp"
#include "hal/monitor.hpp"
#include "hal/result.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/app/runs/run_context.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::app {

class RobotTasks;

/// What the output of a run is made of.
struct RunFacts {
  const RunOptions& options;
  const RobotProfile& profile;
  const std::filesystem::path& profile_file;  ///< empty: the defaults
  const RobotTasks& tasks;
  const Door& door;  ///< where the packets came from
  const Monitor& monitor;
  RunEnd end;
  const std::optional<Error>& lost_schedule;  ///< live: why schedule.log is not complete; none: it is
};

/// Makes the folder `out` and in it the folder where the results grow. It finds out before the run whether they can be
/// written. Error kIo.
Result<UnfinishedFolder> prepare_output(const std::filesystem::path& out);

/// The results of a run and where they are.
struct RunOutput {
  report::RunReport report;
  std::filesystem::path folder;
};

/// Writes trajectory, maps, reports and configuration into `unfinished` and then moves them into options.out, over the
/// results of an earlier run. Results without a scan replace no map: they go into the folder kFailedRun. Error kIo;
/// then the earlier results are still there, and `unfinished` stays with what was written.
Result<RunOutput> write_output(const RunFacts& facts, UnfinishedFolder& unfinished);

}  // namespace cairn::app
