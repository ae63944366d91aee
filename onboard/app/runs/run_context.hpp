// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/monitor.hpp"
#include "onboard/app/door/door.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/app/profile/run_options.hpp"
#include "onboard/app/restart/restart.hpp"

namespace cairn::app {

/// How far a run came.
enum class RunEnd : bool {
  kComplete,     ///< to the end of its input, to its time limit or, live, to the stop signal
  kInterrupted,  ///< `stop` ended it before its recording did
};

/// What every part of a run works with. All must outlive the run.
struct RunContext {
  Door& door;
  const RobotProfile& profile;
  const RunOptions& options;
  const PreviousRun& previous;
  Monitor& monitor;
  std::filesystem::path results{};  ///< where files grow that are of the results; an unfinished folder
};

}  // namespace cairn::app
