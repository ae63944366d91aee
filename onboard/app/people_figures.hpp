// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/tasks/robot_tasks.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::app {

/// Adds the figures of a run that followed people.
void add_people(const RobotTasks& tasks, report::RunReport& report);

}  // namespace cairn::app
