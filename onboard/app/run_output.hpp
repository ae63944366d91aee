// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "hal/monitor.hpp"
#include "hal/result.hpp"
#include "onboard/app/door.hpp"
#include "onboard/app/report/run_report.hpp"
#include "onboard/robot.hpp"

namespace cairn {

struct RunOptions;

/// Counted while packets came in.
struct LoopFigures {
  std::optional<Time> start;  ///< arrival of the first packet
  Time end{};                 ///< arrival of the last
  std::uint64_t scans = 0, lost_packets = 0;
  std::uint64_t allocations = 0;  ///< by this thread while stepping the robot, after a warm-up
};

/// All that is known when a run has ended.
struct RunFacts {
  const RunOptions& options;
  const RobotProfile& profile;
  const Door& door;
  const Robot& robot;
  const Monitor& monitor;
  const LoopFigures& figures;
};

/// Makes the folder, so that a run does not end with nowhere to go.
Result<void> prepare_output(const std::filesystem::path& out);
/// Writes every file of interface.md's "What a run leaves" into options.out and returns what the report says.
Result<RunReport> write_output(const RunFacts& facts);

}  // namespace cairn
