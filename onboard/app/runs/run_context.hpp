// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/monitor.hpp"
#include "onboard/app/door/door.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/app/profile/run_options.hpp"
#include "onboard/app/restart/restart.hpp"

namespace cairn::app {

/// What every part of a run works with. All must outlive the run.
struct RunContext {
  Door& door;
  const RobotProfile& profile;
  const RunOptions& options;
  const PreviousRun& previous;
  Monitor& monitor;
};

}  // namespace cairn::app
