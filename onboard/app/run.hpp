// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "hal/result.hpp"
#include "hal/time.hpp"
#include "onboard/app/door.hpp"
#include "onboard/app/report/run_report.hpp"

namespace cairn {

struct RunOptions {
  std::filesystem::path config;     ///< empty: the defaults
  std::filesystem::path recording;  ///< empty: live hardware
  std::filesystem::path out;
  std::filesystem::path record;     ///< live: where to keep the packets and the schedule; empty: nowhere
  std::filesystem::path schedule;   ///< of another live run, instead of the recording's own schedule.log
  std::filesystem::path state;      ///< live: where the map is kept for a restart; empty: nowhere
  bool peers = false;               ///< takes part in the team; a recording is played then as if it were the devices
  std::filesystem::path live_view;  ///< live: the local socket for `cairn top`; empty: none
  Pace pace = Pace::kRecorded;
  bool reference = false;  ///< at real speed: run an empty task beside the control task, to know what the machine costs
  std::optional<int> threads;     ///< instead of the profile's
  std::optional<double> seconds;  ///< ends the run when so much of the robot's time has passed
  std::function<bool()> stop;     ///< live: asked about every 20 ms whether the run is to end; empty: never
  std::function<void(Time, std::size_t scans)> progress;  ///< after every scan, on odometry's thread; may be empty

  /// On the machine's clock, and never the same twice.
  [[nodiscard]] bool live() const { return recording.empty() || peers; }
};

/// What a run leaves behind, beside its files.
struct RunResult {
  Monitor monitor;  ///< report.monitor points to it
  RunReport report;
};

/// One robot, from its first packet to the last: live until a stop signal, or to the end of a recording. Writes
/// trajectory.tum, map.cairn, map.ot, report.json, report.html and config.yaml into `out`; live also schedule.log.
Result<std::unique_ptr<RunResult>> run(const RunOptions& options);

}  // namespace cairn
