// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/tasks/robot_tasks.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::app {

/// Adds the figures of cameras whose mounts were watched.
void add_mounts(const RobotTasks& tasks, report::RunReport& report);

}  // namespace cairn::app
