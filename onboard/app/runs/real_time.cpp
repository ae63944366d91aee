// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/real_time.hpp"

#include <algorithm>
#include <string>

#include "onboard/scheduler/threads.hpp"

namespace cairn::app {

bool become_real_time(const scheduler::TaskGraph& graph, Monitor& monitor) {
  int highest = 0;
  for (const scheduler::ScheduledTask& task : graph.tasks()) highest = std::max(highest, task.spec.priority);
  auto missing = scheduler::probe_privileges(highest);
  for (const scheduler::ScheduledTask& task : graph.tasks())
    if (const int core = task.spec.core; core >= 0 && !scheduler::may_run_on(core))
      missing.push_back(
          "core " + std::to_string(core) + " for the task " + task.spec.name +
          ", which runs on any: taskset or a cpuset withholds it; choose another in the section schedule");
  for (const std::string& what : missing) monitor.event({}, "best effort", "missing: " + what);
  if (!scheduler::lock_memory() && missing.empty()) monitor.event({}, "best effort", "memory cannot be locked");
  return missing.empty();
}

}  // namespace cairn::app
