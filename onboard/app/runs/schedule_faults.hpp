// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/safety/fault.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::app {

/// The faults that the figures of a live schedule show. Part of the watch task.
class ScheduleFaults {
 public:
  /// Both must outlive it; `safety` is one of the graph's tasks.
  ScheduleFaults(const scheduler::TaskGraph& graph, const scheduler::ScheduledTask& safety)
      : graph_(graph), safety_(safety) {}

  /// kSafetyMissed: the safety task missed a deadline since the last look. kStageDemoted: a task runs at half its rate
  /// because it kept overrunning its hard budget.
  safety::FaultSet look() {
    safety::FaultSet faults;
    const std::uint64_t misses = safety_.stats.misses;
    faults.set(safety::Fault::kSafetyMissed, misses != misses_);
    misses_ = misses;
    for (const scheduler::ScheduledTask& task : graph_.tasks())
      if (!task.live_only() && task.stats.demoted != 0) faults.set(safety::Fault::kStageDemoted);
    return faults;
  }

 private:
  const scheduler::TaskGraph& graph_;
  const scheduler::ScheduledTask& safety_;
  std::uint64_t misses_ = 0;
};

}  // namespace cairn::app
