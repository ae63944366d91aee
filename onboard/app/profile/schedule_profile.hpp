// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/config/config.hpp"
#include "hal/monitor.hpp"
#include "onboard/scheduler/task_spec.hpp"

namespace cairn {

/// The tasks of a robot, in the order in which they run when they are released together. Defaults are for a Husky's NUC
/// with a VLP-16 at 10 Hz. Odometry and mapping look for work a hundred times a second, so that a scan does not wait,
/// and find it ten times.
struct ScheduleProfile {
  scheduler::TaskSpec safety{"safety", 500, 0, 0, 0.2, 1, 0, 80, -1};
  scheduler::TaskSpec drive{"drive", 500, 0.2, 0, 0.2, 1, 0, 75, -1};
  scheduler::TaskSpec receive{"receive", 100, 0, 20, 1, 10, 0, 60, -1};
  scheduler::TaskSpec odometry{"odometry", 100, 1, 100, 40, 80, 10, 50, -1};
  scheduler::TaskSpec mapping{"mapping", 100, 2, 100, 30, 90, 10, 0, -1};
  scheduler::TaskSpec team{"team", 25, 3, 200, 4, 0, 0, 0, -1};
  scheduler::TaskSpec matching{"matching", 10, 6, 5000, 0, 0, 0, 0, -1};
  scheduler::TaskSpec watch{"watch", 20, 4, 1000, 0.5, 0, 0, 0, -1};
  scheduler::TaskSpec housekeeping{"housekeeping", 20, 5, 1000, 1, 0, 0, 0, -1};
  scheduler::TaskSpec saving{"saving", 10, 7, 1000, 5, 0, 0, 0, -1};

  /// Those that declare a budget. `in_a_team`: with the team's.
  [[nodiscard]] std::vector<scheduler::TaskSpec> tasks(bool in_a_team) const {
    std::vector<scheduler::TaskSpec> all{safety, drive, receive, odometry, mapping, watch, housekeeping, saving};
    if (in_a_team) all.push_back(team);
    return all;
  }
};

void declare(config::Section& section, ScheduleProfile& profile);

/// Gives the stages of a run the budgets of their tasks: execution of odometry and mapping `soft_ms`, the latencies
/// from a scan's last byte their deadline. To be called before the tasks are made. Other stages have no budget.
void declare_stages(const ScheduleProfile& profile, Monitor& monitor);

}  // namespace cairn
