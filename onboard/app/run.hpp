// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "hal/monitor.hpp"
#include "hal/result.hpp"
#include "onboard/app/profile/run_options.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::app {

/// The result of a run, besides its files.
struct RunResult {
  Monitor monitor;  ///< report.monitor points to it
  report::RunReport report;
  std::filesystem::path folder;  ///< with its files: options.out, or kFailedRun in it
};

/// Runs one robot, live until a stop signal, or to the end of a recording. A replay that is stopped before that leaves
/// the same files, of the part that it played, and says so in its report. Writes trajectory.tum, map.cairn, map.ot,
/// report.json, report.html and config.yaml into `out`; a live run also schedule.log. They appear at the end, and no
/// error touches those of an earlier run; see write_output(). Errors: the profile, the schedule, the devices or the
/// recording cannot be used, or a file cannot be written.
Result<std::unique_ptr<RunResult>> run(const RunOptions& options);

}  // namespace cairn::app
